//! A front: the dense part of the matrix in which a few columns are eliminated.
//!
//! Numbers are kept in columns of real parts with the column of imaginary parts behind each, so that registers
//! hold numbers of one kind: `stride` apart are the parts, `T::PARTS * stride` the columns.

mod assemble;
mod corner;
mod eliminate;
mod rook;
mod rows;
mod stack;

pub(crate) use assemble::{Child, Contribution, add_children, each_strip, schur_len, schur_strips};
pub(crate) use corner::invert_pair;
pub(crate) use eliminate::{BLOCK, Elimination, eliminate};
pub(crate) use stack::{Kept, Stack};

use crate::kernel::{STRIP, Strip};
use crate::scalar::Scalar;

/// Rows and columns of a front in elimination order; the first columns are candidates for elimination, and
/// only they are here: what the elimination leaves behind is the Schur complement.
pub(crate) struct Front<'a, T: Scalar> {
    /// Positions of the rows, candidates first.
    pub(crate) ids: Vec<u32>,
    /// Columns that may be eliminated here.
    pub(crate) candidates: usize,
    /// The candidates' columns; what is above their diagonal means nothing.
    pub(crate) panel: &'a mut [T::Real],
    /// From one part of a column to the next.
    pub(crate) stride: usize,
}

impl<T: Scalar> Front<'_, T> {
    pub(crate) fn rows(&self) -> usize {
        self.ids.len()
    }

    /// From one column to the next.
    fn step(&self) -> usize {
        T::PARTS * self.stride
    }

    /// Rows `from..` of one part of a column.
    pub(crate) fn part(&self, col: usize, part: usize, from: usize) -> &[T::Real] {
        &self.panel[col * self.step() + part * self.stride..][from..self.ids.len()]
    }

    pub(crate) fn part_mut(&mut self, col: usize, part: usize, from: usize) -> &mut [T::Real] {
        let step = self.step();
        &mut self.panel[col * step + part * self.stride..][from..self.ids.len()]
    }

    fn at(&self, row: usize, col: usize) -> T {
        let at = col * self.step() + row;
        T::from_parts([self.panel[at], self.panel[at + (T::PARTS - 1) * self.stride]])
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
        let (step, rows) = (self.step(), self.rows());
        self.ids.swap(i, j);
        for part in (0..T::PARTS).map(|part| part * self.stride) {
            for col in 0..i {
                self.panel.swap(col * step + part + i, col * step + part + j);
            }
            self.panel.swap(i * step + part + i, j * step + part + j);
            for k in i + 1..j {
                self.panel.swap(i * step + part + k, k * step + part + j);
            }
            let (head, tail) = self.panel.split_at_mut(j * step);
            head[i * step + part + j + 1..][..rows - j - 1]
                .swap_with_slice(&mut tail[part + j + 1..part + rows]);
        }
    }
}

/// Columns `from..to` of a panel as strips for so many threads; rows and columns are counted from `from`.
pub(crate) fn strips<T: Scalar>(
    values: &mut [T::Real],
    stride: usize,
    from: usize,
    to: usize,
    threads: usize,
) -> impl Iterator<Item = Strip<'_, T>> {
    let step = T::PARTS * stride;
    // A few for each thread, so that none waits long for the last.
    let share = (to - from).div_ceil(4 * threads).next_multiple_of(STRIP / 4);
    let most = if threads > 1 { share.clamp(STRIP / 4, STRIP / 2) } else { STRIP };
    values.chunks_mut(most * step).take((to - from).div_ceil(most)).enumerate().map(move |(k, values)| {
        let first = k * most;
        let width = most.min(to - from - first);
        Strip { first, width, stride, fresh: false, values: &mut values[from + first..] }
    })
}
