//! Where the time goes: C −= L D Lᵀ on the lower triangle of a front, in registers.
//!
//! A complex product is three real ones ([`Scalar::PRODUCTS`]), so packed copies hold a plane for each. Every
//! entry of C is made by the same operations in the same order, however the strips are shared out to threads.

mod pack;
mod tile;

pub(crate) use pack::{Left, Pivots};
pub(crate) use tile::{WIDE, tile_rows};

use crate::scalar::{Real, Scalar};
use pulp::{Simd, WithSimd};
use std::sync::Mutex;
use tile::{COLS, store, tile};

/// Columns of a strip: whole tiles for every instruction set, and its packed copy stays in the second cache.
pub(crate) const STRIP: usize = 96;

/// Products below which another thread costs more than it brings: some tens of microseconds.
const SHARE_FROM: usize = 2_000_000;

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
    threads: usize,
) {
    let work: usize = strips.iter().map(|strip| strip.width * strip.stride * pivots.count()).sum();
    let run = |strips: &mut dyn Iterator<Item = Strip<'_, T>>| {
        let mut right = Vec::new();
        for strip in strips {
            crate::arch().dispatch(StripDowndate { strip, pivots, left, right: &mut right });
        }
    };
    if threads < 2 || strips.len() < 2 || work < SHARE_FROM {
        return run(&mut strips.into_iter());
    }
    let queue = Mutex::new(strips.into_iter());
    let take = || queue.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next();
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(|| run(&mut std::iter::from_fn(take)));
        }
        run(&mut std::iter::from_fn(take));
    });
}

struct StripDowndate<'a, 'b, T: Scalar> {
    strip: Strip<'b, T>,
    pivots: &'a Pivots<'a, T>,
    left: &'a Left<T::Real>,
    right: &'a mut Vec<T::Real>,
}

impl<T: Scalar> WithSimd for StripDowndate<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { mut strip, pivots, left, right } = self;
        let (count, height) = (pivots.count(), tile_rows::<T::Real, S>());
        let plane = COLS * count;
        pivots.pack_right(strip.first, strip.width, right);
        for panel in strip.first / height..left.panels(height) {
            let row = panel * height;
            let rows = left.panel::<T>(panel, height, count);
            for (j, cols) in right.chunks_exact(T::PRODUCTS * plane).enumerate() {
                let col = strip.first + j * COLS;
                if row + height <= col {
                    break;
                }
                let mut products = [[T::Real::default(); COLS * WIDE]; 3];
                for (p, product) in products.iter_mut().enumerate().take(T::PRODUCTS) {
                    let a = T::Real::vectors::<S>(&rows[p * height * count..][..height * count]).0;
                    store(tile::<T::Real, S, COLS>(simd, a, &cols[p * plane..][..plane]), product);
                }
                for k in 0..COLS.min(strip.first + strip.width - col) {
                    // Only the lower triangle, and only rows that there are.
                    let (from, to) = (row.max(col + k), (row + height).min(left.rows()));
                    if from < to {
                        strip.subtract(col + k, from..to, &products, k * height + from - row);
                    }
                }
            }
        }
    }
}

impl<T: Scalar> Strip<'_, T> {
    /// Subtracts products from some rows of a column.
    #[inline(always)]
    fn subtract(
        &mut self,
        col: usize,
        rows: std::ops::Range<usize>,
        products: &[[T::Real; COLS * WIDE]; 3],
        at: usize,
    ) {
        let len = rows.len();
        let start = (col - self.first) * T::PARTS * self.stride + rows.start - self.first;
        let [p, q, r] = products.each_ref().map(|product| &product[at..at + len]);
        let (re, im) = self.values[start..].split_at_mut(if T::PARTS == 2 { self.stride } else { len });
        let (re, fresh) = (&mut re[..len], self.fresh);
        if T::PARTS == 1 {
            put(re, fresh, |i| p[i]);
        } else {
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
