//! Room for many numbers, in large pages where the system has them.
//!
//! A factor is read from end to end with each solution: with pages of 4 kB a tenth of the time goes into finding them,
//! and when it is written for the first time each page is a call of the system.

use crate::scalar::Real;
use memmap2::MmapMut;
use pulp::bytemuck::{cast_slice, cast_slice_mut};
use std::ops::{Deref, DerefMut};

/// Bytes of a large page.
const LARGE: usize = 2 << 20;

/// Numbers that are zero at first.
#[derive(Debug)]
pub(crate) enum Memory<R> {
    /// Of the allocator.
    Small(Vec<R>),
    /// Whole pages of the system: so many numbers from a byte on.
    Pages { pages: MmapMut, from: usize, len: usize },
}

impl<R: Real> Memory<R> {
    pub(crate) fn zeros(len: usize) -> Self {
        Self::pages(len).unwrap_or_else(|| Self::Small(vec![R::default(); len]))
    }

    /// From a large page on, and to the end of one; `None` where that is not worth it, or not to be had.
    fn pages(len: usize) -> Option<Self> {
        let bytes = len.checked_mul(size_of::<R>()).filter(|&bytes| bytes >= LARGE)?;
        let pages = MmapMut::map_anon(bytes.checked_next_multiple_of(LARGE)?.checked_add(LARGE)?).ok()?;
        // A system without large pages has small ones.
        #[cfg(target_os = "linux")]
        let _ = pages.advise(memmap2::Advice::HugePage);
        let from = pages.as_ptr().align_offset(LARGE);
        (from <= LARGE).then_some(Self::Pages { pages, from, len })
    }
}

impl<R> Default for Memory<R> {
    fn default() -> Self {
        Self::Small(Vec::new())
    }
}

impl<R: Real> Deref for Memory<R> {
    type Target = [R];

    fn deref(&self) -> &[R] {
        match self {
            Self::Small(values) => values,
            &Self::Pages { ref pages, from, len } => cast_slice(&pages[from..from + len * size_of::<R>()]),
        }
    }
}

impl<R: Real> DerefMut for Memory<R> {
    fn deref_mut(&mut self) -> &mut [R] {
        match self {
            Self::Small(values) => values,
            &mut Self::Pages { ref mut pages, from, len } => {
                cast_slice_mut(&mut pages[from..from + len * size_of::<R>()])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_zero_and_can_be_written_from_a_large_page_on() {
        let whole = LARGE / size_of::<f64>();
        for len in [0, 1, whole - 1, whole, whole + 1, 3 * whole] {
            let mut memory = Memory::<f64>::zeros(len);
            assert!(memory.len() == len && memory.iter().all(|&x| x == 0.0));
            memory.fill(1.0);
            assert!(memory.iter().all(|&x| x == 1.0));
            if let Memory::Pages { pages, from, .. } = &memory {
                assert!(len >= whole && (pages.as_ptr() as usize + from).is_multiple_of(LARGE));
            }
        }
    }
}
