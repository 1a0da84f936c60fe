//! Packed copies of L and of L D, tile after tile, a plane for each real product.

use super::TILES_PER_RUN;
use super::tile::{copy, tile_rows};
use crate::memory::Memory;
use crate::packed_lower::PackedLower;
use crate::scalar::{Real, Scalar};
use crate::threads::each;
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;

/// Numbers of a packed copy below which another thread costs more than it brings.
const MIN_SHARED_PACKED_NUMBERS: usize = 50_000;

/// Eliminated columns of a front, and their pivots.
pub(crate) struct Pivots<'a, T: Scalar> {
    /// The columns of the front as far as they are eliminated.
    pub(crate) values: &'a [T::Real],
    pub(crate) packed_lower: PackedLower,
    /// The first of these columns, and the first row that is looked at.
    pub(crate) col: usize,
    pub(crate) row: usize,
    /// Diagonal of D, and its entry below where it begins a block of two.
    pub(crate) d: &'a [[T; 2]],
}

impl<T: Scalar> Pivots<'_, T> {
    pub(crate) fn count(&self) -> usize {
        self.d.len()
    }

    fn rows(&self) -> usize {
        self.packed_lower.rows() - self.row
    }

    /// One part of some rows of a column.
    #[inline(always)]
    fn part(&self, k: usize, part: usize, rows: std::ops::Range<usize>) -> &[T::Real] {
        let start = self.packed_lower.place::<T>(self.row + rows.start, self.col + k, part);
        &self.values[start..start + rows.len()]
    }

    /// The rows `first..first + width` of L D, N at a time, zeros behind the last.
    #[inline(always)]
    pub(super) fn pack_right<const N: usize>(&self, first: usize, width: usize, into: &mut [T::Real]) {
        let count = self.count();
        let mut k = 0;
        while k < count {
            let [d, below] = self.d[k];
            if below == T::default() {
                self.pack_row::<N>(first, width, k, [(k, d), (k, T::default())], into);
                k += 1;
            } else {
                let next = self.d[k + 1][0];
                self.pack_row::<N>(first, width, k, [(k, d), (k + 1, below)], into);
                self.pack_row::<N>(first, width, k + 1, [(k, below), (k + 1, next)], into);
                k += 2;
            }
        }
    }

    /// The k-th row of the packed copy: a sum of one column of L, or two, by their factors.
    #[inline(always)]
    fn pack_row<const N: usize>(
        &self,
        first: usize,
        width: usize,
        k: usize,
        sum: [(usize, T); 2],
        into: &mut [T::Real],
    ) {
        let plane = N * self.count();
        let rows = first..first + width;
        let parts = |(col, _): (usize, T), part: usize| self.part(col, part, rows.clone());
        let (re, im) = (sum.map(|it| parts(it, 0)), sum.map(|it| parts(it, T::PARTS - 1)));
        let used = 1 + usize::from(sum[1].1 != T::default());
        for (panel, into) in into.chunks_exact_mut(plane * T::PRODUCTS).enumerate() {
            let (from, to) = (panel * N, width.min(panel * N + N));
            let mut values = [T::default(); N];
            for term in 0..used {
                let numbers = re[term][from..to].iter().zip(&im[term][from..to]);
                for (value, (&re, &im)) in values.iter_mut().zip(numbers) {
                    *value += T::from_parts([re, im]) * sum[term].1;
                }
            }
            for p in 0..T::PRODUCTS {
                let into = &mut into[p * plane + k * N..][..N];
                into.iter_mut().zip(&values).for_each(|(into, value)| *into = value.factors()[p]);
            }
        }
    }
}

/// L packed by the rows of a tile.
#[derive(Debug)]
pub(crate) struct Left<R> {
    packed: Memory<R>,
    rows: usize,
}

impl<R> Default for Left<R> {
    fn default() -> Self {
        Self { packed: Memory::default(), rows: 0 }
    }
}

impl<R: Real> Left<R> {
    /// Packs all rows of L.
    pub(crate) fn pack<T: Scalar<Real = R>>(&mut self, pivots: &Pivots<'_, T>, threads: usize) {
        let (height, count) = (crate::arch().dispatch(Height(PhantomData::<R>)), pivots.count());
        self.rows = pivots.rows();
        let panel = height * count * T::PRODUCTS;
        let size = self.rows.div_ceil(height) * panel;
        // What is behind the last row is cleared on the way.
        let packed = self.packed.some(size);
        let threads = if size < MIN_SHARED_PACKED_NUMBERS { 1 } else { threads };
        let panels = if threads > 1 { TILES_PER_RUN } else { size.div_ceil(panel.max(1)) };
        let tasks = packed.chunks_mut((panels * panel).max(1)).enumerate();
        let tasks = tasks.map(|(k, packed)| PackLeft { pivots, first: k * panels * height, packed });
        each(threads, tasks.collect(), |task| crate::arch().dispatch(task));
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

/// Rows of a tile on this machine.
struct Height<R>(PhantomData<R>);

impl<R: Real> WithSimd for Height<R> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        tile_rows::<R, S>()
    }
}

/// Packs the rows from one on.
struct PackLeft<'a, T: Scalar> {
    pivots: &'a Pivots<'a, T>,
    first: usize,
    packed: &'a mut [T::Real],
}

impl<T: Scalar> WithSimd for PackLeft<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { pivots, first, packed } = self;
        let (height, count) = (tile_rows::<T::Real, S>(), pivots.count());
        let size = height * count * T::PRODUCTS;
        for (panel, packed) in packed.chunks_exact_mut(size.max(1)).enumerate() {
            let from = first + panel * height;
            let to = (from + height).min(pivots.rows());
            let (first, rest) = packed.split_at_mut(height * count);
            let (second, third) = rest.split_at_mut((height * count).min(rest.len()));
            for k in 0..count {
                let plane = k * height..(k + 1) * height;
                let first = &mut first[plane.clone()];
                copy::<T::Real, S>(pivots.part(k, 0, from..to), first);
                if T::PARTS == 2 {
                    let second = &mut second[plane.clone()];
                    copy::<T::Real, S>(pivots.part(k, 1, from..to), second);
                    let sums = first.iter().zip(second.iter()).map(|(&re, &im)| re + im);
                    third[plane].iter_mut().zip(sums).for_each(|(third, sum)| *third = sum);
                }
            }
        }
    }
}
