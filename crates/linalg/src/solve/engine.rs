//! What computes a factor: the solver of this process, or one elsewhere.

use super::{Analysis, Breakdown, DENSE_LIMIT, FactorMemory};
use crate::Scalar;
use crate::sparse::Pattern;
use std::fmt;
use std::sync::Arc;

/// A direct solver for symmetric matrices: analyse → factor → solve a block, inertia, memory foretold.
///
/// Whatever computes the factor, [`CheckedFactor`](super::CheckedFactor) tests every solution by its true residual.
pub trait Engine: fmt::Debug + Send + Sync {
    /// Analyses a pattern. It may put the work off until the first factorisation, which then reports what failed.
    fn analyse(&self, pattern: &Arc<Pattern>) -> Analysis;
}

/// Everything that an engine knows of a pattern before it has numbers.
pub trait Symbolic<T: Scalar>: Send + Sync {
    /// Factor of the matrix with these values (in the order of the pattern, all finite).
    ///
    /// # Errors
    /// [`Breakdown`] where the matrix is singular, memory is short, or the engine fails.
    fn factor(&self, values: &[T], threads: usize) -> Result<Box<dyn Factor<T>>, Breakdown>;

    /// What [`Symbolic::factor`] will allocate in this process.
    ///
    /// # Errors
    /// [`Breakdown`] where the factor cannot fit, here or where the engine runs.
    fn memory(&self) -> Result<FactorMemory, Breakdown>;

    /// The same with factors in single precision, where the engine has them.
    fn in_single_precision(self: Arc<Self>) -> Option<Arc<dyn Symbolic<T>>> {
        None
    }
}

/// A factorised matrix.
pub trait Factor<T: Scalar>: Send + Sync {
    /// Overwrites k right-hand sides (n × k, column after column) with the solutions, unchecked.
    ///
    /// # Errors
    /// [`Breakdown::Engine`] where the engine fails.
    fn solve_in_place(&self, rhs: &mut [T], threads: usize) -> Result<(), Breakdown>;

    /// Refinement steps that its solutions may take: one mends what pivoting leaves, more are for a factor in single precision.
    fn max_refinements(&self) -> usize {
        1
    }

    /// Eigenvalues below zero, where the engine counts them: of real matrices.
    fn negative_eigenvalues(&self) -> Option<usize>;
}

/// The engine of this process: L D Lᵀ by [`multifrontal`], and dense LU up to [`DENSE_LIMIT`] unknowns.
#[derive(Debug, Clone, Copy, Default)]
pub struct Multifrontal;

impl Engine for Multifrontal {
    fn analyse(&self, pattern: &Arc<Pattern>) -> Analysis {
        if pattern.dim() <= DENSE_LIMIT { Analysis::dense(pattern) } else { Analysis::sparse(pattern) }
    }
}
