//! One right-hand side: registers hold rows, at the speed at which L comes from memory.

use super::{COLUMNS_PER_PASS, Columns, Step, pieces, shares};
use crate::memory::{CACHE_LINE_BYTES, Memory};
use crate::scalar::{Real, Scalar, add_product};
use crate::threads::each;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// y = L⁻¹ b.
pub(super) struct Forward<'a, T: Scalar>(pub(super) Step<'a, T>);

impl<T: Scalar> WithSimd for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { node, local, buffer, threads, shared } = self.0;
        let (pivots, rows) = (node.pivots(), node.order());
        let (re, im) = planes(buffer, rows);
        for k in 0..pivots {
            let [x, y] = get::<T>(local, node.first + k).parts();
            (re[k], im[k]) = (x, y);
        }
        for span in node.spans() {
            let inner = node.inner(&span, shared);
            for cols in pieces(span.clone(), COLUMNS_PER_PASS) {
                packed_lower(node, &cols, re, im);
                let (x, below) = (factors(&cols, re, im), cols.end..inner);
                multiply(simd, node, cols, &x, below.clone(), (&mut re[below.clone()], &mut im[below]));
            }
            let (own_re, re) = re.split_at_mut(inner);
            let (own_im, im) = im.split_at_mut(inner);
            let (len, shares) = shares(inner..rows, threads, usize::MAX);
            let chunks = re.chunks_mut(len).zip(im.chunks_mut(len));
            let own = (&*own_re, &*own_im);
            let tasks = shares.zip(chunks);
            let tasks = tasks.map(|(rows, y)| Multiply { node, span: span.clone(), own, rows, y });
            each(threads, tasks.collect(), |task| crate::arch().dispatch(task));
        }
        for k in 0..pivots {
            put::<T>(local, node.first + k, [re[k], im[k]]);
        }
        for (k, &row) in (pivots..).zip(&node.rows) {
            let sum = get::<T>(local, row as usize) + T::from_parts([re[k], im[k]]);
            put::<T>(local, row as usize, sum.parts());
        }
    }
}

/// x = L⁻ᵀ D⁻¹ y.
pub(super) struct Backward<'a, T: Scalar>(pub(super) Step<'a, T>);

impl<T: Scalar> WithSimd for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { node, local, buffer, threads, shared } = self.0;
        let (pivots, rows) = (node.pivots(), node.order());
        let (re, im) = planes(buffer, rows);
        let places = (node.first..node.first + pivots).chain(node.rows.iter().map(|&row| row as usize));
        for (k, place) in places.enumerate() {
            let [x, y] = get::<T>(local, place).parts();
            (re[k], im[k]) = (x, y);
        }
        times_inverse(&node.inverse, re, im);
        let mut sums = [[T::default(); COLUMNS_PER_PASS]; super::PIVOTS_PER_MEETING / COLUMNS_PER_PASS];
        for span in node.spans().rev() {
            let inner = node.inner(&span, shared);
            let below = inner..rows;
            sums.fill([T::default(); COLUMNS_PER_PASS]);
            if !below.is_empty() {
                let x = (&re[below.clone()], &im[below.clone()]);
                let tasks = pieces(span.clone(), COLUMNS_PER_PASS).zip(&mut sums);
                let tasks = tasks.map(|(cols, sums)| Dot { node, cols, rows: below.clone(), x, sums });
                each(threads, tasks.collect(), |task| crate::arch().dispatch(task));
            }
            for (cols, sums) in pieces(span.clone(), COLUMNS_PER_PASS).zip(&mut sums).rev() {
                let inside = cols.end..inner;
                dot(simd, node, cols.clone(), inside.clone(), (&re[inside.clone()], &im[inside]), sums);
                transposed_triangle(node, &cols, sums, re, im);
            }
        }
        for k in 0..pivots {
            put::<T>(local, node.first + k, [re[k], im[k]]);
        }
    }
}

/// Subtracts L · own of a span from some rows.
struct Multiply<'a, T: Scalar> {
    node: Columns<'a, T>,
    span: Range<usize>,
    own: (&'a [T::Real], &'a [T::Real]),
    rows: Range<usize>,
    y: (&'a mut [T::Real], &'a mut [T::Real]),
}

impl<T: Scalar> WithSimd for Multiply<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { node, span, own, rows, y } = self;
        for cols in pieces(span, COLUMNS_PER_PASS) {
            let x = factors(&cols, own.0, own.1);
            multiply(simd, node, cols, &x, rows.clone(), (&mut *y.0, &mut *y.1));
        }
    }
}

