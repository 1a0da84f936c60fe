//! One node's share of a solution, at the speed at which its numbers come from memory.

use crate::factor::{BLOCK, Node};
use crate::scalar::{Real, Scalar};
use pulp::{Simd, WithSimd};

/// Right-hand sides that are worked on together: their sums fit the registers.
const TOGETHER: usize = 4;

/// Rows of a block that stay in the second cache while all right-hand sides pass.
const CHUNK: usize = 1024;

/// Buffers of one worker.
#[derive(Debug)]
pub(super) struct Buffers<R> {
    /// The parts of all rows of a front, right-hand side after right-hand side.
    parts: Vec<R>,
    /// What a block's columns are multiplied with, or what their products sum up to.
    factors: Vec<R>,
}

impl<R> Default for Buffers<R> {
    fn default() -> Self {
        Self { parts: Vec::new(), factors: Vec::new() }
    }
}

/// Some columns of L, parts apart.
#[derive(Clone, Copy)]
struct Block<'a, R> {
    values: &'a [R],
    /// From one part to the next: its rows.
    stride: usize,
    width: usize,
    parts: usize,
}

impl<'a, R: Real> Block<'a, R> {
    #[inline(always)]
    fn part(&self, col: usize, part: usize) -> &'a [R] {
        &self.values[(col * self.parts + part) * self.stride..][..self.stride]
    }

    #[inline(always)]
    fn at<T: Scalar<Real = R>>(&self, row: usize, col: usize) -> T {
        T::from_parts([self.part(col, 0)[row], self.part(col, self.parts - 1)[row]])
    }
}

/// The blocks of a node, each with the place of its first column.
#[inline(always)]
fn blocks<T: Scalar>(node: &Node<T>) -> impl DoubleEndedIterator<Item = (usize, Block<'_, T::Real>)> {
    let (pivots, rows) = (node.pivots(), node.order());
    (0..pivots.div_ceil(BLOCK)).map(move |k| {
        let first = k * BLOCK;
        let width = BLOCK.min(pivots - first);
        let stride = rows - first;
        // Σ over the blocks before of their rows.
        let start = T::PARTS * BLOCK * (k * rows - BLOCK * (k * k.saturating_sub(1) / 2));
        let values = &node.values[start..start + T::PARTS * width * stride];
        (first, Block { values, stride, width, parts: T::PARTS })
    })
}

pub(super) struct Forward<'a, T: Scalar> {
    pub(super) node: &'a Node<T>,
    pub(super) local: &'a mut [T],
    pub(super) columns: usize,
    pub(super) buffers: &'a mut Buffers<T::Real>,
}

impl<T: Scalar> WithSimd for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { node, local, columns, buffers: Buffers { parts, factors } } = self;
        let (pivots, rows) = (node.pivots(), node.order());
        let size = local.len() / columns;
        let touched =
            local.chunks_exact(size).any(|x| x[node.first..][..pivots].iter().any(|&x| x != T::default()));
        if !touched {
            return;
        }
        let step = rows * T::PARTS;
        parts.clear();
        parts.resize(step * columns, T::Real::default());
        for (x, parts) in local.chunks_exact(size).zip(parts.chunks_exact_mut(step)) {
            x[node.first..][..pivots].iter().enumerate().for_each(|(k, &x)| put(parts, rows, k, x));
        }
        for (first, block) in blocks(node) {
            factors.clear();
            for (x, parts) in local.chunks_exact_mut(size).zip(parts.chunks_exact(step)) {
                let mut y: [T; BLOCK] = [T::default(); BLOCK];
                for j in 0..block.width {
                    y[j] += get(parts, rows, first + j);
                    for i in j + 1..block.width {
                        let change = block.at::<T>(i, j) * y[j];
                        y[i] -= change;
                    }
                }
                x[node.first + first..][..block.width].copy_from_slice(&y[..block.width]);
                factors.extend(y.iter().flat_map(|&y| (-y).parts()));
            }
            for start in (block.width..block.stride).step_by(CHUNK) {
                let range = start..block.stride.min(start + CHUNK);
                for (parts, factors) in parts.chunks_mut(TOGETHER * step).zip(factors.chunks(TOGETHER * 2 * BLOCK)) {
                    let target = (parts, rows, first);
                    match factors.len() / (2 * BLOCK) {
                        1 => multiply::<T, S, 1>(simd, block, factors, target, range.clone()),
                        2 => multiply::<T, S, 2>(simd, block, factors, target, range.clone()),
                        3 => multiply::<T, S, 3>(simd, block, factors, target, range.clone()),
                        _ => multiply::<T, S, 4>(simd, block, factors, target, range.clone()),
                    }
                }
            }
        }
        for (x, parts) in local.chunks_exact_mut(size).zip(parts.chunks_exact(step)) {
            for (k, &row) in node.rows.iter().enumerate() {
                x[row as usize] += get(parts, rows, pivots + k);
            }
        }
    }
}

