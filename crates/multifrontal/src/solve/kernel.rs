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

/// A call with the number of right-hand sides as a constant.
macro_rules! with_count {
    ($count:expr, $n:ident => $call:expr) => {
        match $count {
            1 => {
                const $n: usize = 1;
                $call
            }
            2 => {
                const $n: usize = 2;
                $call
            }
            3 => {
                const $n: usize = 3;
                $call
            }
            _ => {
                const $n: usize = TOGETHER;
                $call
            }
        }
    };
}

/// One node, and the numbers of its part, right-hand side after right-hand side.
pub(super) struct Step<'a, T: Scalar> {
    pub(super) node: &'a Node<T>,
    pub(super) local: &'a mut [T],
    pub(super) columns: usize,
    pub(super) buffers: &'a mut Buffers<T::Real>,
}

/// y = L⁻¹ b.
pub(super) struct Forward<'a, T: Scalar>(pub(super) Step<'a, T>);

impl<T: Scalar> WithSimd for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { node, local, columns, buffers: Buffers { parts, factors } } = self.0;
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
            factors.resize(2 * BLOCK * columns, T::Real::default());
            let groups = parts.chunks(TOGETHER * step).zip(factors.chunks_mut(TOGETHER * 2 * BLOCK));
            for (local, (parts, factors)) in local.chunks_mut(TOGETHER * size).zip(groups) {
                let places = (node.first + first, size);
                with_count!(local.len() / size, N => forward_triangle::<T, N>(
                    block, (parts, rows, first), (local, places), factors,
                ));
            }
            for start in (block.width..block.stride).step_by(CHUNK) {
                let range = start..block.stride.min(start + CHUNK);
                for (parts, factors) in
                    parts.chunks_mut(TOGETHER * step).zip(factors.chunks(TOGETHER * 2 * BLOCK))
                {
                    let target = (parts, rows, first);
                    with_count!(factors.len() / (2 * BLOCK), N => multiply::<T, S, N>(
                        simd, block, factors, target, range.clone(),
                    ));
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

/// Numbers of a block's rows, part after part, those of all right-hand sides side by side.
type Rows<R, const N: usize> = [[[R; N]; BLOCK]; 2];

/// y[to] −= l · y[from], for all right-hand sides.
#[inline(always)]
fn subtract<T: Scalar, const N: usize>(y: &mut Rows<T::Real, N>, to: usize, l: T, from: usize) {
    let [re, im] = l.parts();
    let (x, z) = (y[0][from], y[1][from]);
    for n in 0..N {
        if T::PARTS == 1 {
            y[0][to][n] -= re * x[n];
        } else {
            y[0][to][n] -= re * x[n] - im * z[n];
            y[1][to][n] -= re * z[n] + im * x[n];
        }
    }
}

/// Solves with the triangle of a block; the solutions, and what the rows below it are to be multiplied with.
#[inline(always)]
fn forward_triangle<T: Scalar, const N: usize>(
    block: Block<'_, T::Real>,
    (parts, rows, first): (&[T::Real], usize, usize),
    (local, (place, size)): (&mut [T], (usize, usize)),
    factors: &mut [T::Real],
) {
    let mut y: Rows<T::Real, N> = [[[T::Real::default(); N]; BLOCK]; 2];
    for (part, y) in y.iter_mut().enumerate().take(T::PARTS) {
        for (k, y) in y.iter_mut().enumerate().take(block.width) {
            *y = std::array::from_fn(|n| parts[(n * T::PARTS + part) * rows + first + k]);
        }
    }
    for j in 0..block.width {
        for i in j + 1..block.width {
            subtract::<T, N>(&mut y, i, block.at(i, j), j);
        }
    }
    for n in 0..N {
        for k in 0..block.width {
            local[n * size + place + k] = T::from_parts([y[0][k][n], y[1][k][n]]);
            let factor = &mut factors[2 * (n * BLOCK + k)..][..2];
            (factor[0], factor[1]) = (-y[0][k][n], -y[1][k][n]);
        }
    }
}

/// Whole registers, and the numbers that do not fill one.
#[derive(Clone, Copy)]
struct Whole;
#[derive(Clone, Copy)]
struct Part(usize);

/// How numbers come into registers.
trait Load: Copy {
    fn load<R: Real, S: Simd>(self, simd: S, values: &[R]) -> R::Vector<S>;
    fn store<R: Real, S: Simd>(self, simd: S, values: &mut [R], vector: R::Vector<S>);
}

impl Load for Whole {
    #[inline(always)]
    fn load<R: Real, S: Simd>(self, _: S, values: &[R]) -> R::Vector<S> {
        R::vectors::<S>(&values[..R::lanes::<S>()]).0[0]
    }

    #[inline(always)]
    fn store<R: Real, S: Simd>(self, _: S, values: &mut [R], vector: R::Vector<S>) {
        R::vectors_mut::<S>(&mut values[..R::lanes::<S>()]).0[0] = vector;
    }
}

impl Load for Part {
    #[inline(always)]
    fn load<R: Real, S: Simd>(self, simd: S, values: &[R]) -> R::Vector<S> {
        R::load_part(simd, &values[..self.0])
    }

    #[inline(always)]
    fn store<R: Real, S: Simd>(self, simd: S, values: &mut [R], vector: R::Vector<S>) {
        R::store_part(simd, &mut values[..self.0], vector);
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
    while at + lanes <= range.end {
        multiply_rows::<T, S, N>(simd, block, factors, (parts, rows, first), at, Whole);
        at += lanes;
    }
    if at < range.end {
        multiply_rows::<T, S, N>(simd, block, factors, (parts, rows, first), at, Part(range.end - at));
    }
}

#[inline(always)]
fn multiply_rows<T: Scalar, S: Simd, const N: usize>(
    simd: S,
    block: Block<'_, T::Real>,
    factors: &[T::Real],
    (parts, rows, first): (&mut [T::Real], usize, usize),
    at: usize,
    with: impl Load,
) {
    let place = |n: usize, part: usize| (n * T::PARTS + part) * rows + first + at;
    let mut sums: [[_; N]; 2] =
        [0, T::PARTS - 1].map(|part| std::array::from_fn(|n| with.load(simd, &parts[place(n, part)..])));
    let [re, im] = &mut sums;
    for k in 0..block.width {
        let l = with.load(simd, &block.part(k, 0)[at..]);
        if T::PARTS == 1 {
            for n in 0..N {
                re[n] = T::Real::mul_add(simd, l, T::Real::splat(simd, factors[2 * (n * BLOCK + k)]), re[n]);
            }
            continue;
        }
        let m = with.load(simd, &block.part(k, 1)[at..]);
        for n in 0..N {
            let factor = &factors[2 * (n * BLOCK + k)..][..2];
            let [x, y, minus] = [factor[0], factor[1], -factor[1]].map(|factor| T::Real::splat(simd, factor));
            re[n] = T::Real::mul_add(simd, l, x, re[n]);
            im[n] = T::Real::mul_add(simd, l, y, im[n]);
            re[n] = T::Real::mul_add(simd, m, minus, re[n]);
            im[n] = T::Real::mul_add(simd, m, x, im[n]);
        }
    }
    for (part, sums) in sums.into_iter().enumerate().take(T::PARTS) {
        for (n, sum) in sums.into_iter().enumerate() {
            with.store(simd, &mut parts[place(n, part)..], sum);
        }
    }
}

/// x = L⁻ᵀ D⁻¹ y.
pub(super) struct Backward<'a, T: Scalar>(pub(super) Step<'a, T>);

impl<T: Scalar> WithSimd for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { node, local, columns, buffers: Buffers { parts, factors } } = self.0;
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
                    if sums.len() == 2 * BLOCK {
                        dot::<T, S, 1, 4>(simd, block, source, range.clone(), sums);
                    } else {
                        with_count!(sums.len() / (2 * BLOCK), N => dot::<T, S, N, 2>(
                            simd, block, source, range.clone(), sums,
                        ));
                    }
                }
            }
            let groups = parts.chunks_mut(TOGETHER * step).zip(factors.chunks(TOGETHER * 2 * BLOCK));
            for (local, (parts, sums)) in local.chunks_mut(TOGETHER * size).zip(groups) {
                let places = (node.first + first, size);
                with_count!(local.len() / size, N => backward_triangle::<T, N>(
                    block, (parts, rows, first), (local, places), sums,
                ));
            }
        }
    }
}

