//! Positive definite real matrices, by faer's Cholesky decomposition.

use super::NoConvergence;
use faer::linalg::solvers::{Llt, Solve};
use faer::{MatMut, MatRef, Side};

/// A = LLᵀ of a real symmetric positive definite matrix.
#[derive(Debug, Clone)]
pub struct Cholesky {
    n: usize,
    factor: Llt<f64>,
}

impl Cholesky {
    /// Of an n × n matrix, of which the lower triangle is read, column after column.
    ///
    /// # Errors
    /// [`NoConvergence`] where the matrix is not positive definite, or not finite.
    ///
    /// # Panics
    /// Where the length is not n².
    pub fn new(n: usize, a: &[f64]) -> Result<Self, NoConvergence> {
        assert_eq!(a.len(), n * n);
        if !a.iter().all(|value| value.is_finite()) {
            return Err(NoConvergence);
        }
        let factor = MatRef::from_column_major_slice(a, n, n).llt(Side::Lower).map_err(|_| NoConvergence)?;
        Ok(Self { n, factor })
    }

    /// x ← A⁻¹x, for as many columns as there are.
    ///
    /// # Panics
    /// Where the length is not a multiple of n.
    pub fn solve(&self, x: &mut [f64]) {
        let columns = x.len() / self.n.max(1);
        assert_eq!(x.len(), self.n * columns, "whole columns");
        self.factor.solve_in_place(MatMut::from_column_major_slice_mut(x, self.n, columns));
    }

    /// A⁻¹, n × n, column after column.
    pub fn inverse(&self) -> Vec<f64> {
        let mut columns: Vec<f64> =
            (0..self.n * self.n).map(|k| if k % self.n == k / self.n { 1.0 } else { 0.0 }).collect();
        self.solve(&mut columns);
        columns
    }

    /// ln det A.
    pub fn log_determinant(&self) -> f64 {
        let l = self.factor.L();
        (0..self.n).map(|i| 2.0 * l[(i, i)].ln()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_by_two_is_as_by_hand() {
        // [[4, 2], [2, 3]]: determinant 8, inverse [[3, −2], [−2, 4]]/8. The upper triangle is not read.
        let factor = Cholesky::new(2, &[4.0, 2.0, 9.0, 3.0]).unwrap();
        assert!((factor.log_determinant() - 8f64.ln()).abs() < 1e-15);
        for (found, expected) in factor.inverse().iter().zip([0.375, -0.25, -0.25, 0.5]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(Cholesky::new(1, &[-1.0]).err(), Some(NoConvergence));
        assert_eq!(Cholesky::new(1, &[f64::NAN]).err(), Some(NoConvergence));
    }
}