#[inline(always)]
fn get<T: Scalar>(parts: &[T::Real], rows: usize, row: usize) -> T {
    T::from_parts([parts[row], parts[row + (T::PARTS - 1) * rows]])
}

#[inline(always)]
fn put<T: Scalar>(parts: &mut [T::Real], rows: usize, row: usize, value: T) {
    let [re, im] = value.parts();
    parts[row] = re;
    if T::PARTS == 2 {
        parts[rows + row] = im;
    }
}

/// Adds L · factors to N right-hand sides, in some rows of a block whose first is row `first` of the front.
#[inline(always)]
fn multiply<T: Scalar, S: Simd, const N: usize>(
    simd: S,
    block: Block<'_, T::Real>,
    factors: &[T::Real],
    (parts, rows, first): (&mut [T::Real], usize, usize),
    range: std::ops::Range<usize>,
) {
    let lanes = <T::Real as Real>::lanes::<S>();
    let mut at = range.start;
    while at < range.end {
        let len = lanes.min(range.end - at);
        let whole = len == lanes;
        let load = |values: &[T::Real], at: usize| {
            if whole {
                T::Real::vectors::<S>(&values[at..at + lanes]).0[0]
            } else {
                T::Real::load_part(simd, &values[at..at + len])
            }
        };
        let place = |n: usize, part: usize| (n * T::PARTS + part) * rows + first + at;
        let mut re: [_; N] = std::array::from_fn(|n| load(parts, place(n, 0)));
        let mut im: [_; N] = std::array::from_fn(|n| load(parts, place(n, T::PARTS - 1)));
        for k in 0..block.width {
            let l = load(block.part(k, 0), at);
            let m = load(block.part(k, T::PARTS - 1), at);
            for n in 0..N {
                let factor = &factors[2 * (n * BLOCK + k)..][..2];
                let (x, y) = (T::Real::splat(simd, factor[0]), T::Real::splat(simd, factor[1]));
                re[n] = T::Real::mul_add(simd, l, x, re[n]);
                if T::PARTS == 2 {
                    let minus = T::Real::splat(simd, -factor[1]);
                    re[n] = T::Real::mul_add(simd, m, minus, re[n]);
                    im[n] = T::Real::mul_add(simd, l, y, im[n]);
                    im[n] = T::Real::mul_add(simd, m, x, im[n]);
                }
            }
        }
        for (part, sums) in [re, im].into_iter().enumerate().take(T::PARTS) {
            for (n, sum) in sums.into_iter().enumerate() {
                let place = place(n, part);
                if whole {
                    T::Real::vectors_mut::<S>(&mut parts[place..place + lanes]).0[0] = sum;
                } else {
                    T::Real::store_part(simd, &mut parts[place..place + len], sum);
                }
            }
        }
        at += len;
    }
}

pub(super) struct Backward<'a, T: Scalar> {
    pub(super) node: &'a Node<T>,
    pub(super) local: &'a mut [T],
    pub(super) columns: usize,
    pub(super) buffers: &'a mut Buffers<T::Real>,
}

