//! Where Schur complements live between a front and its parent.
//!
//! In the order of the fronts the children of a front are the last that were kept of their depth, so two stacks
//! are enough: one for even depths and one for odd, and a front's complement never overlaps its children's. They grow
//! from their ends down, so that the first numbers of the last one can be given back: they are the first to reach the
//! parent's front.

use crate::memory::Memory;
use crate::scalar::Real;
use std::ops::Range;

/// A stack of numbers; what it hands out is overwritten before it is read.
#[derive(Debug)]
pub(crate) struct Stack<R> {
    values: Memory<R>,
    /// Behind this place all numbers are in use.
    top: usize,
}

/// Where a Schur complement is, or the rest of it.
#[derive(Debug)]
pub(crate) enum Kept<R> {
    /// These numbers of the stack.
    Stacked(Range<usize>),
    /// Removed from it, to be handed to another thread: the numbers from a place on.
    Taken(Memory<R>, usize),
}

impl<R> Default for Stack<R> {
    fn default() -> Self {
        Self { values: Memory::default(), top: 0 }
    }
}

impl<R: Real> Stack<R> {
    /// Empty, with room for so many numbers.
    pub(crate) fn clear(&mut self, len: usize) {
        self.values.some(len);
        self.top = self.values.len();
    }

    /// Some numbers before all others; one that has no room gets as much.
    pub(crate) fn push(&mut self, len: usize) -> Kept<R> {
        if self.values.is_empty() {
            self.clear(len);
        }
        let end = self.top;
        self.top -= len;
        Kept::Stacked(self.top..end)
    }

    /// Gives back the first numbers of what was pushed last.
    pub(crate) fn give_back(&mut self, kept: &mut Kept<R>, len: usize) {
        match kept {
            Kept::Stacked(place) => {
                place.start += len;
                self.top = place.start;
            }
            Kept::Taken(values, from) => {
                *from += len;
                let left = &values[*from..];
                // Where little is left it moves.
                if left.len() < values.len() / 2 {
                    let mut fewer = Memory::zeros(left.len());
                    fewer.copy_from_slice(left);
                    (*values, *from) = (fewer, 0);
                }
            }
        }
    }

    /// Forgets this and all that was pushed after it.
    pub(crate) fn pop(&mut self, kept: &Kept<R>) {
        if let Kept::Stacked(place) = kept {
            self.top = self.top.max(place.end);
        }
    }

    /// Hands the only one that there is on.
    pub(crate) fn take(&mut self, kept: Kept<R>) -> Kept<R> {
        match kept {
            Kept::Stacked(place) => {
                debug_assert_eq!(place.end, self.values.len());
                Kept::Taken(std::mem::take(&mut self.values), place.start)
            }
            taken => taken,
        }
    }

    pub(crate) fn values_of<'a>(&'a self, kept: &'a Kept<R>) -> &'a [R] {
        match kept {
            Kept::Stacked(place) => &self.values[place.clone()],
            Kept::Taken(values, from) => &values[*from..],
        }
    }

    pub(crate) fn values_of_mut<'a>(&'a mut self, kept: &'a mut Kept<R>) -> &'a mut [R] {
        match kept {
            Kept::Stacked(place) => &mut self.values[place.clone()],
            Kept::Taken(values, from) => &mut values[*from..],
        }
    }
}