/// Takes the sums from the right-hand sides and solves with the transpose of a block's triangle.
#[inline(always)]
fn backward_triangle<T: Scalar, const N: usize>(
    block: Block<'_, T::Real>,
    (parts, rows, first): (&mut [T::Real], usize, usize),
    (local, (place, size)): (&mut [T], (usize, usize)),
    sums: &[T::Real],
) {
    let mut y: Rows<T::Real, N> = [[[T::Real::default(); N]; BLOCK]; 2];
    for n in 0..N {
        for k in 0..block.width {
            let sum = &sums[2 * (n * BLOCK + k)..][..2];
            let [re, im] = (local[n * size + place + k] - T::from_parts([sum[0], sum[1]])).parts();
            (y[0][k][n], y[1][k][n]) = (re, im);
        }
    }
    for j in (0..block.width).rev() {
        for i in j + 1..block.width {
            subtract::<T, N>(&mut y, j, block.at(i, j), i);
        }
    }
    for n in 0..N {
        for k in 0..block.width {
            let value = T::from_parts([y[0][k][n], y[1][k][n]]);
            local[n * size + place + k] = value;
            put(&mut parts[n * T::PARTS * rows..], rows, first + k, value);
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
        let mut totals = Totals { plus: [[zero; N]; C], minus: [[zero; N]; C], im: [[zero; N]; C] };
        let mut at = range.start;
        while at + lanes <= range.end {
            totals.add::<T, S>(simd, block, col, (parts, rows, first), at, Whole);
            at += lanes;
        }
        if at < range.end {
            totals.add::<T, S>(simd, block, col, (parts, rows, first), at, Part(range.end - at));
        }
        for c in 0..C.min(block.width - col) {
            for n in 0..N {
                let sum = &mut sums[2 * (n * BLOCK + col + c)..][..2];
                sum[0] += T::Real::sum(simd, totals.plus[c][n]);
                if T::PARTS == 2 {
                    sum[0] -= T::Real::sum(simd, totals.minus[c][n]);
                    sum[1] += T::Real::sum(simd, totals.im[c][n]);
                }
            }
        }
    }
}

/// Σ l re, Σ m im, which is to be taken from it, and Σ l im + m re, lane by lane.
struct Totals<V, const N: usize, const C: usize> {
    plus: [[V; N]; C],
    minus: [[V; N]; C],
    im: [[V; N]; C],
}

impl<V: Copy, const N: usize, const C: usize> Totals<V, N, C> {
    #[inline(always)]
    fn add<T: Scalar, S: Simd>(
        &mut self,
        simd: S,
        block: Block<'_, T::Real>,
        col: usize,
        (parts, rows, first): (&[T::Real], usize, usize),
        at: usize,
        with: impl Load,
    ) where
        T::Real: Real<Vector<S> = V>,
    {
        let place = |n: usize, part: usize| (n * T::PARTS + part) * rows + first + at;
        let x: [V; N] = std::array::from_fn(|n| with.load::<T::Real, S>(simd, &parts[place(n, 0)..]));
        let y: [V; N] =
            std::array::from_fn(|n| with.load::<T::Real, S>(simd, &parts[place(n, T::PARTS - 1)..]));
        for c in 0..C {
            // The last column again where there are fewer: those sums are not looked at.
            let column = (col + c).min(block.width - 1);
            let l = with.load::<T::Real, S>(simd, &block.part(column, 0)[at..]);
            if T::PARTS == 1 {
                for n in 0..N {
                    self.plus[c][n] = T::Real::mul_add(simd, l, x[n], self.plus[c][n]);
                }
                continue;
            }
            let m = with.load::<T::Real, S>(simd, &block.part(column, 1)[at..]);
            for n in 0..N {
                self.plus[c][n] = T::Real::mul_add(simd, l, x[n], self.plus[c][n]);
                self.minus[c][n] = T::Real::mul_add(simd, m, y[n], self.minus[c][n]);
                self.im[c][n] = T::Real::mul_add(simd, l, y[n], self.im[c][n]);
                self.im[c][n] = T::Real::mul_add(simd, m, x[n], self.im[c][n]);
            }
        }
    }
}
