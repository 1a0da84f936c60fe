//! Right-hand sides side by side: a register holds those of one row, so that every number of L is met once.

use super::{COLUMNS_PER_PASS, Columns, InStrip, Step, pieces, shares};
use crate::scalar::{Number, Real, Scalar};
use crate::threads::each;
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;
use std::ops::Range;

/// The most rows at a time: what belongs to them stays in the first caches while all columns pass.
const MAX_ROWS_PER_PASS: usize = 512;

/// Rows whose products are summed before they are added to what the others gave. An error grows with the root of how
/// often something was added: one sum over all rows made nine tenths of the backward error of a block of 51,000 unknowns.
const ROWS_PER_SUM: usize = 64;

/// Right-hand sides that are side by side.
pub(super) fn lanes<R: Real>() -> usize {
    crate::arch().dispatch(Lanes(PhantomData::<R>))
}

struct Lanes<R>(PhantomData<R>);

impl<R: Real> WithSimd for Lanes<R> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        registers::<R, S>() * R::lanes::<S>()
    }
}

/// Registers for one part of a row: short ones come in pairs.
const fn registers<R: Real, S: Simd>() -> usize {
    if size_of::<R::Vector<S>>() < 8 * size_of::<R>() { 2 } else { 1 }
}

/// Work on rows whose parts take V registers each; the sums of G rows or columns are in registers at a time.
pub(super) trait Shaped: Sized {
    type Scalar: Scalar;

    fn run<S: Simd, const V: usize, const G: usize>(self, simd: S);

    fn dispatch(self) {
        crate::arch().dispatch(InShape(self));
    }
}

struct InShape<W>(W);

impl<W: Shaped> WithSimd for InShape<W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Constant, so that only one of them is compiled.
        if const { registers::<<W::Scalar as Number>::Real, S>() == 1 } {
            self.0.run::<S, 1, 8>(simd)
        } else {
            self.0.run::<S, 2, 2>(simd)
        }
    }
}

/// Numbers of one row.
fn row_len<T: Scalar, S: Simd, const V: usize>() -> usize {
    T::PARTS * V * T::Real::lanes::<S>()
}

/// y = L⁻¹ b.
pub(super) struct Forward<'a, T: Scalar>(pub(super) Step<'a, T>);

/// x = L⁻ᵀ D⁻¹ y.
pub(super) struct Backward<'a, T: Scalar>(pub(super) Step<'a, T>);

impl<T: Scalar> Shaped for Forward<'_, T> {
    type Scalar = T;

    #[inline(always)]
    fn run<S: Simd, const V: usize, const G: usize>(self, simd: S) {
        let Step { node, local, buffer, threads, .. } = self.0;
        let (pivots, rows) = (node.pivots(), node.order());
        let row = row_len::<T, S, V>();
        let y = buffer.some(row * rows);
        let (own, below) = y.split_at_mut(row * pivots);
        own.copy_from_slice(&local[node.first * row..][..row * pivots]);
        below.fill(T::Real::default());
        for span in node.spans() {
            let inner = node.inner(&span, true);
            let (own, below) = y.split_at_mut(inner * row);
            for cols in pieces(span.clone(), COLUMNS_PER_PASS) {
                let (block, rest) = own[cols.start * row..].split_at_mut(cols.len() * row);
                packed_lower::<T, S, V>(simd, node, &cols, block);
                multiply::<T, S, V, G>(simd, node, &cols, block, cols.end..inner, rest);
            }
            let own = &own[span.start * row..span.end * row];
            let (len, shares) = shares(inner..rows, threads, MAX_ROWS_PER_PASS);
            let tasks = shares.zip(below.chunks_mut(len * row));
            let tasks = tasks.map(|(rows, y)| Multiply { node, span: span.clone(), own, rows, y });
            each(threads, tasks.collect(), Shaped::dispatch);
        }
        let (own, below) = y.split_at(row * pivots);
        local[node.first * row..][..row * pivots].copy_from_slice(own);
        for (&place, y) in node.rows.iter().zip(below.chunks_exact(row)) {
            let x = &mut local[place as usize * row..][..row];
            x.iter_mut().zip(y).for_each(|(x, &y)| *x += y);
        }
    }
}

