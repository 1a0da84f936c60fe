//! No solution leaves unchecked: finite, true residual, one refinement step, a typed outcome.

use super::memory::bytes_of;
use super::{Factor, Symbolic};
use crate::Scalar;
use crate::dense::symmetric_eigen;
use crate::scalar::max_modulus;
use crate::sparse::Pattern;
use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

/// A solution is refined once where its backward error is above this: a few hundred units of roundoff,
/// the growth that threshold pivoting leaves on well-scaled matrices.
const REFINE_ABOVE: f64 = 1e-14;

/// A solution that refinement has not brought below this backward error is refused: half of the digits.
const REFUSE_ABOVE: f64 = 1e-8;

/// A matrix whose condition number is certainly above this (‖A‖·‖x‖/‖b‖ bounds it from below) is singular
/// to working precision: no digit of the solution is left.
const SINGULAR_ABOVE: f64 = 1e16;

/// Solutions that are refined together.
const MAX_REFINED_AT_ONCE: usize = 4;

/// Corrections that a refinement keeps, and steps within which it has to halve its error: as many eigenvalues near zero as single precision may have lost at once.
const MAX_CORRECTIONS: usize = 6;

/// A factorised symmetric matrix whose solutions are checked against the matrix itself.
pub struct CheckedFactor<T> {
    pattern: Arc<Pattern>,
    values: Vec<T>,
    norm: f64,
    factor: Box<dyn Factor<T>>,
    threads: usize,
}

/// How good a solution is, as measured on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolveReport {
    /// max over right-hand sides of ‖b − A x‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞), after refinement if there was any.
    pub backward_error: f64,
    /// ‖A‖∞ ‖x‖∞ / ‖b‖∞, which bounds the condition number from below.
    pub condition_at_least: f64,
    /// Whether a refinement step was taken.
    pub refined: bool,
}

/// Why a matrix could not be factorised or a system not be solved.
#[derive(Debug, Clone, PartialEq)]
pub enum Breakdown {
    /// A value of the matrix or of a right-hand side is infinite or not a number.
    NotFinite,
    /// Singular to working precision; the evidence is a lower bound of the condition number
    /// (infinite where the factorisation itself met a zero pivot).
    Singular {
        /// The bound.
        condition_at_least: f64,
    },
    /// The solution does not satisfy the equations, even after refinement.
    Inaccurate {
        /// ‖b − A x‖∞ / (‖A‖∞ ‖x‖∞ + ‖b‖∞).
        backward_error: f64,
    },
    /// The factor does not fit into memory.
    OutOfMemory,
    /// The engine that computes factors elsewhere failed; its own words.
    Engine(String),
}

impl fmt::Display for Breakdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "a value is infinite or not a number"),
            Self::Singular { condition_at_least } if condition_at_least.is_infinite() => {
                write!(f, "the matrix is singular (a pivot is zero)")
            }
            Self::Singular { condition_at_least } => {
                write!(
                    f,
                    "the matrix is singular to working precision (condition ≥ {condition_at_least:.1e})"
                )
            }
            Self::Inaccurate { backward_error } => {
                write!(f, "the solution leaves a residual (backward error {backward_error:.1e})")
            }
            Self::OutOfMemory => write!(f, "the factor does not fit into memory"),
            Self::Engine(words) => write!(f, "{words}"),
        }
    }
}

impl std::error::Error for Breakdown {}

impl<T: Scalar> CheckedFactor<T> {
    pub(super) fn new(
        pattern: &Arc<Pattern>,
        values: Vec<T>,
        symbolic: &dyn Symbolic<T>,
        threads: usize,
    ) -> Result<Self, Breakdown> {
        assert_eq!(values.len(), pattern.stored(), "one value for each position");
        let norm = infinity_norm(pattern, &values);
        if !norm.is_finite() {
            return Err(Breakdown::NotFinite);
        }
        let factor = symbolic.factor(&values, threads)?;
        Ok(Self { pattern: Arc::clone(pattern), values, norm, factor, threads })
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        self.pattern.dim()
    }

