//! A x = b by LU with partial pivoting.

use super::split_complex_lu::PlanarLu;
use super::{Matrix, NoConvergence, combination};
use crate::c64;
use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, MatMut};

/// A factorised square matrix, P A = L U.
#[derive(Debug, Clone)]
pub struct Lu(Factor);

#[derive(Debug, Clone)]
enum Factor {
    SplitComplexLu(PlanarLu),
    Blocked(PartialPivLu<c64>),
}

/// Up to so many rows a library's blocks cost more than they gain: of 18 rows, with three right-hand sides, 2.9 µs against 4.9; of 64 both take 36.
const MAX_SPLIT_ROWS: usize = 64;

/// The same where the matrix is put together too, which is done in place: of 54 rows 20 µs against 24, of 72 40 against 46, of 128 182 against 192; of 166
/// both take 387.
const MAX_COMBINED_ROWS: usize = 128;

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
        Ok(Self(if a.nrows() <= MAX_SPLIT_ROWS {
            Factor::SplitComplexLu(PlanarLu::new(a))
        } else {
            Factor::Blocked(a.as_faer().partial_piv_lu())
        }))
    }

    /// Factorises Σ θ_g S_g of real n × n matrices, column after column.
    ///
    /// # Errors
    /// [`NoConvergence`] where the sum has values that are not finite.
    ///
    /// # Panics
    /// Where a matrix is of another size.
    pub fn of_combination(dim: usize, parts: &[(c64, &[f64])]) -> Result<Self, NoConvergence> {
        assert!(parts.iter().all(|(_, matrix)| matrix.len() == dim * dim));
        if dim > MAX_COMBINED_ROWS {
            return Self::new(&combination(dim, dim, parts));
        }
        let factor = PlanarLu::of_combination(dim, parts).ok_or(NoConvergence)?;
        Ok(Self(Factor::SplitComplexLu(factor)))
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        match &self.0 {
            Factor::SplitComplexLu(factor) => factor.dim(),
            Factor::Blocked(factor) => factor.L().nrows(),
        }
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
        match &self.0 {
            Factor::SplitComplexLu(factor) => factor.solve(rhs),
            Factor::Blocked(factor) => {
                let view = MatMut::from_column_major_slice_mut(rhs, n, rhs.len() / n);
                factor.solve_in_place_with_conj(Conj::No, view);
            }
        }
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
    fn solutions_solve_in_both_forms() {
        for n in (0..20)
            .chain([MAX_SPLIT_ROWS - 1, MAX_SPLIT_ROWS, MAX_SPLIT_ROWS + 1, MAX_SPLIT_ROWS + 9])
            .filter(|&n| n != 1)
        {
            let a = matrix(n);
            let lu = Lu::new(&a).unwrap();
            assert_eq!((lu.dim(), matches!(lu.0, Factor::SplitComplexLu(_))), (n, n <= MAX_SPLIT_ROWS));
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
    fn a_combination_is_factorised_as_its_sum() {
        let theta = [c64::new(0.5, 2.0), c64::new(-1.0, 0.25)];
        for n in [0, 1, 5, 8, 50, MAX_COMBINED_ROWS, MAX_COMBINED_ROWS + 3] {
            let part = |k: usize| ((k * k + 3 * k) as f64 * 0.618_034).fract() - 0.5;
            let of = |seed: usize| -> Vec<f64> { (0..n * n).map(|k| part(k + seed)).collect() };
            let (a, b) = (of(1), of(n * n + 7));
            let parts = [(theta[0], a.as_slice()), (theta[1], b.as_slice())];
            let mut x: Vec<c64> = (0..2 * n).map(|k| c64::new(k as f64, 1.0)).collect();
            let rhs = x.clone();
            Lu::of_combination(n, &parts).unwrap().solve(&mut x).unwrap();
            let sum = combination(n, n, &parts);
            for (x, rhs) in x.chunks_exact(n.max(1)).zip(rhs.chunks_exact(n.max(1))) {
                let off = sum.multiply(x).iter().zip(rhs).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                // Right-hand sides up to 260, condition numbers of some thousands.
                assert!(off < 1e-8, "{n}: {off}");
            }
        }
        let infinite = [(theta[0], &[f64::INFINITY, 0.0, 0.0, 1.0][..])];
        assert!(Lu::of_combination(2, &infinite).is_err());
    }

    #[test]
    fn both_forms_say_where_there_is_no_solution() {
        for n in [1, 5, MAX_SPLIT_ROWS + 1] {
            let mut a = matrix(n);
            (0..n).for_each(|i| a[(i, n - 1)] = c64::default());
            let singular = Lu::new(&a).and_then(|lu| lu.solve(&mut vec![c64::new(1.0, 0.0); n]));
            assert_eq!(singular, Err(NoConvergence), "{n}");
            a[(0, 0)] = c64::new(f64::NAN, 0.0);
            assert!(Lu::new(&a).is_err());
        }
    }
}