impl<T: Scalar> Shaped for Backward<'_, T> {
    type Scalar = T;

    #[inline(always)]
    fn run<S: Simd, const V: usize, const G: usize>(self, simd: S) {
        let Step { node, local, buffer, threads, .. } = self.0;
        let (pivots, rows) = (node.pivots(), node.order());
        let row = row_len::<T, S, V>();
        let y = buffer.some(row * rows);
        let (own, below) = y.split_at_mut(row * pivots);
        own.copy_from_slice(&local[node.first * row..][..row * pivots]);
        for (&place, below) in node.rows.iter().zip(below.chunks_exact_mut(row)) {
            below.copy_from_slice(&local[place as usize * row..][..row]);
        }
        times_inverse::<T, S, V>(simd, &node.inverse, y);
        for span in node.spans().rev() {
            let inner = node.inner(&span, true);
            let (own, below) = y.split_at_mut(inner * row);
            let (own, below) = (&mut own[span.start * row..], &*below);
            if inner < rows {
                let tasks = pieces(span.clone(), COLUMNS_PER_PASS)
                    .zip(own[..span.len() * row].chunks_mut(COLUMNS_PER_PASS * row));
                let tasks = tasks.map(|(cols, block)| Dot { node, cols, block, rows: inner..rows, y: below });
                each(threads, tasks.collect(), Shaped::dispatch);
            }
            for cols in pieces(span.clone(), COLUMNS_PER_PASS).rev() {
                let (block, rest) = own[(cols.start - span.start) * row..].split_at_mut(cols.len() * row);
                subtract_dot::<T, S, V, G>(simd, node, cols.clone(), block, cols.end..inner, rest);
                transposed_triangle::<T, S, V>(simd, node, &cols, block);
            }
        }
        local[node.first * row..][..row * pivots].copy_from_slice(&y[..row * pivots]);
    }
}

/// Subtracts L · own of a span from some rows.
struct Multiply<'a, T: Scalar> {
    node: Columns<'a, T>,
    span: Range<usize>,
    own: &'a [T::Real],
    rows: Range<usize>,
    y: &'a mut [T::Real],
}

impl<T: Scalar> Shaped for Multiply<'_, T> {
    type Scalar = T;

    #[inline(always)]
    fn run<S: Simd, const V: usize, const G: usize>(self, simd: S) {
        let Self { node, span, own, rows, y } = self;
        let row = row_len::<T, S, V>();
        for (cols, block) in pieces(span, COLUMNS_PER_PASS).zip(own.chunks(COLUMNS_PER_PASS * row)) {
            multiply::<T, S, V, G>(simd, node, &cols, block, rows.clone(), &mut *y);
        }
    }
}

/// Subtracts Lᵀ y over some rows from a block.
struct Dot<'a, T: Scalar> {
    node: Columns<'a, T>,
    cols: Range<usize>,
    block: &'a mut [T::Real],
    rows: Range<usize>,
    y: &'a [T::Real],
}

impl<T: Scalar> Shaped for Dot<'_, T> {
    type Scalar = T;

    #[inline(always)]
    fn run<S: Simd, const V: usize, const G: usize>(self, simd: S) {
        subtract_dot::<T, S, V, G>(simd, self.node, self.cols, self.block, self.rows, self.y);
    }
}

/// One row of all right-hand sides: its parts.
type Row<R, S, const V: usize> = [[<R as Real>::Vector<S>; V]; 2];

#[inline(always)]
fn load<T: Scalar, S: Simd, const V: usize>(y: &[T::Real], row: usize) -> Row<T::Real, S, V> {
    // Not by closures, which would go by way of memory.
    let y = T::Real::vectors::<S>(y).0.as_chunks::<V>().0;
    [y[row * T::PARTS], y[row * T::PARTS + T::PARTS - 1]]
}

#[inline(always)]
fn store<T: Scalar, S: Simd, const V: usize>(y: &mut [T::Real], row: usize, values: Row<T::Real, S, V>) {
    let y = T::Real::vectors_mut::<S>(y).0.as_chunks_mut::<V>().0;
    y[row * T::PARTS..][..T::PARTS].copy_from_slice(&values[..T::PARTS]);
}

