//! min ‖A x − b‖₂ by column-pivoted QR.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

/// The solution of min ‖A x − b‖₂ and its residual.
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSquares {
    /// x, one entry for each column of A.
    pub solution: Vec<c64>,
    /// ‖A x − b‖₂.
    pub residual: f64,
}

/// min ‖A x − b‖₂ for A with at least as many rows as columns.
///
/// # Errors
/// [`NoConvergence`] where a value is not finite or the columns of A are linearly dependent.
///
/// # Panics
/// Where A has fewer rows than columns, or b has not one entry for each row.
pub fn least_squares(a: &Matrix, b: &[c64]) -> Result<LeastSquares, NoConvergence> {
    assert!(a.nrows() >= a.ncols() && b.len() == a.nrows());
    if !a.is_finite() {
        return Err(NoConvergence);
    }
    let rhs = Mat::from_fn(b.len(), 1, |i, _| b[i]);
    let x = a.as_faer().col_piv_qr().solve_lstsq(&rhs);
    let solution: Vec<c64> = (0..a.ncols()).map(|i| x[(i, 0)]).collect();
    let product = a.multiply(&solution);
    let residual = product.iter().zip(b).map(|(p, b)| (p - b).norm_sqr()).sum::<f64>().sqrt();
    if residual.is_finite() { Ok(LeastSquares { solution, residual }) } else { Err(NoConvergence) }
}
