//! Where Schur complements live between a front and its parent.
//!
//! In the order of the fronts the children of a front are the last that were kept of their depth, so two stacks
//! are enough: one for even depths and one for odd, and a front's complement never overlaps its children's.

use crate::memory::Memory;
use crate::scalar::Real;

/// A stack of numbers; what it hands out is overwritten before it is read.
#[derive(Debug)]
pub(crate) struct Stack<R> {
    values: Memory<R>,
    top: usize,
}

/// Where a Schur complement is.
#[derive(Debug)]
pub(crate) enum Kept<R> {
    /// So many numbers of the stack from a place on.
    Stacked(usize, usize),
    /// Taken out of it, to be handed to another thread.
    Taken(Memory<R>),
}

impl<R> Default for Stack<R> {
    fn default() -> Self {
        Self { values: Memory::default(), top: 0 }
    }
}

impl<R: Real> Stack<R> {
    /// Empty, with room for so many numbers; more is found when it is needed.
    pub(crate) fn clear(&mut self, len: usize) {
        self.top = 0;
        if self.values.len() < len {
            // Not both at the same time.
            self.values = Memory::default();
            self.values = Memory::zeros(len);
        }
    }

    pub(crate) fn push(&mut self, len: usize) -> Kept<R> {
        let from = self.top;
        self.top += len;
        if self.values.is_empty() {
            // Zeros of the system are free until they are touched.
            self.values = Memory::zeros(len);
        } else if self.top > self.values.len() {
            let mut more = Memory::zeros(self.top);
            more[..from].copy_from_slice(&self.values[..from]);
            self.values = more;
        }
        Kept::Stacked(from, len)
    }

    /// Forgets this and all that was pushed after it.
    pub(crate) fn pop(&mut self, kept: &Kept<R>) {
        if let &Kept::Stacked(from, _) = kept {
            self.top = self.top.min(from);
        }
    }

    /// Hands the only one that there is on.
    pub(crate) fn take(&mut self, kept: Kept<R>) -> Kept<R> {
        self.pop(&kept);
        debug_assert!(matches!(kept, Kept::Stacked(0, len) if len == self.values.len()));
        Kept::Taken(std::mem::take(&mut self.values))
    }

    pub(crate) fn values_of<'a>(&'a self, kept: &'a Kept<R>) -> &'a [R] {
        match kept {
            &Kept::Stacked(from, len) => &self.values[from..from + len],
            Kept::Taken(values) => values,
        }
    }

    pub(crate) fn values_of_mut<'a>(&'a mut self, kept: &'a mut Kept<R>) -> &'a mut [R] {
        match kept {
            &mut Kept::Stacked(from, len) => &mut self.values[from..from + len],
            Kept::Taken(values) => values,
        }
    }
}
