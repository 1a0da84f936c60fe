//! A x = b by LU with partial pivoting.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The solution of A x = b.
///
/// # Errors
/// [`NoConvergence`] where A or b has values that are not finite, or A is singular to the last bit.
///
/// # Panics
/// Where A is not square, or b has not one entry for each row.
///
/// # Limits
/// A nearly singular matrix gives a solution of small residual and unknown error.
pub fn solve(a: &Matrix, b: &[c64]) -> Result<Vec<c64>, NoConvergence> {
    assert!(a.nrows() == a.ncols() && b.len() == a.nrows());
    if !a.is_finite() {
        return Err(NoConvergence);
    }
    let x = a.as_faer().partial_piv_lu().solve(&Mat::from_fn(b.len(), 1, |i, _| b[i]));
    let x: Vec<c64> = (0..b.len()).map(|i| x[(i, 0)]).collect();
    if x.iter().all(|x| x.is_finite()) { Ok(x) } else { Err(NoConvergence) }
}
