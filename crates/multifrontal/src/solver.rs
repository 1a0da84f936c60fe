//! Solutions that are checked: residual, refinement, condition, and single precision where it is enough.

use crate::scalar::{Real, Scalar};
use crate::{Factor, FactorError, Options, Ordering, RoundedFactor, Symbolic, size};
use std::sync::OnceLock;

/// Refinement stops below this many units of roundoff: a residual itself has a few.
const REFINED_RESIDUAL_ROUNDOFFS: f64 = 4.0;

/// Refinement steps at most: those of a double factor converge at once or never, those of a single one gain
/// seven digits a step on a matrix that it suits.
const MAX_REFINEMENT_STEPS: usize = 8;

/// In which precision a matrix is factorised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Precision {
    /// The precision of the matrix.
    #[default]
    Full,
    /// Single precision in half of the memory, and refinement to the precision of the matrix. Where refinement
    /// does not get there the matrix is factorised once more, in full.
    Single,
}

/// How good a solution is, as measured on it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Solution {
    /// The largest of all right-hand sides' ‖b − A x‖ / (‖A‖ ‖x‖ + ‖b‖), in the maximum norm.
    pub backward_error: f64,
    /// The most refinement steps that one took.
    pub refinements: usize,
    /// The precision of the factor that gave it.
    pub precision: Precision,
}

/// A matrix with its factor.
#[derive(Debug)]
pub struct Solver<'a, T: Scalar> {
    symbolic: &'a Symbolic,
    values: &'a [T],
    options: Options,
    norm: f64,
    single: Option<RoundedFactor<T>>,
    full: OnceLock<Result<Factor<T>, FactorError>>,
}

impl<'a, T: Scalar> Solver<'a, T> {
    /// Factorises a matrix, to solve with it again and again.
    ///
    /// # Errors
    /// As [`Symbolic::factor`].
    pub fn new(symbolic: &'a Symbolic, values: &'a [T], options: &Options) -> Result<Self, FactorError> {
        // An order may be as long as the matrix, and is not needed any more.
        let &Options { threads, threshold, precision, .. } = options;
        let mut solver = Self {
            symbolic,
            values,
            options: Options { ordering: Ordering::default(), threads, threshold, precision },
            norm: 0.0,
            single: None,
            full: OnceLock::new(),
        };
        if precision == Precision::Single {
            // What single precision cannot factorise, full precision may.
            solver.single = symbolic.factor_rounded(values, options).ok();
        }
        if solver.single.is_none() {
            solver.factor()?;
        }
        solver.norm = solver.row_sums().into_iter().fold(0.0, f64::max);
        Ok(solver)
    }

    /// The factor in full precision, made where there was none yet.
    ///
    /// # Errors
    /// As [`Symbolic::factor`].
    pub fn factor(&self) -> Result<&Factor<T>, FactorError> {
        let factor = match self.full.get() {
            Some(factor) => factor,
            None => {
                // Not while others wait for it: a thread that waits for a piece of this work may take up other work,
                // and that may ask for this factor too.
                let factor = self.symbolic.factor(self.values, &self.options);
                self.full.get_or_init(|| factor)
            }
        };
        factor.as_ref().map_err(Clone::clone)
    }

    /// Overwrites k right-hand sides (n × k, column after column) with the solutions, refined until their residuals
    /// are roundoff or do not become smaller.
    ///
    /// # Errors
    /// [`FactorError::NoSolution`] where a solution is not of finite numbers; as [`Symbolic::factor`], where single
    /// precision was not enough.
    ///
    /// # Panics
    /// Where there are not whole right-hand sides.
    ///
    /// # Limits
    /// A small backward error is not a small error: that is up to [`Solver::condition`] times larger.
    pub fn solve(&self, rhs: &mut [T]) -> Result<Solution, FactorError> {
        let given = rhs.to_vec();
        if let Some(single) = &self.single {
            let solve = |x: &mut [T]| single.solve_in_place(x, self.options.threads);
            let solution = self.refined(&given, rhs, solve, Precision::Single);
            if solution.backward_error <= REFINED_RESIDUAL_ROUNDOFFS * T::Real::ROUNDOFF {
                return Ok(solution);
            }
            rhs.copy_from_slice(&given);
        }
        let factor = self.factor()?;
        let solve = |x: &mut [T]| factor.solve_in_place(x, self.options.threads);
        let solution = self.refined(&given, rhs, solve, Precision::Full);
        match rhs.iter().position(|x| !x.is_finite()) {
            Some(at) => Err(FactorError::NoSolution { column: at / self.symbolic.dim() }),
            None => Ok(solution),
        }
    }