/// −x.
#[inline(always)]
fn minus<R: Real, S: Simd, const V: usize>(simd: S, mut x: [R::Vector<S>; V]) -> [R::Vector<S>; V] {
    let (one, zero) = (R::splat(simd, -R::ONE), R::splat(simd, R::default()));
    for v in 0..V {
        x[v] = R::mul_add(simd, one, x[v], zero);
    }
    x
}

/// x + y.
#[inline(always)]
fn plus<T: Scalar, S: Simd, const V: usize>(
    simd: S,
    mut x: Row<T::Real, S, V>,
    y: Row<T::Real, S, V>,
) -> Row<T::Real, S, V> {
    let one = T::Real::splat(simd, T::Real::ONE);
    for part in 0..T::PARTS {
        for v in 0..V {
            x[part][v] = T::Real::mul_add(simd, one, y[part][v], x[part][v]);
        }
    }
    x
}

/// sum + l x, the row x with minus its imaginary part.
#[inline(always)]
fn term<T: Scalar, S: Simd, const V: usize>(
    simd: S,
    l: [T::Real; 2],
    [x, y]: Row<T::Real, S, V>,
    minus_y: [<T::Real as Real>::Vector<S>; V],
    [mut re, mut im]: Row<T::Real, S, V>,
) -> Row<T::Real, S, V> {
    let (l, m) = (T::Real::splat(simd, l[0]), T::Real::splat(simd, l[1]));
    for v in 0..V {
        re[v] = T::Real::mul_add(simd, l, x[v], re[v]);
        if T::PARTS == 2 {
            im[v] = T::Real::mul_add(simd, l, y[v], im[v]);
            re[v] = T::Real::mul_add(simd, m, minus_y[v], re[v]);
            im[v] = T::Real::mul_add(simd, m, x[v], im[v]);
        }
    }
    [re, im]
}

/// y[to] += factor · y[from].
#[inline(always)]
fn add<T: Scalar, S: Simd, const V: usize>(simd: S, y: &mut [T::Real], to: usize, factor: T, from: usize) {
    let x = load::<T, S, V>(y, from);
    let sum = load::<T, S, V>(y, to);
    let sum = term::<T, S, V>(simd, factor.parts(), x, minus::<T::Real, S, V>(simd, x[1]), sum);
    store::<T, S, V>(y, to, sum);
}

/// Solves with the triangle of a block of columns.
#[inline(always)]
fn packed_lower<T: Scalar, S: Simd, const V: usize>(
    simd: S,
    node: Columns<'_, T>,
    cols: &Range<usize>,
    y: &mut [T::Real],
) {
    let l = node.in_strip(cols.start);
    for j in cols.clone() {
        for i in j + 1..cols.end {
            add::<T, S, V>(simd, y, i - cols.start, -l.at(i, j), j - cols.start);
        }
    }
}

#[inline(always)]
fn transposed_triangle<T: Scalar, S: Simd, const V: usize>(
    simd: S,
    node: Columns<'_, T>,
    cols: &Range<usize>,
    y: &mut [T::Real],
) {
    let l = node.in_strip(cols.start);
    for j in cols.clone().rev() {
        for i in j + 1..cols.end {
            add::<T, S, V>(simd, y, j - cols.start, -l.at(i, j), i - cols.start);
        }
    }
}

/// Subtracts L · block from some rows y, G of them at a time.
#[inline(always)]
fn multiply<T: Scalar, S: Simd, const V: usize, const G: usize>(
    simd: S,
    node: Columns<'_, T>,
    cols: &Range<usize>,
    block: &[T::Real],
    rows: Range<usize>,
    y: &mut [T::Real],
) {
    let (l, count) = (node.in_strip(cols.start), rows.len());
    let mut at = 0;
    while at + G <= count {
        multiply_rows::<T, S, V, G>(simd, &l, cols, block, rows.start + at, (&mut *y, at));
        at += G;
    }
    while at < count {
        multiply_rows::<T, S, V, 1>(simd, &l, cols, block, rows.start + at, (&mut *y, at));
        at += 1;
    }
}

