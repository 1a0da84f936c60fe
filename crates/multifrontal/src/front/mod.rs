//! A front: the dense part of the matrix in which a few columns are eliminated.
//!
//! Numbers are kept in columns of real parts with the column of imaginary parts behind each, so that registers
//! hold numbers of one kind.

mod assemble;
mod diagonal_block;
mod eliminate;
mod panel_trsm;
mod rook;
mod stack;

pub(crate) use assemble::{Child, Contribution, add_children, each_strip};
pub(crate) use diagonal_block::invert_pair;
pub(crate) use eliminate::{Elimination, PANEL_COLUMNS, eliminate};
pub(crate) use stack::{Kept, Stack};

use crate::kernel::STRIP_COLUMNS;
use crate::packed_lower::PackedLower;
use crate::scalar::Scalar;

/// Rows and columns of a front in elimination order; the first columns are candidates for elimination, and
/// only they are here: what the elimination leaves behind is the Schur complement.
pub(crate) struct Front<'a, T: Scalar> {
    /// Positions of the rows, candidates first.
    pub(crate) ids: Vec<u32>,
    /// Columns that may be eliminated here.
    pub(crate) candidates: usize,
    /// The candidates' columns.
    pub(crate) panel: &'a mut [T::Real],
    pub(crate) packed_lower: PackedLower,
}

impl<T: Scalar> Front<'_, T> {
    pub(crate) fn rows(&self) -> usize {
        self.ids.len()
    }

    /// Rows `from..` of one part of a column.
    pub(crate) fn part(&self, col: usize, part: usize, from: usize) -> &[T::Real] {
        &self.panel[self.packed_lower.part::<T>(col, part, from)]
    }

    pub(crate) fn part_mut(&mut self, col: usize, part: usize, from: usize) -> &mut [T::Real] {
        &mut self.panel[self.packed_lower.part::<T>(col, part, from)]
    }

    fn at(&self, row: usize, col: usize) -> T {
        let at = |part: usize| self.panel[self.packed_lower.place::<T>(row, col, part)];
        T::from_parts([at(0), at(T::PARTS - 1)])
    }

    /// Brings a pivot, of one column or of two in ascending order, to a place before it; its columns.
    fn bring(&mut self, at: usize, (first, second): (usize, Option<usize>)) -> usize {
        self.exchange(at, first);
        let Some(second) = second else { return 1 };
        self.exchange(at + 1, second);
        2
    }

    /// Exchanges two candidates i ≤ j, rows and columns.
    fn exchange(&mut self, i: usize, j: usize) {
        if i == j {
            return;
        }
        self.ids.swap(i, j);
        let (packed_lower, start) = (self.packed_lower, self.packed_lower.start::<T>(j));
        for part in 0..T::PARTS {
            let place = |row: usize, col: usize| packed_lower.place::<T>(row, col, part);
            for col in 0..i {
                self.panel.swap(place(i, col), place(j, col));
            }
            self.panel.swap(place(i, i), place(j, j));
            for k in i + 1..j {
                self.panel.swap(place(k, i), place(j, k));
            }
            let (head, tail) = self.panel.split_at_mut(start);
            let below = packed_lower.part::<T>(j, part, j + 1);
            head[packed_lower.part::<T>(i, part, j + 1)]
                .swap_with_slice(&mut tail[below.start - start..below.end - start]);
        }
    }
}

/// The most columns of a panel in one strip, a few strips for each thread so that none waits long for the last.
pub(crate) fn strip_width(columns: usize, threads: usize) -> usize {
    let share = columns.div_ceil(4 * threads).next_multiple_of(STRIP_COLUMNS / 4);
    if threads > 1 { share.clamp(STRIP_COLUMNS / 4, STRIP_COLUMNS / 2) } else { STRIP_COLUMNS }
}
