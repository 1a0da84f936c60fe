//! A x = b by LU with partial pivoting.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, MatMut};

/// A factorised square matrix, P A = L U.
#[derive(Debug, Clone)]
pub struct Lu {
    factor: PartialPivLu<c64>,
    dim: usize,
}

impl Lu {
    /// Factorises A.
    ///
    /// # Errors
    /// [`NoConvergence`] where A has values that are not finite.
    ///
    /// # Panics
    /// Where A is not square.
    pub fn new(a: &Matrix) -> Result<Self, NoConvergence> {
        assert_eq!(a.nrows(), a.ncols());
        if !a.is_finite() {
            return Err(NoConvergence);
        }
        Ok(Self { factor: a.as_faer().partial_piv_lu(), dim: a.nrows() })
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Overwrites k right-hand sides (n × k, column after column) with the solutions of A X = B.
    ///
    /// # Errors
    /// [`NoConvergence`] where B has values that are not finite, or A is singular to the last bit.
    ///
    /// # Panics
    /// Where the length of B is not a multiple of n.
    ///
    /// # Limits
    /// A nearly singular matrix gives a solution of small residual and unknown error.
    pub fn solve(&self, rhs: &mut [c64]) -> Result<(), NoConvergence> {
        if self.dim == 0 {
            return Ok(());
        }
        assert_eq!(rhs.len() % self.dim, 0, "whole right-hand sides");
        let columns = rhs.len() / self.dim;
        let view = MatMut::from_column_major_slice_mut(rhs, self.dim, columns);
        self.factor.solve_in_place_with_conj(Conj::No, view);
        if rhs.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(NoConvergence) }
    }
}

/// The solution of A x = b.
///
/// # Errors
/// [`NoConvergence`] where A or b has values that are not finite, or A is singular to the last bit.
///
/// # Panics
/// Where A is not square, or b has not one entry for each row.
///
/// # Limits
/// Those of [`Lu::solve`].
pub fn solve(a: &Matrix, b: &[c64]) -> Result<Vec<c64>, NoConvergence> {
    assert_eq!(b.len(), a.nrows());
    let mut x = b.to_vec();
    Lu::new(a)?.solve(&mut x)?;
    Ok(x)
}
