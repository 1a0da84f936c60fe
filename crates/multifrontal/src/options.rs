//! How a matrix is analysed, factorised and solved with.

use crate::{Ordering, Precision, Threads};

/// How a matrix is analysed, factorised and solved with. Each step reads what concerns it.
///
/// ```
/// use multifrontal::{Options, Ordering, Threads};
///
/// let options = Options::default().with_ordering(Ordering::NestedDissection).with_threads(Threads::Pool);
/// assert_eq!(options.threshold, 0.1);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// How rows are ordered: read by [`Symbolic::new`](crate::Symbolic::new).
    pub ordering: Ordering,
    /// Which threads work: read by every step.
    pub threads: Threads,
    /// No entry of L is larger than 1/threshold; from 0 to 1/2, and the nearer of these beyond them. Larger is
    /// safer and delays more pivots. Read by
    /// [`Symbolic::factor`](crate::Symbolic::factor) and [`Solver::new`](crate::Solver::new).
    pub threshold: f64,
    /// In which precision the factor is: read by [`Solver::new`](crate::Solver::new) alone. A factor of
    /// [`Symbolic::factor`](crate::Symbolic::factor) has the precision of its matrix.
    pub precision: Precision,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            ordering: Ordering::default(),
            threads: Threads::default(),
            threshold: 0.1,
            precision: Precision::default(),
        }
    }
}

impl Options {
    /// The same with this [`Options::ordering`].
    #[must_use]
    pub fn with_ordering(self, ordering: Ordering) -> Self {
        Self { ordering, ..self }
    }

    /// The same with these [`Options::threads`].
    #[must_use]
    pub fn with_threads(self, threads: Threads) -> Self {
        Self { threads, ..self }
    }

    /// The same with this [`Options::threshold`].
    #[must_use]
    pub fn with_threshold(self, threshold: f64) -> Self {
        Self { threshold, ..self }
    }

    /// The same with this [`Options::precision`].
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }
}