impl<T: Scalar> WithSimd for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { node, local, columns, buffers: Buffers { parts, factors } } = self;
        let (pivots, rows) = (node.pivots(), node.order());
        let size = local.len() / columns;
        let step = rows * T::PARTS;
        parts.clear();
        parts.resize(step * columns, T::Real::default());
        for (x, parts) in local.chunks_exact_mut(size).zip(parts.chunks_exact_mut(step)) {
            times_inverse(&mut x[node.first..][..pivots], &node.inverse);
            node.rows.iter().enumerate().for_each(|(k, &row)| put(parts, rows, pivots + k, x[row as usize]));
        }
        for (first, block) in blocks(node).rev() {
            factors.clear();
            factors.resize(2 * BLOCK * columns, T::Real::default());
            for start in (block.width..block.stride).step_by(CHUNK) {
                let range = start..block.stride.min(start + CHUNK);
                let sums = factors.chunks_mut(TOGETHER * 2 * BLOCK);
                for (parts, sums) in parts.chunks(TOGETHER * step).zip(sums) {
                    let source = (parts, rows, first);
                    match sums.len() / (2 * BLOCK) {
                        1 => dot::<T, S, 1, 4>(simd, block, source, range.clone(), sums),
                        2 => dot::<T, S, 2, 2>(simd, block, source, range.clone(), sums),
                        3 => dot::<T, S, 3, 2>(simd, block, source, range.clone(), sums),
                        _ => dot::<T, S, 4, 2>(simd, block, source, range.clone(), sums),
                    }
                }
            }
            for (c, x) in local.chunks_exact_mut(size).enumerate() {
                let x = &mut x[node.first + first..][..block.width];
                for j in (0..block.width).rev() {
                    let sum = &factors[2 * (c * BLOCK + j)..][..2];
                    let mut value = x[j] - T::from_parts([sum[0], sum[1]]);
                    for i in j + 1..block.width {
                        value -= block.at::<T>(i, j) * x[i];
                    }
                    x[j] = value;
                    put(&mut parts[c * step..], rows, first + j, value);
                }
            }
        }
    }
}

/// x = D⁻¹ x.
#[inline(always)]
fn times_inverse<T: Scalar>(x: &mut [T], inverse: &[[T; 2]]) {
    let mut k = 0;
    while k < x.len() {
        let [pivot, below] = inverse[k];
        if below == T::default() {
            x[k] *= pivot;
            k += 1;
        } else {
            let (a, b) = (x[k], x[k + 1]);
            x[k] = pivot * a + below * b;
            x[k + 1] = below * a + inverse[k + 1][0] * b;
            k += 2;
        }
    }
}

/// Adds Lᵀ · parts to the sums of N right-hand sides, over some rows of a block, C columns at a time.
#[inline(always)]
fn dot<T: Scalar, S: Simd, const N: usize, const C: usize>(
    simd: S,
    block: Block<'_, T::Real>,
    (parts, rows, first): (&[T::Real], usize, usize),
    range: std::ops::Range<usize>,
    sums: &mut [T::Real],
) {
    let lanes = <T::Real as Real>::lanes::<S>();
    let zero = T::Real::splat(simd, T::Real::default());
    for col in (0..block.width).step_by(C) {
        // The last column again where there are fewer: those sums are not looked at.
        let column = |part: usize| {
            let of = move |c: usize| block.part((col + c).min(block.width - 1), part);
            std::array::from_fn::<_, C, _>(of)
        };
        let (l, m) = (column(0), column(T::PARTS - 1));
        // Σ l re − m im in two sums, so that no sign is turned in the loop, and Σ l im + m re.
        let (mut plus, mut minus, mut im) = ([[zero; N]; C], [[zero; N]; C], [[zero; N]; C]);
        let mut at = range.start;
        while at < range.end {
            let len = lanes.min(range.end - at);
            let load = |values: &[T::Real], at: usize| {
                if len == lanes {
                    T::Real::vectors::<S>(&values[at..at + lanes]).0[0]
                } else {
                    T::Real::load_part(simd, &values[at..at + len])
                }
            };
            let place = |n: usize, part: usize| (n * T::PARTS + part) * rows + first + at;
            let x: [_; N] = std::array::from_fn(|n| load(parts, place(n, 0)));
            let y: [_; N] = std::array::from_fn(|n| load(parts, place(n, T::PARTS - 1)));
            for c in 0..C {
                let (l, m) = (load(l[c], at), load(m[c], at));
                for n in 0..N {
                    plus[c][n] = T::Real::mul_add(simd, l, x[n], plus[c][n]);
                    if T::PARTS == 2 {
                        minus[c][n] = T::Real::mul_add(simd, m, y[n], minus[c][n]);
                        im[c][n] = T::Real::mul_add(simd, l, y[n], im[c][n]);
                        im[c][n] = T::Real::mul_add(simd, m, x[n], im[c][n]);
                    }
                }
            }
            at += len;
        }
        for c in 0..C.min(block.width - col) {
            for n in 0..N {
                let sum = &mut sums[2 * (n * BLOCK + col + c)..][..2];
                sum[0] += T::Real::sum(simd, plus[c][n]);
                if T::PARTS == 2 {
                    sum[0] -= T::Real::sum(simd, minus[c][n]);
                    sum[1] += T::Real::sum(simd, im[c][n]);
                }
            }
        }
    }
}