    /// Overwrites k right-hand sides (n × k, column after column) with the solutions of A X = B.
    ///
    /// # Errors
    /// [`Breakdown`] where the right-hand side or the solution is not finite, where the matrix shows itself
    /// singular, or where the residual stays large. The contents of `rhs` are then meaningless.
    ///
    /// # Panics
    /// Where the length of `rhs` is not a multiple of n.
    ///
    /// # Limits
    /// A small residual is not a small error: the error is up to the condition number times it.
    pub fn solve(&self, rhs: &mut [T]) -> Result<SolveReport, Breakdown> {
        let n = self.dim();
        let mut worst = SolveReport { backward_error: 0.0, condition_at_least: 0.0, refined: false };
        if n == 0 {
            return Ok(worst);
        }
        assert_eq!(rhs.len() % n, 0, "whole right-hand sides");
        if !rhs.iter().all(|value| value.is_finite()) {
            return Err(Breakdown::NotFinite);
        }
        let given = rhs.to_vec();
        self.factor.solve_in_place(rhs, self.threads)?;
        let (residuals, errors) = self.residuals(&given, rhs)?;
        let inaccurate: Vec<usize> = (0..errors.len()).filter(|&k| errors[k] > REFINE_ABOVE).collect();
        let report = |backward_error| SolveReport { backward_error, condition_at_least: 0.0, refined: false };
        let mut reports: Vec<SolveReport> = errors.into_iter().map(report).collect();
        let at_once = if self.factor.max_refinements() > 1 { MAX_REFINED_AT_ONCE } else { given.len() / n };
        for columns in inaccurate.chunks(at_once.max(1)) {
            let of =
                |all: &[T]| -> Vec<T> { columns.iter().flat_map(|&k| &all[k * n..][..n]).copied().collect() };
            let (given, mut refined) = (of(&given), of(rhs));
            let errors = self.refine(&given, &mut refined, of(&residuals))?;
            for ((&k, x), backward_error) in columns.iter().zip(refined.chunks_exact(n)).zip(errors) {
                rhs[k * n..][..n].copy_from_slice(x);
                reports[k] = SolveReport { refined: true, ..report(backward_error) };
            }
        }
        for ((b, x), report) in given.chunks_exact(n).zip(rhs.chunks_exact(n)).zip(reports) {
            let report = self.judge(b, x, report)?;
            worst.backward_error = worst.backward_error.max(report.backward_error);
            worst.condition_at_least = worst.condition_at_least.max(report.condition_at_least);
            worst.refined |= report.refined;
        }
        Ok(worst)
    }

    /// One step of refinement, x += M⁻¹ r with the factor M and the residual r = b − A x; with a factor in single precision as many as it takes.
    ///
    /// A further step takes its correction z = M⁻¹ r as far as makes the residual least, with the corrections before it (GCR): single precision loses
    /// the directions of eigenvalues near zero, and each of them takes a step. Returns the backward errors.
    ///
    /// # Source
    /// S. C. Eisenstat, H. C. Elman, M. H. Schultz, SIAM J. Numer. Anal. 20 (1983) 345–357.
    fn refine(&self, b: &[T], x: &mut [T], mut residuals: Vec<T>) -> Result<Vec<f64>, Breakdown> {
        let n = self.dim();
        self.factor.solve_in_place(&mut residuals, self.threads)?;
        x.iter_mut().zip(&residuals).for_each(|(x, dx)| *x += *dx);
        let (mut residuals, mut errors) = self.residuals(b, x)?;
        // Corrections z, and A z at right angles to each other.
        let mut before: VecDeque<[Vec<T>; 2]> = VecDeque::new();
        let mut earlier = f64::INFINITY;
        for step in 1..self.factor.max_refinements() {
            let worst = errors.iter().copied().fold(0.0, f64::max);
            let is_checkpoint = step % MAX_CORRECTIONS == 0;
            if worst <= REFINE_ABOVE || (is_checkpoint && worst > 0.5 * earlier) {
                break;
            }
            if is_checkpoint {
                earlier = worst;
            }
            let mut corrections = residuals.clone();
            self.factor.solve_in_place(&mut corrections, self.threads)?;
            let mut products = vec![T::default(); corrections.len()];
            T::multiply_subtract(&self.pattern, &self.values, &corrections, &mut products);
            products.iter_mut().for_each(|product| *product = -*product);
            for (column, error) in (0..x.len()).step_by(n).map(|start| start..start + n).zip(&mut errors) {
                let (z, q) = (&mut corrections[column.clone()], &mut products[column.clone()]);
                for [zs, qs] in &before {
                    let older = &qs[column.clone()];
                    let share = -part_along(older, q);
                    add(share, older, q);
                    add(share, &zs[column.clone()], z);
                }
                let (x, residual) = (&mut x[column.clone()], &mut residuals[column.clone()]);
                let share = part_along(q, residual);
                add(share, z, x);
                add(-share, q, residual);
                *error = self.relative(residual, &b[column], x)?;
            }
            before.push_back([corrections, products]);
            if before.len() > MAX_CORRECTIONS {
                before.pop_front();
            }
        }
        // Of several steps the residuals were updated; what counts is the true one.
        Ok(if before.is_empty() { errors } else { self.residuals(b, x)?.1 })
    }

