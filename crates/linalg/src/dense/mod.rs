//! Small dense problems. Sizes here are tens, not thousands: the order of a series, a Krylov space.

mod cholesky;
mod eigen;
mod ldlt;
mod least_squares;
mod lu;
mod matrix;
mod orthonormal;
mod polynomial;
mod real;
mod singular;

pub use cholesky::Cholesky;
pub use eigen::{Eigen, eigen, eigenvalues, symmetric_eigen};
pub use ldlt::Ldlt;
pub use least_squares::{LeastSquares, least_squares};
pub use lu::{Lu, solve};
pub use matrix::Matrix;
pub use orthonormal::{orthonormal, upper_triangle};
pub use polynomial::{Root, evaluate, roots};
pub use real::{combination, multiply};
pub use singular::{Singular, singular};

use std::fmt;

/// A dense iteration that found no answer: the matrix has values that are not finite, or the QR iteration
/// did not converge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoConvergence;

impl fmt::Display for NoConvergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a small dense eigenvalue or least-squares problem has no finite answer")
    }
}

impl std::error::Error for NoConvergence {}
