//! Sparse symmetric matrices: one pattern, many values.

mod matrix;
mod pattern;
pub(crate) mod side_by_side;
mod triplets;

pub use matrix::{Part, SymmetricMatrix, Values};
pub use pattern::Pattern;
pub use triplets::Triplets;

pub(crate) use matrix::accumulate;
