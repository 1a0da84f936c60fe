//! Sparse symmetric matrices: one pattern, many values.

mod matrix;
mod pattern;
mod triplets;

pub use matrix::{Part, SymmetricMatrix, Values};
pub use pattern::Pattern;
pub use triplets::Triplets;

pub(crate) use matrix::multiply_add;
