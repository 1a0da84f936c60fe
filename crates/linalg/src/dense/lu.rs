//! A x = b by LU with partial pivoting.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, MatMut};

/// A factorised square matrix, P A = L U. Of a symmetric one [`Ldlt`](super::Ldlt) takes half the work.
#[derive(Debug, Clone)]
pub struct Lu(PartialPivLu<c64>);

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
        Ok(Self(a.as_faer().partial_piv_lu()))
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        self.0.L().nrows()
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
        let n = self.dim();
        if n == 0 {
            return Ok(());
        }
        assert_eq!(rhs.len() % n, 0, "whole right-hand sides");
        let view = MatMut::from_column_major_slice_mut(rhs, n, rhs.len() / n);
        self.0.solve_in_place_with_conj(Conj::No, view);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries of no pattern, with a diagonal that a factorisation without exchanges would stumble over.
    fn matrix(n: usize) -> Matrix {
        let part = |k: usize| ((k * k + 3 * k) as f64 * 0.618_034).fract() - 0.5;
        Matrix::from_fn(n, n, |i, j| {
            let k = 1 + i * n + j;
            if i == j { c64::default() } else { c64::new(part(k), part(7 * k)) }
        })
    }

    #[test]
    fn solutions_solve() {
        for n in (0..20).filter(|&n| n != 1).chain([63, 73]) {
            let a = matrix(n);
            let lu = Lu::new(&a).unwrap();
            assert_eq!(lu.dim(), n);
            let exact: Vec<Vec<c64>> =
                (1..4).map(|k| (0..n).map(|i| c64::new((i * k) as f64, 1.0 - k as f64)).collect()).collect();
            let mut rhs: Vec<c64> = exact.iter().flat_map(|x| a.multiply(x)).collect();
            lu.solve(&mut rhs).unwrap();
            let off = rhs.iter().zip(exact.concat()).map(|(x, exact)| (x - exact).norm()).fold(0.0, f64::max);
            // Entries up to 200, condition numbers of some thousands.
            assert!(off < 1e-9, "{n}: {off}");
        }
    }

    #[test]
    fn it_says_where_there_is_no_solution() {
        for n in [1, 5, 65] {
            let mut a = matrix(n);
            (0..n).for_each(|i| a[(i, n - 1)] = c64::default());
            let singular = Lu::new(&a).and_then(|lu| lu.solve(&mut vec![c64::new(1.0, 0.0); n]));
            assert_eq!(singular, Err(NoConvergence), "{n}");
            a[(0, 0)] = c64::new(f64::NAN, 0.0);
            assert!(Lu::new(&a).is_err());
        }
    }
}