    fn judge(&self, b: &[T], x: &[T], report: SolveReport) -> Result<SolveReport, Breakdown> {
        let size = max_modulus(b);
        let condition_at_least = if size > 0.0 { self.norm * max_modulus(x) / size } else { 0.0 };
        if condition_at_least > SINGULAR_ABOVE {
            return Err(Breakdown::Singular { condition_at_least });
        }
        if report.backward_error > REFUSE_ABOVE {
            return Err(Breakdown::Inaccurate { backward_error: report.backward_error });
        }
        Ok(SolveReport { condition_at_least, ..report })
    }

    /// B − A X, and of each column the size relative to ‖A‖∞‖x‖∞ + ‖b‖∞; an x that is not finite is a singular matrix's.
    fn residuals(&self, b: &[T], x: &[T]) -> Result<(Vec<T>, Vec<f64>), Breakdown> {
        let n = self.dim();
        let mut residuals = b.to_vec();
        T::multiply_subtract(&self.pattern, &self.values, x, &mut residuals);
        let columns = residuals.chunks_exact(n).zip(b.chunks_exact(n).zip(x.chunks_exact(n)));
        let errors =
            columns.map(|(residual, (b, x))| self.relative(residual, b, x)).collect::<Result<_, _>>()?;
        Ok((residuals, errors))
    }

    /// ‖r‖∞ / (‖A‖∞‖x‖∞ + ‖b‖∞).
    fn relative(&self, residual: &[T], b: &[T], x: &[T]) -> Result<f64, Breakdown> {
        let scale = self.norm * max_modulus(x) + max_modulus(b);
        let relative = if scale > 0.0 { max_modulus(residual) / scale } else { 0.0 };
        let finite = relative.is_finite() && scale.is_finite();
        finite.then_some(relative).ok_or(Breakdown::Singular { condition_at_least: f64::INFINITY })
    }
}

impl CheckedFactor<f64> {
    /// Eigenvalues of the matrix below zero: by Sylvester's law the negative pivots of its LDLᵀ, or by an eigenvalue decomposition where it is small.
    ///
    /// # Limits
    /// An eigenvalue within roundoff of zero may be counted on either side.
    pub fn negative_eigenvalues(&self) -> usize {
        self.factor.negative_eigenvalues().unwrap_or_else(|| {
            let n = self.dim();
            let mut full = vec![0.0; n * n];
            for ((row, col), &value) in self.pattern.positions().zip(&self.values) {
                full[row + col * n] = value;
            }
            let values = symmetric_eigen(n, &full).map_or(Vec::new(), |(values, _)| values);
            values.iter().filter(|value| **value < 0.0).count()
        })
    }
}

impl<T> fmt::Debug for CheckedFactor<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CheckedFactor").field("dim", &self.pattern.dim()).finish_non_exhaustive()
    }
}

/// Bytes that the refinement of solutions with a factor in single precision takes at most.
pub(super) fn refinement_bytes<T>(n: usize) -> usize {
    // Of each column: corrections and their products, those at hand, right-hand side, solution and residual.
    bytes_of::<T>(n.saturating_mul(MAX_REFINED_AT_ONCE * (2 * MAX_CORRECTIONS + 5)))
}

/// qᴴr / qᴴq; 0 for q = 0.
fn part_along<T: Scalar>(q: &[T], r: &[T]) -> T {
    let dot = |a: &[T], b: &[T]| {
        a.iter().zip(b).fold(T::default(), |sum, (a, b)| sum + multifrontal::Scalar::conjugate(*a) * *b)
    };
    let size = dot(q, q);
    if size.modulus() > 0.0 { dot(q, r) / size } else { T::default() }
}

/// y += a x.
fn add<T: Scalar>(a: T, x: &[T], y: &mut [T]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * *x);
}

/// ‖A‖∞ = max over rows of Σ|a|; NaN where a value is NaN.
fn infinity_norm<T: Scalar>(pattern: &Pattern, values: &[T]) -> f64 {
    let mut row_sums = vec![0.0; pattern.dim()];
    for ((row, col), value) in pattern.positions().zip(values) {
        row_sums[row] += value.modulus();
        if row != col {
            row_sums[col] += value.modulus();
        }
    }
    max_modulus(&row_sums)
}
