//! Where the time goes: C −= L D Lᵀ on the lower triangle of a front, in registers.
//!
//! A complex product is three real ones ([`Scalar::PRODUCTS`]), so packed copies hold a plane for each. Every
//! entry of C is made by the same operations in the same order, however the strips are shared out to threads.

mod pack;
mod tile;

pub(crate) use pack::{Left, Pivots};
pub(crate) use tile::{MAX_TILE_ROWS, TILE_OF_16_REGISTERS, TILE_OF_32_REGISTERS, copy, many, tile_rows};

use crate::memory::Memory;
use crate::scalar::{Real, Scalar};
use crate::threads::{Idle, each};
use pulp::{Simd, WithSimd};
use tile::{store, tile};

/// Columns of a strip: whole tiles for every instruction set, and its packed copy stays in the second cache.
pub(crate) const STRIP_COLUMNS: usize = 96;

/// Tiles above each other whose sums are collected: a column of C is then met in runs that are worth fetching.
pub(crate) const TILES_PER_RUN: usize = 4;

/// Products below which another thread costs more than it brings: some tens of microseconds.
const MIN_SHARED_KERNEL_PRODUCTS: usize = 1_000_000;

/// Neighbouring columns of a lower triangle, from the diagonal of the first downwards.
pub(crate) struct Strip<'a, T: Scalar> {
    /// Its first column, and the row at which its values begin.
    pub(crate) first: usize,
    pub(crate) width: usize,
    /// From one part of a column to the next.
    pub(crate) stride: usize,
    /// Whether it has no values yet.
    pub(crate) fresh: bool,
    pub(crate) values: &'a mut [T::Real],
}

/// C −= L D Lᵀ on the strips of C, rows and columns counted from the first row of L.
pub(crate) fn downdate<T: Scalar>(
    strips: Vec<Strip<'_, T>>,
    pivots: &Pivots<'_, T>,
    left: &Left<T::Real>,
    idle: &Idle<Buffers<T::Real>>,
    threads: usize,
) {
    let work: usize = strips.iter().map(|strip| strip.width * strip.stride * pivots.count()).sum();
    let threads = if work < MIN_SHARED_KERNEL_PRODUCTS { 1 } else { threads };
    each(threads, strips, |strip| {
        let run = |buffers: &mut _| crate::arch().dispatch(StripDowndate { strip, pivots, left, buffers });
        idle.lend(Buffers::default, run);
    });
}

/// What one thread needs for a strip.
pub(crate) struct Buffers<R> {
    /// L D of a strip's columns, packed.
    right: Memory<R>,
    /// Sums of the real products, column after column, a plane for each.
    products: Memory<R>,
}

impl<R> Default for Buffers<R> {
    fn default() -> Self {
        Self { right: Memory::default(), products: Memory::default() }
    }
}

struct StripDowndate<'a, 'b, T: Scalar> {
    strip: Strip<'b, T>,
    pivots: &'a Pivots<'a, T>,
    left: &'a Left<T::Real>,
    buffers: &'a mut Buffers<T::Real>,
}

impl<T: Scalar> WithSimd for StripDowndate<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Constant, so that only one of them is compiled.
        if const { many::<S>() } {
            self.by_tiles::<S, { TILE_OF_32_REGISTERS.0 }, { TILE_OF_32_REGISTERS.1 }>(simd);
        } else {
            self.by_tiles::<S, { TILE_OF_16_REGISTERS.0 }, { TILE_OF_16_REGISTERS.1 }>(simd);
        }
    }
}

impl<T: Scalar> StripDowndate<'_, '_, T> {
    /// Tiles of M registers of rows and N columns.
    #[inline(always)]
    fn by_tiles<S: Simd, const M: usize, const N: usize>(self, simd: S) {
        let Self { mut strip, pivots, left, buffers: Buffers { right, products } } = self;
        let (count, height) = (pivots.count(), tile_rows::<T::Real, S>());
        let plane = N * count;
        let right = right.some(strip.width.next_multiple_of(N) * T::PRODUCTS * count);
        pivots.pack_right::<N>(strip.first, strip.width, right);
        // From one column of the products to the next, and from one plane to the next.
        let (step, size) = (TILES_PER_RUN * height, strip.width.next_multiple_of(N) * TILES_PER_RUN * height);
        let products = products.some(size * T::PRODUCTS);
        let panels = left.panels(height);
        for first in (strip.first / height..panels).step_by(TILES_PER_RUN) {
            for panel in first..panels.min(first + TILES_PER_RUN) {
                let rows = left.panel::<T>(panel, height, count);
                // Columns that reach down to these rows.
                let width = strip.width.min((panel + 1) * height - strip.first);
                let at = (panel - first) * height;
                // A plane of rows stays in the first cache while all columns pass.
                for (p, products) in products.chunks_exact_mut(size).enumerate() {
                    let a = T::Real::vectors::<S>(&rows[p * height * count..][..height * count]).0;
                    let columns = right.chunks_exact(T::PRODUCTS * plane).take(width.div_ceil(N));
                    for (b, product) in columns.zip(products.chunks_exact_mut(N * step)) {
                        let sums = tile::<T::Real, S, M, N>(simd, a, &b[p * plane..][..plane]);
                        store::<T::Real, S, M, N>(sums, &mut product[at..], step);
                    }
                }
            }
            let (from, to) = (first * height, left.rows().min((first + TILES_PER_RUN) * height));
            for j in 0..strip.width.min(to - strip.first) {
                let top = from.max(strip.first + j);
                strip.subtract(strip.first + j, top..to, products, size, j * step + top - from);
            }
        }
    }
}

impl<T: Scalar> Strip<'_, T> {
    /// Subtracts products, `step` from one plane to the next, from some rows of a column.
    #[inline(always)]
    fn subtract(
        &mut self,
        col: usize,
        rows: std::ops::Range<usize>,
        products: &[T::Real],
        step: usize,
        at: usize,
    ) {
        let len = rows.len();
        let start = (col - self.first) * T::PARTS * self.stride + rows.start - self.first;
        let product = |p: usize| &products[p * step + at..][..len];
        let (re, im) = self.values[start..].split_at_mut(if T::PARTS == 2 { self.stride } else { len });
        let (re, fresh) = (&mut re[..len], self.fresh);
        if T::PARTS == 1 {
            let p = product(0);
            put(re, fresh, |i| p[i]);
        } else {
            let (p, q, r) = (product(0), product(1), product(2));
            put(re, fresh, |i| p[i] - q[i]);
            put(&mut im[..len], fresh, |i| r[i] - p[i] - q[i]);
        }
    }
}

#[inline(always)]
fn put<R: Real>(values: &mut [R], fresh: bool, product: impl Fn(usize) -> R) {
    if fresh {
        values.iter_mut().enumerate().for_each(|(i, value)| *value = -product(i));
    } else {
        values.iter_mut().enumerate().for_each(|(i, value)| *value -= product(i));
    }
}