#[inline(always)]
fn multiply_rows<T: Scalar, S: Simd, const V: usize, const G: usize>(
    simd: S,
    columns: &InStrip<'_, T>,
    cols: &Range<usize>,
    block: &[T::Real],
    row: usize,
    (y, at): (&mut [T::Real], usize),
) {
    let mut sums = [[[T::Real::splat(simd, T::Real::default()); V]; 2]; G];
    for g in 0..G {
        sums[g] = load::<T, S, V>(y, at + g);
    }
    for (k, col) in cols.clone().enumerate() {
        let [x, z] = load::<T, S, V>(block, k);
        let x = [minus::<T::Real, S, V>(simd, x), minus::<T::Real, S, V>(simd, z)];
        let l = columns.part(col, 0, row..row + G);
        let m = columns.part(col, T::PARTS - 1, row..row + G);
        for g in 0..G {
            sums[g] = term::<T, S, V>(simd, [l[g], m[g]], x, z, sums[g]);
        }
    }
    for g in 0..G {
        store::<T, S, V>(y, at + g, sums[g]);
    }
}

/// Subtracts Lᵀ y over some rows from a block, G of its columns at a time.
#[inline(always)]
fn subtract_dot<T: Scalar, S: Simd, const V: usize, const G: usize>(
    simd: S,
    node: Columns<'_, T>,
    cols: Range<usize>,
    block: &mut [T::Real],
    rows: Range<usize>,
    y: &[T::Real],
) {
    let (l, zero) = (node.in_strip(cols.start), T::Real::splat(simd, T::Real::default()));
    for some in pieces(cols.clone(), G) {
        // The last column again where there are fewer: those sums are not looked at.
        let column = |g: usize, part: usize| l.part((some.start + g).min(some.end - 1), part, rows.clone());
        let columns: [[&[T::Real]; 2]; G] = std::array::from_fn(|g| [column(g, 0), column(g, T::PARTS - 1)]);
        let mut less = [[[zero; V]; 2]; G];
        for piece in pieces(0..rows.len(), ROWS_PER_SUM) {
            let mut sums = [[[zero; V]; 2]; G];
            for at in piece {
                let x = load::<T, S, V>(y, at);
                let minus_im = minus::<T::Real, S, V>(simd, x[1]);
                for g in 0..G {
                    let l = [columns[g][0][at], columns[g][1][at]];
                    sums[g] = term::<T, S, V>(simd, l, x, minus_im, sums[g]);
                }
            }
            for g in 0..G {
                less[g] = plus::<T, S, V>(simd, less[g], sums[g]);
            }
        }
        for (col, less) in some.zip(less) {
            let x = load::<T, S, V>(block, col - cols.start);
            let less = less.map(|part| minus::<T::Real, S, V>(simd, part));
            store::<T, S, V>(block, col - cols.start, plus::<T, S, V>(simd, x, less));
        }
    }
}

/// x = D⁻¹ x.
#[inline(always)]
fn times_inverse<T: Scalar, S: Simd, const V: usize>(simd: S, inverse: &[[T; 2]], y: &mut [T::Real]) {
    let zero = T::Real::splat(simd, T::Real::default());
    let times = |factor: T, x: Row<T::Real, S, V>, sum: Row<T::Real, S, V>| {
        term::<T, S, V>(simd, factor.parts(), x, minus::<T::Real, S, V>(simd, x[1]), sum)
    };
    let mut k = 0;
    while k < inverse.len() {
        let [pivot, below] = inverse[k];
        let a = load::<T, S, V>(y, k);
        if below == T::default() {
            store::<T, S, V>(y, k, times(pivot, a, [[zero; V]; 2]));
            k += 1;
        } else {
            let b = load::<T, S, V>(y, k + 1);
            store::<T, S, V>(y, k, times(pivot, a, times(below, b, [[zero; V]; 2])));
            let second = times(inverse[k + 1][0], b, [[zero; V]; 2]);
            store::<T, S, V>(y, k + 1, times(below, a, second));
            k += 2;
        }
    }
}
