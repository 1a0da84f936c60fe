//! Sparse symmetric matrices, definite or not, real or complex: L D Lᵀ by [`multifrontal`].

use super::checked::refinement_bytes;
use super::memory::FactorMemory;
use super::{Breakdown, Factor, Symbolic};
use crate::Scalar;
use crate::sparse::Pattern;
use multifrontal::{FactorError, Options, PatternError, RoundedFactor, Threads};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// How long the pool's idle threads look for work before they sleep: a factorisation is followed by solutions, and to
/// wake a thread takes longer than many a piece of them.
const SPIN: Duration = Duration::from_millis(1);

/// One thread, or those of the pool in which the call is made.
fn threads(threads: usize) -> Threads {
    if threads < 2 { Threads::One } else { Threads::Spinning(SPIN) }
}

/// The order in which [`multifrontal`] eliminates the rows of a pattern: the k-th is row `order[k]`.
///
/// For an engine that takes an order: ours needs fewer operations than those that other solvers find.
///
/// # Errors
/// [`Breakdown::OutOfMemory`] where the pattern has more rows or entries than 32 bits number.
pub fn elimination_order(pattern: &Arc<Pattern>) -> Result<Vec<u32>, Breakdown> {
    Ok(Sparse::new(pattern).symbolic()?.order().to_vec())
}

/// Ordering and fronts of a pattern, found when first needed and shared by real and complex matrices.
pub(super) struct Sparse {
    pattern: Arc<Pattern>,
    symbolic: OnceLock<Result<multifrontal::Symbolic, PatternError>>,
}

impl Sparse {
    pub(super) fn new(pattern: &Arc<Pattern>) -> Self {
        Self { pattern: Arc::clone(pattern), symbolic: OnceLock::new() }
    }

    fn symbolic(&self) -> Result<&multifrontal::Symbolic, Breakdown> {
        let (n, columns, rows) = (self.pattern.dim(), self.pattern.col_ptr(), self.pattern.row_idx());
        let symbolic =
            self.symbolic.get_or_init(|| multifrontal::Symbolic::new(n, columns, rows, &Options::default()));
        // A pattern is a lower triangle by construction: all that can be wrong with it is its size.
        symbolic.as_ref().map_err(|_| Breakdown::OutOfMemory)
    }
}

/// The same with factors in single precision.
struct Single(Arc<Sparse>);

/// Refinement steps with a factor in single precision: each gains some seven digits, or finds one more direction that single precision has lost.
const MAX_SINGLE_REFINEMENTS: usize = 24;

fn options(threads: usize) -> Options {
    Options::default().with_threads(self::threads(threads))
}

fn breakdown(error: FactorError) -> Breakdown {
    match error {
        FactorError::NotFinite { .. } => Breakdown::NotFinite,
        FactorError::Singular { .. } => Breakdown::Singular { condition_at_least: f64::INFINITY },
        // One value an entry is asserted before, and nothing is solved yet: what is left is memory.
        _ => Breakdown::OutOfMemory,
    }
}

impl<T: Scalar> Symbolic<T> for Sparse {
    fn factor(&self, values: &[T], threads: usize) -> Result<Box<dyn Factor<T>>, Breakdown> {
        Ok(Box::new(self.symbolic()?.factor(values, &options(threads)).map_err(breakdown)?))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        let symbolic = self.symbolic()?;
        Ok(FactorMemory { kept: symbolic.factor_bytes::<T>(), scratch: symbolic.working_bytes::<T>() })
    }

    fn in_single_precision(self: Arc<Self>) -> Option<Arc<dyn Symbolic<T>>> {
        Some(Arc::new(Single(self)))
    }
}

impl<T: Scalar> Symbolic<T> for Single {
    fn factor(&self, values: &[T], threads: usize) -> Result<Box<dyn Factor<T>>, Breakdown> {
        Ok(Box::new(self.0.symbolic()?.factor_rounded(values, &options(threads)).map_err(breakdown)?))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        let symbolic = self.0.symbolic()?;
        let kept = symbolic.rounded_factor_bytes::<T>();
        // Factorisation and refinement do not run at the same time.
        let scratch = symbolic.rounded_working_bytes::<T>().max(refinement_bytes::<T>(symbolic.dim()));
        Ok(FactorMemory { kept, scratch })
    }
}

impl<T: Scalar> Factor<T> for RoundedFactor<T> {
    fn solve_in_place(&self, rhs: &mut [T], threads: usize) -> Result<(), Breakdown> {
        RoundedFactor::solve_in_place(self, rhs, self::threads(threads));
        Ok(())
    }

    fn max_refinements(&self) -> usize {
        MAX_SINGLE_REFINEMENTS
    }

    fn negative_eigenvalues(&self) -> Option<usize> {
        Some(self.inertia().negative)
    }
}

impl<T: Scalar> Factor<T> for multifrontal::Factor<T> {
    fn solve_in_place(&self, rhs: &mut [T], threads: usize) -> Result<(), Breakdown> {
        multifrontal::Factor::solve_in_place(self, rhs, self::threads(threads));
        Ok(())
    }

    fn negative_eigenvalues(&self) -> Option<usize> {
        Some(self.inertia().negative)
    }
}
