//! Analyse → factor → solve for symmetric matrices, with every solution checked.
//!
//! ```
//! use frfit_linalg::{c64, solve::Analysis, sparse::Triplets};
//!
//! let mut triplets = Triplets::new(2);
//! triplets.add(0, 0, 2.0);
//! triplets.add(1, 0, 1.0);
//! triplets.add(1, 1, 3.0);
//! let matrix = triplets.assemble();
//! let analysis = Analysis::new(matrix.pattern()); // once for all matrices of this pattern
//! let factor = analysis.factor(matrix.real_values().unwrap())?;
//! let mut x = [3.0, 4.0];
//! let report = factor.solve(&mut x)?;
//! assert!((x[0] - 1.0).abs() < 1e-15 && report.backward_error < 1e-15);
//! # Ok::<(), frfit_linalg::solve::Breakdown>(())
//! ```

mod checked;
mod dense;
mod engine;
mod memory;
mod sparse;

pub use checked::{Breakdown, CheckedFactor, SolveReport};
pub use engine::{Engine, Factor, Multifrontal, Symbolic};
pub use memory::FactorMemory;
pub use sparse::elimination_order;

use crate::Scalar;
use crate::sparse::Pattern;
use sparse::Sparse;
use std::sync::Arc;

/// Up to this many unknowns a dense factorisation costs less than the bookkeeping of a sparse one
/// (measured on full and on banded matrices: they break even between 40 and 80).
pub const DENSE_LIMIT: usize = 48;

/// Everything about a pattern that no number changes: ordering and symbolic factorisations, done once
/// for all frequencies and shared between threads. A clone shares it too.
#[derive(Clone)]
pub struct Analysis {
    engine: Arc<str>,
    pattern: Arc<Pattern>,
    real: Arc<dyn Symbolic<f64>>,
    complex: Arc<dyn Symbolic<crate::c64>>,
    is_single_precision: bool,
}

impl Analysis {
    /// Analyses a pattern by the engine of this process ([`Multifrontal`]).
    pub fn new(pattern: &Arc<Pattern>) -> Self {
        Multifrontal.analyse(pattern)
    }

    /// From what an engine has found of a pattern, for each of the two scalars.
    pub fn of_engine(
        engine: impl Into<Arc<str>>,
        pattern: &Arc<Pattern>,
        real: Arc<dyn Symbolic<f64>>,
        complex: Arc<dyn Symbolic<crate::c64>>,
    ) -> Self {
        Self {
            engine: engine.into(),
            pattern: Arc::clone(pattern),
            real,
            complex,
            is_single_precision: false,
        }
    }

    /// The dense back-end, whatever the size.
    pub fn dense(pattern: &Arc<Pattern>) -> Self {
        let dense = || dense::DenseSymbolic::new(Arc::clone(pattern));
        Self::of_engine("dense", pattern, Arc::new(dense()), Arc::new(dense()))
    }

    /// The sparse back-end, whatever the size.
    pub fn sparse(pattern: &Arc<Pattern>) -> Self {
        let sparse = Arc::new(Sparse::new(pattern));
        Self::of_engine("multifrontal", pattern, Arc::clone(&sparse) as _, sparse)
    }

    /// The same with factors in single precision, which take half of the memory; symbolic factorisations are shared. `None` where the engine has none.
    ///
    /// Solutions are as accurate, by more refinement: see [`CheckedFactor::solve`].
    pub fn in_single_precision(&self) -> Option<Self> {
        let real = Arc::clone(&self.real).in_single_precision()?;
        let complex = Arc::clone(&self.complex).in_single_precision()?;
        let engine = format!("{}, single precision", self.engine);
        let single = Self::of_engine(engine, &self.pattern, real, complex);
        Some(Self { is_single_precision: true, ..single })
    }

    /// Whether its factors are in single precision.
    pub fn is_single_precision(&self) -> bool {
        self.is_single_precision
    }

    /// What computes the factors: `multifrontal`, `dense`, or what another engine calls itself.
    pub fn engine(&self) -> &str {
        &self.engine
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        self.pattern.dim()
    }

    /// The pattern that was analysed.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// Factorises the matrix with these values, in the order of the pattern, on one thread.
    ///
    /// # Errors
    /// [`Breakdown`] where a value is not finite, the factorisation breaks down, memory is short, or the engine fails.
    ///
    /// # Panics
    /// Where there is not one value for each position.
    pub fn factor<T: HasSymbolic>(&self, values: &[T]) -> Result<CheckedFactor<T>, Breakdown> {
        self.factor_on(values, 1)
    }

    /// As [`Analysis::factor`], by the calling thread alone where `threads` is 1 and by the rayon pool in which the call is
    /// made where it is more; solutions too. The numbers do not depend on it.
    ///
    /// # Errors
    /// As [`Analysis::factor`].
    pub fn factor_on<T: HasSymbolic>(
        &self,
        values: &[T],
        threads: usize,
    ) -> Result<CheckedFactor<T>, Breakdown> {
        CheckedFactor::new(&self.pattern, values.to_vec(), T::symbolic(self), threads)
    }

    /// What [`Analysis::factor`] will allocate, known before any number is: a model that cannot fit into memory
    /// can be refused before the attempt.
    ///
    /// From the symbolic factor, which is the numeric one's structure exactly but for pivots that have to wait
    /// (see [`FactorMemory`]).
    ///
    /// # Errors
    /// [`Breakdown::OutOfMemory`] where the symbolic factor does not fit, [`Breakdown::Engine`] where the engine says more.
    pub fn factor_memory<T: HasSymbolic>(&self) -> Result<FactorMemory, Breakdown> {
        let mut memory = T::symbolic(self).memory()?;
        memory.kept = memory.kept.saturating_add(memory::bytes_of::<T>(self.pattern.stored()));
        Ok(memory)
    }
}

/// Which of the two symbolic factorisations a scalar uses.
pub trait HasSymbolic: Scalar {
    #[doc(hidden)]
    fn symbolic(analysis: &Analysis) -> &dyn Symbolic<Self>;
}

impl HasSymbolic for f64 {
    fn symbolic(analysis: &Analysis) -> &dyn Symbolic<f64> {
        analysis.real.as_ref()
    }
}

impl HasSymbolic for crate::c64 {
    fn symbolic(analysis: &Analysis) -> &dyn Symbolic<crate::c64> {
        analysis.complex.as_ref()
    }
}

impl std::fmt::Debug for Analysis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Analysis").field("dim", &self.dim()).finish_non_exhaustive()
    }
}
