//! Packed copies of L and of L D, tile after tile, a plane for each real product.

use super::tile::{COLS, copy, tile_rows};
use crate::scalar::{Real, Scalar};
use pulp::{Simd, WithSimd};

/// Eliminated columns of a front, and their pivots.
pub(crate) struct Pivots<'a, T: Scalar> {
    /// The columns' parts, from the first row that is looked at.
    pub(crate) columns: &'a [T::Real],
    /// From one part of a column to the next.
    pub(crate) stride: usize,
    /// The rows that are looked at: these many from the beginning of each column.
    pub(crate) rows: usize,
    /// Diagonal of D, and its entry below where it begins a block of two.
    pub(crate) d: &'a [[T; 2]],
}

impl<T: Scalar> Pivots<'_, T> {
    pub(crate) fn count(&self) -> usize {
        self.d.len()
    }

    /// One part of some rows of a column.
    #[inline(always)]
    fn part(&self, k: usize, part: usize, rows: std::ops::Range<usize>) -> &[T::Real] {
        &self.columns[(k * T::PARTS + part) * self.stride..][rows]
    }

    #[inline(always)]
    fn at(&self, k: usize, row: usize) -> T {
        let at = k * T::PARTS * self.stride + row;
        T::from_parts([self.columns[at], self.columns[at + (T::PARTS - 1) * self.stride]])
    }

    /// The rows `first..first + width` of L D, [`COLS`] at a time, zeros behind the last.
    #[inline(always)]
    pub(super) fn pack_right(&self, first: usize, width: usize, into: &mut Vec<T::Real>) {
        let count = self.count();
        let plane = COLS * count;
        // Nothing is cleared that is written anyway.
        into.resize(width.div_ceil(COLS) * plane * T::PRODUCTS, T::Real::default());
        for (panel, into) in into.chunks_exact_mut((plane * T::PRODUCTS).max(1)).enumerate() {
            let row = first + panel * COLS;
            let rows = COLS.min(first + width - row);
            let mut put = |k: usize, value: &dyn Fn(usize) -> T| {
                for i in 0..COLS {
                    let factors = if i < rows { value(row + i) } else { T::default() }.factors();
                    for p in 0..T::PRODUCTS {
                        into[p * plane + k * COLS + i] = factors[p];
                    }
                }
            };
            let mut k = 0;
            while k < count {
                let [d, below] = self.d[k];
                if below == T::default() {
                    put(k, &|i| self.at(k, i) * d);
                    k += 1;
                } else {
                    let next = self.d[k + 1][0];
                    put(k, &|i| self.at(k, i) * d + self.at(k + 1, i) * below);
                    put(k + 1, &|i| self.at(k, i) * below + self.at(k + 1, i) * next);
                    k += 2;
                }
            }
        }
    }
}

/// L packed by the rows of a tile.
#[derive(Debug, Default)]
pub(crate) struct Left<R> {
    packed: Vec<R>,
    rows: usize,
}

impl<R: Real> Left<R> {
    /// Packs all rows of L.
    pub(crate) fn pack<T: Scalar<Real = R>>(&mut self, pivots: &Pivots<'_, T>) {
        crate::arch().dispatch(PackLeft { pivots, into: self });
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    pub(super) fn panels(&self, height: usize) -> usize {
        self.rows.div_ceil(height)
    }

    #[inline(always)]
    pub(super) fn panel<T: Scalar<Real = R>>(&self, panel: usize, height: usize, count: usize) -> &[R] {
        let size = height * count * T::PRODUCTS;
        &self.packed[panel * size..][..size]
    }
}

struct PackLeft<'a, T: Scalar> {
    pivots: &'a Pivots<'a, T>,
    into: &'a mut Left<T::Real>,
}

impl<T: Scalar> WithSimd for PackLeft<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (height, count) = (tile_rows::<T::Real, S>(), self.pivots.count());
        let Left { packed, rows } = self.into;
        *rows = self.pivots.rows;
        let size = height * count * T::PRODUCTS;
        let panels = rows.div_ceil(height);
        // Nothing is cleared that is written anyway; what is behind the last row is.
        if packed.len() < panels * size {
            packed.resize(panels * size, T::Real::default());
        }
        for (panel, packed) in packed.chunks_exact_mut(size.max(1)).enumerate().take(panels) {
            let from = panel * height;
            let to = (from + height).min(*rows);
            let (first, rest) = packed.split_at_mut(height * count);
            let (second, third) = rest.split_at_mut((height * count).min(rest.len()));
            for k in 0..count {
                let plane = k * height..(k + 1) * height;
                let first = &mut first[plane.clone()];
                copy::<T::Real, S>(self.pivots.part(k, 0, from..to), first);
                if T::PARTS == 2 {
                    let second = &mut second[plane.clone()];
                    copy::<T::Real, S>(self.pivots.part(k, 1, from..to), second);
                    let sums = first.iter().zip(second.iter()).map(|(&re, &im)| re + im);
                    third[plane].iter_mut().zip(sums).for_each(|(third, sum)| *third = sum);
                }
            }
        }
    }
}
