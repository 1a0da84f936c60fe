//! Room for many numbers, in large pages where the system has them, from the beginning of a line on.
//!
//! A factor is read from end to end with each solution: with pages of 4 kB a tenth of the time goes into finding them,
//! and when it is written for the first time each page is a call of the system.

use crate::scalar::Real;
use memmap2::MmapMut;
use pulp::bytemuck::{cast_slice, cast_slice_mut};
use std::ops::{Deref, DerefMut};

/// Bytes of a large page.
const LARGE_PAGE_BYTES: usize = 2 << 20;

/// Bytes that a processor fetches together, and of its widest registers: from its beginning on a register is in one.
pub(crate) const CACHE_LINE_BYTES: usize = 64;

/// Numbers that are zero at first.
#[derive(Debug)]
pub(crate) enum Memory<R> {
    /// Of the allocator: so many from one on.
    Small { values: Vec<R>, from: usize, len: usize },
    /// Whole pages of the system: so many numbers from a byte on.
    Pages { pages: MmapMut, from: usize, len: usize },
}

impl<R: Real> Memory<R> {
    pub(crate) fn zeros(len: usize) -> Self {
        Self::pages(len).unwrap_or_else(|| {
            let spare = CACHE_LINE_BYTES / size_of::<R>();
            let values = vec![R::default(); len + spare];
            let from = values.as_ptr().align_offset(CACHE_LINE_BYTES).min(spare);
            Self::Small { values, from, len }
        })
    }

    /// From a large page on, and to the end of one; `None` where that is not worth it, or not to be had.
    fn pages(len: usize) -> Option<Self> {
        let bytes = len.checked_mul(size_of::<R>()).filter(|&bytes| bytes >= LARGE_PAGE_BYTES)?;
        let pages = MmapMut::map_anon(
            bytes.checked_next_multiple_of(LARGE_PAGE_BYTES)?.checked_add(LARGE_PAGE_BYTES)?,
        )
        .ok()?;
        // A system without large pages has small ones.
        #[cfg(target_os = "linux")]
        let _ = pages.advise(memmap2::Advice::HugePage);
        let from = pages.as_ptr().align_offset(LARGE_PAGE_BYTES);
        (from <= LARGE_PAGE_BYTES).then_some(Self::Pages { pages, from, len })
    }

    /// So many numbers, whatever they are.
    pub(crate) fn some(&mut self, len: usize) -> &mut [R] {
        if self.len() < len {
            // Not both at the same time.
            *self = Self::default();
            *self = Self::zeros(len);
        }
        &mut self[..len]
    }
}

impl<R> Default for Memory<R> {
    fn default() -> Self {
        Self::Small { values: Vec::new(), from: 0, len: 0 }
    }
}

impl<R: Real> Deref for Memory<R> {
    type Target = [R];

    fn deref(&self) -> &[R] {
        match *self {
            Self::Small { ref values, from, len } => &values[from..from + len],
            Self::Pages { ref pages, from, len } => cast_slice(&pages[from..from + len * size_of::<R>()]),
        }
    }
}

impl<R: Real> DerefMut for Memory<R> {
    fn deref_mut(&mut self) -> &mut [R] {
        match *self {
            Self::Small { ref mut values, from, len } => &mut values[from..from + len],
            Self::Pages { ref mut pages, from, len } => {
                cast_slice_mut(&mut pages[from..from + len * size_of::<R>()])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_for_some_begins_at_a_line_and_grows() {
        let mut memory = Memory::<f32>::default();
        for len in [0, 1, 100, 50, 1000, LARGE_PAGE_BYTES] {
            let some = memory.some(len);
            some.fill(1.0);
            assert!(
                some.len() == len && (len == 0 || (some.as_ptr() as usize).is_multiple_of(CACHE_LINE_BYTES))
            );
        }
    }

    #[test]
    fn all_is_zero_and_can_be_written_from_a_large_page_on() {
        let whole = LARGE_PAGE_BYTES / size_of::<f64>();
        for len in [0, 1, whole - 1, whole, whole + 1, 3 * whole] {
            let mut memory = Memory::<f64>::zeros(len);
            assert!(memory.len() == len && memory.iter().all(|&x| x == 0.0));
            memory.fill(1.0);
            assert!(memory.iter().all(|&x| x == 1.0));
            if let Memory::Pages { pages, from, .. } = &memory {
                assert!(len >= whole && (pages.as_ptr() as usize + from).is_multiple_of(LARGE_PAGE_BYTES));
            }
        }
    }
}