    fn refined(&self, given: &[T], x: &mut [T], solve: impl Fn(&mut [T]), precision: Precision) -> Solution {
        solve(x);
        let mut solution = Solution { backward_error: 0.0, refinements: 0, precision };
        let n = self.symbolic.dim().max(1);
        for (b, x) in given.chunks_exact(n).zip(x.chunks_exact_mut(n)) {
            let (mut residual, mut error) = self.residual(b, x);
            let mut steps = 0;
            while error > REFINED_RESIDUAL_ROUNDOFFS * T::Real::ROUNDOFF && steps < MAX_REFINEMENT_STEPS {
                solve(&mut residual);
                let better: Vec<T> = x.iter().zip(&residual).map(|(&x, &dx)| x + dx).collect();
                let (next, next_error) = self.residual(b, &better);
                // Less than half: what is left is not this factor's to mend.
                let worth = next_error < 0.5 * error;
                if next_error < error || error.is_nan() {
                    x.copy_from_slice(&better);
                    (residual, error) = (next, next_error);
                    steps += 1;
                }
                if !worth {
                    break;
                }
            }
            solution.refinements = solution.refinements.max(steps);
            // A residual that is no number is the worst of all.
            if error.is_nan() || error > solution.backward_error {
                solution.backward_error = error;
            }
        }
        solution
    }

    /// b − A x, and its size against ‖A‖ ‖x‖ + ‖b‖.
    fn residual(&self, b: &[T], x: &[T]) -> (Vec<T>, f64) {
        let mut residual = b.to_vec();
        for ((row, col), &value) in self.symbolic.pattern.positions().zip(self.values) {
            residual[row] -= value * x[col];
            if row != col {
                residual[col] -= value * x[row];
            }
        }
        let scale = self.norm * size(x) + size(b);
        // If the scale is not a number, neither is the error.
        let error = if scale == 0.0 { 0.0 } else { size(&residual) / scale };
        (residual, error)
    }

    fn row_sums(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.symbolic.dim()];
        for ((row, col), value) in self.symbolic.pattern.positions().zip(self.values) {
            sums[row] += value.modulus();
            if row != col {
                sums[col] += value.modulus();
            }
        }
        sums
    }

    /// An estimate of ‖A‖₁ ‖A⁻¹‖₁ from a few solutions: a lower bound, hardly ever ten times too small.
    ///
    /// # Errors
    /// As [`Symbolic::factor`], where there is no factor in full precision yet.
    ///
    /// # Source
    /// N. J. Higham, ACM Trans. Math. Softw. 14 (1988) 381–396.
    pub fn condition(&self) -> Result<f64, FactorError> {
        let factor = self.factor()?;
        let n = self.symbolic.dim();
        let mut x = vec![T::from_real(T::Real::from_f64(1.0 / n.max(1) as f64)); n];
        let (mut estimate, mut visited) = (0.0f64, None);
        // Five steps are more than it takes almost always.
        for _ in 0..5 {
            factor.solve_in_place(&mut x, self.options.threads);
            let sum: f64 = x.iter().map(|x| x.modulus()).sum();
            if sum <= estimate {
                break;
            }
            estimate = sum;
            // A⁻¹ is symmetric, so that its adjoint is its conjugate.
            let mut signs: Vec<T> = x.iter().map(|&x| sign(x).conjugate()).collect();
            factor.solve_in_place(&mut signs, self.options.threads);
            let Some(largest) = (0..n).max_by(|&a, &b| signs[a].modulus().total_cmp(&signs[b].modulus()))
            else {
                break;
            };
            if visited.replace(largest) == Some(largest) {
                break;
            }
            x.fill(T::default());
            x[largest] = T::ONE;
        }
        // What the steps above may miss for a matrix of whole numbers: a vector of A⁻¹ that is large, and at right angles to all ones.
        let alternating =
            |i: usize| (1.0 + i as f64 / n.max(2) as f64) * if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        x.iter_mut().enumerate().for_each(|(i, x)| *x = T::from_real(T::Real::from_f64(alternating(i))));
        factor.solve_in_place(&mut x, self.options.threads);
        let sum: f64 = x.iter().map(|x| x.modulus()).sum();
        Ok(self.norm * estimate.max(2.0 * sum / (3.0 * n.max(1) as f64)))
    }
}

fn sign<T: Scalar>(x: T) -> T {
    let size = x.modulus();
    if size > 0.0 { x.scale(T::Real::from_f64(1.0 / size)) } else { T::ONE }
}