/// Lᵀ x of some rows, for a block of columns.
struct Dot<'a, T: Scalar> {
    node: Columns<'a, T>,
    cols: Range<usize>,
    rows: Range<usize>,
    x: (&'a [T::Real], &'a [T::Real]),
    sums: &'a mut [T; COLUMNS_PER_PASS],
}

impl<T: Scalar> WithSimd for Dot<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { node, cols, rows, x, sums } = self;
        dot(simd, node, cols, rows, x, sums);
    }
}

/// Zeros for the real and the imaginary parts of some rows.
fn planes<R: Real>(buffer: &mut Memory<R>, rows: usize) -> (&mut [R], &mut [R]) {
    let plane = rows.next_multiple_of(CACHE_LINE_BYTES / size_of::<R>());
    let planes = buffer.some(2 * plane);
    planes.fill(R::default());
    let (re, im) = planes.split_at_mut(plane);
    (&mut re[..rows], &mut im[..rows])
}

#[inline(always)]
fn get<T: Scalar>(local: &[T::Real], row: usize) -> T {
    T::from_parts([local[row * T::PARTS], local[row * T::PARTS + T::PARTS - 1]])
}

#[inline(always)]
fn put<T: Scalar>(local: &mut [T::Real], row: usize, parts: [T::Real; 2]) {
    local[row * T::PARTS..][..T::PARTS].copy_from_slice(&parts[..T::PARTS]);
}

/// Solves with the triangle of a block of columns.
#[inline(always)]
fn packed_lower<T: Scalar>(
    node: Columns<'_, T>,
    cols: &Range<usize>,
    re: &mut [T::Real],
    im: &mut [T::Real],
) {
    let l = node.in_strip(cols.start);
    for j in cols.clone() {
        let x = T::from_parts([re[j], im[j]]);
        for i in j + 1..cols.end {
            let [p, q] = (l.at(i, j) * x).parts();
            re[i] -= p;
            im[i] -= q;
        }
    }
}

/// Takes the sums from a block of unknowns and solves with the transpose of its packed_lower.
#[inline(always)]
fn transposed_triangle<T: Scalar>(
    node: Columns<'_, T>,
    cols: &Range<usize>,
    sums: &[T; COLUMNS_PER_PASS],
    re: &mut [T::Real],
    im: &mut [T::Real],
) {
    let l = node.in_strip(cols.start);
    for j in cols.clone().rev() {
        let mut x = T::from_parts([re[j], im[j]]) - sums[j - cols.start];
        for i in j + 1..cols.end {
            x -= l.at(i, j) * T::from_parts([re[i], im[i]]);
        }
        let [p, q] = x.parts();
        (re[j], im[j]) = (p, q);
    }
}

/// What the rows below a block are to be multiplied with, its sign changed.
#[inline(always)]
fn factors<R: Real>(cols: &Range<usize>, re: &[R], im: &[R]) -> [[R; 2]; COLUMNS_PER_PASS] {
    let mut factors = [[R::default(); 2]; COLUMNS_PER_PASS];
    factors.iter_mut().zip(cols.clone()).for_each(|(x, k)| *x = [-re[k], -im[k]]);
    factors
}

/// Adds L · factors to some rows.
#[inline(always)]
fn multiply<T: Scalar, S: Simd>(
    simd: S,
    node: Columns<'_, T>,
    cols: Range<usize>,
    factors: &[[T::Real; 2]; COLUMNS_PER_PASS],
    rows: Range<usize>,
    (re, im): (&mut [T::Real], &mut [T::Real]),
) {
    let none: &[T::Real] = &[];
    let (l, mut columns) = (node.in_strip(cols.start), [[none; 2]; COLUMNS_PER_PASS]);
    for (column, col) in columns.iter_mut().zip(cols.clone()) {
        *column = [0, T::PARTS - 1].map(|part| l.part(col, part, rows.clone()));
    }
    let columns = &columns[..cols.len()];
    let (re, re_end) = T::Real::vectors_mut::<S>(re);
    let (im, im_end) = T::Real::vectors_mut::<S>(im);
    for at in 0..re.len() {
        let mut sum = [re[at], if T::PARTS == 2 { im[at] } else { re[at] }];
        for (column, &x) in columns.iter().zip(factors) {
            let l = [T::Real::vectors::<S>(column[0]).0[at], T::Real::vectors::<S>(column[1]).0[at]];
            sum = add_product::<T, S>(simd, l, x, sum);
        }
        re[at] = sum[0];
        if T::PARTS == 2 {
            im[at] = sum[1];
        }
    }
    if !re_end.is_empty() {
        let mut sum = [T::Real::load_part(simd, re_end), T::Real::load_part(simd, im_end)];
        for (column, &x) in columns.iter().zip(factors) {
            let [l, m] = [T::Real::vectors::<S>(column[0]).1, T::Real::vectors::<S>(column[1]).1];
            let l = [T::Real::load_part(simd, l), T::Real::load_part(simd, m)];
            sum = add_product::<T, S>(simd, l, x, sum);
        }
        T::Real::store_part(simd, re_end, sum[0]);
        T::Real::store_part(simd, im_end, sum[1]);
    }
}

