//! Memory of a factorisation, foretold, and allocated without a panic where there is none.

use super::Breakdown;
use faer::dyn_stack::{MemBuffer, StackReq};

/// Bytes that one factorisation will take.
///
/// # Limits
/// Matrix products keep a packing buffer of a few MB in each thread, once; it is not in here.
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

pub(super) fn scratch(request: StackReq) -> Result<MemBuffer, Breakdown> {
    MemBuffer::try_new(request).map_err(|_| Breakdown::OutOfMemory)
}

pub(super) fn zeros<T: Copy + Default>(len: usize) -> Result<Vec<T>, Breakdown> {
    let mut values = Vec::new();
    values.try_reserve_exact(len).map_err(|_| Breakdown::OutOfMemory)?;
    values.resize(len, T::default());
    Ok(values)
}
