//! Memory of a factorisation, foretold.

/// Bytes that one factorisation will take.
///
/// # Limits
/// Without the pivots that an indefinite matrix makes wait for a later front: each takes a column with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FactorMemory {
    /// Held as long as the factor is, the copy of the matrix that checks its solutions included.
    pub kept: usize,
    /// On top of it, while the factorisation runs.
    pub scratch: usize,
}

pub(super) fn bytes_of<T>(count: usize) -> usize {
    count.saturating_mul(size_of::<T>())
}
