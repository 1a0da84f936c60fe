//! Where the columns of a lower triangle are: in strips, each from the diagonal of its first column downwards.
//!
//! Fronts, factors and what fronts leave are kept like this. What is above the diagonals of a strip is there too, and
//! means nothing: some per cent of a large front, where whole columns would be twice what is needed.

use crate::kernel::{STRIP_COLUMNS, Strip};
use crate::scalar::Scalar;
use std::ops::Range;

/// The first columns of a lower triangle, or all. Of each column there are the parts one after the other, and the next
/// column behind them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PackedLower {
    rows: usize,
    /// From one part of a column of the first strip to the next.
    stride: usize,
}

/// The first row that is kept of a column.
#[inline(always)]
pub(crate) fn top(col: usize) -> usize {
    col / STRIP_COLUMNS * STRIP_COLUMNS
}

impl PackedLower {
    #[inline(always)]
    pub(crate) fn new(rows: usize) -> Self {
        // The columns of a tile shall not fall onto the same lines of a cache: strips are whole multiples of 32, so that
        // what holds for the first stride holds for all.
        let stride = if rows > 64 && rows.is_multiple_of(32) { rows + 4 } else { rows };
        Self { rows, stride }
    }

    pub(crate) fn rows(self) -> usize {
        self.rows
    }

    /// From one part of a column to the next.
    #[inline(always)]
    pub(crate) fn stride(self, col: usize) -> usize {
        self.stride - top(col)
    }

    /// Where a column begins, and how many numbers are before it.
    #[inline(always)]
    pub(crate) fn start<T: Scalar>(self, col: usize) -> usize {
        let strips = col / STRIP_COLUMNS;
        let before = strips * self.stride - STRIP_COLUMNS * (strips * strips.saturating_sub(1) / 2);
        T::PARTS * (STRIP_COLUMNS * before + (col - strips * STRIP_COLUMNS) * self.stride(col))
    }

    /// Where an entry on the diagonal or below it is.
    #[inline(always)]
    pub(crate) fn place<T: Scalar>(self, row: usize, col: usize, part: usize) -> usize {
        self.start::<T>(col) + part * self.stride(col) + row - top(col)
    }

    /// Where the rows of one part of a column are, from one on.
    #[inline(always)]
    pub(crate) fn part<T: Scalar>(self, col: usize, part: usize, from: usize) -> Range<usize> {
        let start = self.place::<T>(from, col, part);
        start..start + self.rows - from
    }

    /// The parts of some columns, each from a row on; the values begin with those of the first.
    pub(crate) fn parts_mut<T: Scalar>(
        self,
        values: &mut [T::Real],
        cols: Range<usize>,
        from: usize,
    ) -> impl Iterator<Item = &mut [T::Real]> {
        let mut rest = values;
        cols.flat_map(|col| [col; 2].into_iter().take(T::PARTS)).map(move |col| {
            let (column, behind) = std::mem::take(&mut rest).split_at_mut(self.stride(col));
            rest = behind;
            &mut column[from - top(col)..self.rows - top(col)]
        })
    }

    /// Some columns as strips of so many at most; rows and columns are counted from the first, with which the values
    /// begin.
    pub(crate) fn strips<T: Scalar>(
        self,
        values: &mut [T::Real],
        cols: Range<usize>,
        most: usize,
        fresh: bool,
    ) -> impl Iterator<Item = Strip<'_, T>> {
        let (mut rest, mut at) = (values, cols.start);
        std::iter::from_fn(move || {
            let width = most.min(top(at) + STRIP_COLUMNS - at).min(cols.end - at);
            let (first, stride) = (at - cols.start, self.stride(at));
            let (values, behind) = std::mem::take(&mut rest).split_at_mut(T::PARTS * width * stride);
            let values = values.get_mut(at - top(at)..).filter(|_| width > 0)?;
            (rest, at) = (behind, at + width);
            Some(Strip { first, width, stride, fresh, values })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::c64;

    /// A number for each entry and part.
    fn number(row: usize, col: usize, part: usize) -> f64 {
        (1000 * row + col) as f64 + 0.25 * (1 + part) as f64
    }

    /// Columns whose entries on the diagonal and below it have their numbers.
    fn filled(packed_lower: PackedLower, cols: usize) -> Vec<f64> {
        let mut values = vec![0.0; packed_lower.start::<c64>(cols)];
        for (col, part) in (0..cols).flat_map(|col| [(col, 0), (col, 1)]) {
            for (row, value) in (col..).zip(&mut values[packed_lower.part::<c64>(col, part, col)]) {
                assert_eq!(std::mem::replace(value, number(row, col, part)), 0.0, "no place of its own");
            }
        }
        values
    }

    #[test]
    fn places_parts_and_strips_show_the_same_entries() {
        for rows in [
            1,
            2,
            STRIP_COLUMNS - 1,
            STRIP_COLUMNS,
            STRIP_COLUMNS + 1,
            3 * STRIP_COLUMNS,
            3 * STRIP_COLUMNS + 50,
        ] {
            for cols in [1, rows.div_ceil(2), rows] {
                let packed_lower = PackedLower::new(rows);
                let (mut values, from) = (filled(packed_lower, cols), cols / 3);
                let start = packed_lower.start::<c64>(from);
                let at = packed_lower.place::<c64>(rows - 1, cols - 1, 1);
                assert_eq!(values[at], number(rows - 1, cols - 1, 1));
                let mut width = 0;
                for strip in packed_lower.strips::<c64>(&mut values[start..], from..cols, 40, false) {
                    let (first, last) = (from + strip.first, from + strip.first + strip.width - 1);
                    assert_eq!(strip.values[0], number(first, first, 0));
                    let at = (2 * strip.width - 1) * strip.stride + rows - 1 - first;
                    assert_eq!(strip.values[at], number(rows - 1, last, 1));
                    width += strip.width;
                }
                assert_eq!(width, cols - from);
                let to = cols.min(top(from) + STRIP_COLUMNS);
                for (k, part) in
                    packed_lower.parts_mut::<c64>(&mut values[start..], from..to, to - 1).enumerate()
                {
                    assert_eq!(part[0], number(to - 1, from + k / 2, k % 2));
                    assert_eq!(part.last(), Some(&number(rows - 1, from + k / 2, k % 2)));
                }
            }
        }
    }
}