/// Adds Lᵀ x over some rows to the sums of a block's columns, four columns at a time.
#[inline(always)]
fn dot<T: Scalar, S: Simd>(
    simd: S,
    node: Columns<'_, T>,
    cols: Range<usize>,
    rows: Range<usize>,
    (re, im): (&[T::Real], &[T::Real]),
    sums: &mut [T; COLUMNS_PER_PASS],
) {
    const COLUMNS_PER_SUM: usize = 4;
    let zero = T::Real::splat(simd, T::Real::default());
    let l = node.in_strip(cols.start);
    let (re, re_end) = T::Real::vectors::<S>(re);
    let (im, im_end) = T::Real::vectors::<S>(im);
    for (some, sums) in pieces(cols, COLUMNS_PER_SUM).zip(sums.chunks_mut(COLUMNS_PER_SUM)) {
        // The last column again where there are fewer: those sums are not looked at.
        let column = |c: usize, part: usize| l.part((some.start + c).min(some.end - 1), part, rows.clone());
        let columns: [[&[T::Real]; 2]; COLUMNS_PER_SUM] =
            std::array::from_fn(|c| [column(c, 0), column(c, T::PARTS - 1)]);
        // Σ l re, Σ m im, which is to be taken from it, and Σ l im + m re.
        let mut totals = [[zero; 3]; COLUMNS_PER_SUM];
        for at in 0..re.len() {
            let x = [re[at], if T::PARTS == 2 { im[at] } else { re[at] }];
            for c in 0..COLUMNS_PER_SUM {
                let [l, m] = columns[c];
                let l = [T::Real::vectors::<S>(l).0[at], T::Real::vectors::<S>(m).0[at]];
                totals[c] = dot_term::<T, S>(simd, l, x, totals[c]);
            }
        }
        if !re_end.is_empty() {
            let x = [T::Real::load_part(simd, re_end), T::Real::load_part(simd, im_end)];
            for c in 0..COLUMNS_PER_SUM {
                let [l, m] = columns[c].map(|column| T::Real::vectors::<S>(column).1);
                let l = [T::Real::load_part(simd, l), T::Real::load_part(simd, m)];
                totals[c] = dot_term::<T, S>(simd, l, x, totals[c]);
            }
        }
        for (sum, [plus, minus, between]) in sums.iter_mut().zip(totals) {
            let plus = T::Real::sum(simd, plus);
            *sum += if T::PARTS == 1 {
                T::from_real(plus)
            } else {
                T::from_parts([plus - T::Real::sum(simd, minus), T::Real::sum(simd, between)])
            };
        }
    }
}

#[inline(always)]
fn dot_term<T: Scalar, S: Simd>(
    simd: S,
    [l, m]: [<T::Real as Real>::Vector<S>; 2],
    [x, y]: [<T::Real as Real>::Vector<S>; 2],
    [plus, minus, between]: [<T::Real as Real>::Vector<S>; 3],
) -> [<T::Real as Real>::Vector<S>; 3] {
    let plus = T::Real::mul_add(simd, l, x, plus);
    if T::PARTS == 1 {
        return [plus, minus, between];
    }
    let minus = T::Real::mul_add(simd, m, y, minus);
    let between = T::Real::mul_add(simd, l, y, between);
    [plus, minus, T::Real::mul_add(simd, m, x, between)]
}

/// x = D⁻¹ x.
#[inline(always)]
fn times_inverse<T: Scalar>(inverse: &[[T; 2]], re: &mut [T::Real], im: &mut [T::Real]) {
    let mut k = 0;
    while k < inverse.len() {
        let x = T::from_parts([re[k], im[k]]);
        let [pivot, below] = inverse[k];
        if below == T::default() {
            [re[k], im[k]] = (pivot * x).parts();
            k += 1;
        } else {
            let y = T::from_parts([re[k + 1], im[k + 1]]);
            [re[k], im[k]] = (pivot * x + below * y).parts();
            [re[k + 1], im[k + 1]] = (below * x + inverse[k + 1][0] * y).parts();
            k += 2;
        }
    }
}
