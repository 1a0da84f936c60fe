//! A x = b of a symmetric A, real and imaginary parts apart: where the reduced models of one frequency spend their time.
//!
//! A column is its real parts, then its imaginary parts, each filled up to whole registers with zeros. Of the lower triangle each column is met from the register on in
//! which it begins. The columns that are left meet [`PANEL`] pivots at once: a register of theirs is loaded and stored once for all of them. The diagonal alone is
//! brought up to date with each pivot, so that the next one is found without the rest.

use super::{Matrix, NoConvergence};
use crate::c64;
use pulp::{Arch, Simd, WithSimd};

/// Numbers of the widest register; rows are filled up to a multiple of it.
const REGISTER_NUMBERS: usize = 8;

/// Pivots of a panel; one more where the last one is of two rows.
const PANEL: usize = 4;

/// (1 + √17)/8: a diagonal entry is a pivot of its own where no other entry of its column is larger than it over this. Entries then grow least.
const PIVOT_RATIO: f64 = 0.640_388_203_202_208_4;

/// Pᵀ A P = L D Lᵀ of a complex A = Aᵀ, L with a diagonal of ones, D of one and two rows.
///
/// A diagonal entry is a pivot by itself where it is not much smaller than the rest of its column: the next one if it is so, otherwise the largest. Where that one is not,
/// rows are gone through until an entry is the largest of its row and of its column, and both rows are one pivot.
///
/// # Source
/// C. Ashcraft, R. G. Grimes, J. G. Lewis, SIAM J. Matrix Anal. Appl. 20 (1998) 513–561 (the largest entry of its row and column); J. R. Bunch, L. Kaufman,
/// Math. Comp. 31 (1977) 163–179 (pivots of two rows).
#[derive(Debug, Clone)]
pub struct Ldlt {
    dim: usize,
    /// Rows of a plane.
    rows: usize,
    /// Columns of L without the diagonal, from `start` on.
    columns: Vec<f64>,
    /// Where registers begin: one that lies across two lines of the cache is two.
    start: usize,
    /// Where each panel ends.
    ends: Vec<usize>,
    /// With which row each one was exchanged, before the columns of its panel were used.
    exchanged: Vec<usize>,
    inverses: Vec<Inverse>,
}

/// What D⁻¹ has of a pivot.
#[derive(Debug, Clone)]
enum Inverse {
    One(c64),
    /// On the diagonal, and beside it.
    Two([c64; 2], c64),
}

impl Ldlt {
    /// Factorises A, of which the lower triangle is read.
    ///
    /// # Errors
    /// [`NoConvergence`] where A has values that are not finite.
    ///
    /// # Panics
    /// Where A is not square.
    pub fn new(a: &Matrix) -> Result<Self, NoConvergence> {
        assert_eq!(a.nrows(), a.ncols());
        let mut ldlt = Self::room(a.nrows());
        let rows = ldlt.rows;
        for (j, column) in ldlt.columns_mut().chunks_exact_mut((2 * rows).max(1)).enumerate() {
            let (re, im) = column.split_at_mut(rows);
            for ((re, im), a) in re.iter_mut().zip(im).zip(a.column(j)).skip(j) {
                (*re, *im) = (a.re, a.im);
            }
        }
        let is_finite = ldlt.columns.iter().all(|x| x.is_finite());
        if is_finite { Ok(ldlt.factorised()) } else { Err(NoConvergence) }
    }

    /// Factorises Σ θ_g S_g of real symmetric n × n matrices, column after column, of which the lower triangles are read.
    ///
    /// # Errors
    /// [`NoConvergence`] where the sum has values that are not finite.
    ///
    /// # Panics
    /// Where a matrix is of another size.
    pub fn of_combination(dim: usize, parts: &[(c64, &[f64])]) -> Result<Self, NoConvergence> {
        assert!(parts.iter().all(|(_, matrix)| matrix.len() == dim * dim));
        let mut ldlt = Self::room(dim);
        let rows = ldlt.rows;
        let sum = Combination { dim, rows, parts, sum: ldlt.columns_mut() };
        if Arch::new().dispatch(sum) { Ok(ldlt.factorised()) } else { Err(NoConvergence) }
    }

    /// Zeros in place of L.
    fn room(dim: usize) -> Self {
        let rows = dim.next_multiple_of(REGISTER_NUMBERS);
        let columns = vec![0.0; 2 * rows * dim + REGISTER_NUMBERS];
        let start = columns.as_ptr().align_offset(REGISTER_NUMBERS * size_of::<f64>()).min(REGISTER_NUMBERS);
        let (ends, exchanged, inverses) =
            (Vec::with_capacity(dim.div_ceil(PANEL)), Vec::with_capacity(dim), Vec::with_capacity(dim));
        Self { dim, rows, columns, start, ends, exchanged, inverses }
    }

    fn columns_mut(&mut self) -> &mut [f64] {
        &mut self.columns[self.start..][..2 * self.rows * self.dim]
    }

    fn factorised(mut self) -> Self {
        let step = 2 * self.rows;
        let mut room = vec![0.0; (3 + PANEL + 1) * step];
        let (diagonal, room) = room.split_at_mut(step);
        for (j, column) in self.columns_mut().chunks_exact(step.max(1)).enumerate() {
            set(diagonal, j, entry(column, j));
        }
        let (own, room) = room.split_at_mut(step);
        let (other, weights) = room.split_at_mut(step);
        Arch::new().dispatch(Factorise { ldlt: &mut self, diagonal, own, other, weights });
        self
    }

    /// Number of unknowns n.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Overwrites k right-hand sides (n × k, column after column) with the solutions of A X = B.
    ///
    /// # Errors
    /// [`NoConvergence`] where B has values that are not finite, or A is singular to the last bit.
    ///
    /// # Panics
    /// Where the length of B is not a multiple of n.
    ///
    /// # Limits
    /// A nearly singular matrix gives a solution of small residual and unknown error.
    pub fn solve(&self, rhs: &mut [c64]) -> Result<(), NoConvergence> {
        if self.dim == 0 {
            return Ok(());
        }
        assert_eq!(rhs.len() % self.dim, 0, "whole right-hand sides");
        let mut planes = vec![0.0; rhs.len() / self.dim * 2 * self.rows];
        Arch::new().dispatch(Solve { ldlt: self, rhs, planes: &mut planes });
        if rhs.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(NoConvergence) }
    }
}

/// Entry i of a column.
#[inline(always)]
fn entry(column: &[f64], i: usize) -> c64 {
    c64::new(column[i], column[column.len() / 2 + i])
}

#[inline(always)]
fn set(column: &mut [f64], i: usize, value: c64) {
    let rows = column.len() / 2;
    (column[i], column[rows + i]) = (value.re, value.im);
}

/// Exchanges two entries of a column.
#[inline(always)]
fn exchange(column: &mut [f64], i: usize, j: usize) {
    let rows = column.len() / 2;
    column.swap(i, j);
    column.swap(rows + i, rows + j);
}

/// The first row of the register in which a row is.
#[inline(always)]
fn register(row: usize) -> usize {
    row / REGISTER_NUMBERS * REGISTER_NUMBERS
}

/// Both planes of a column in registers, from a row on that begins one.
#[inline(always)]
fn planes<S: Simd>(column: &[f64], from: usize) -> (&[S::f64s], &[S::f64s]) {
    let (re, im) = column.split_at(column.len() / 2);
    (S::as_simd_f64s(&re[from..]).0, S::as_simd_f64s(&im[from..]).0)
}

/// The same.
#[inline(always)]
fn planes_mut<S: Simd>(column: &mut [f64], from: usize) -> (&mut [S::f64s], &mut [S::f64s]) {
    let (re, im) = column.split_at_mut(column.len() / 2);
    (S::as_mut_simd_f64s(&mut re[from..]).0, S::as_mut_simd_f64s(&mut im[from..]).0)
}

/// column ← column − factor · other, from a row on.
#[inline(always)]
fn subtract<S: Simd>(simd: S, column: &mut [f64], other: &[f64], factor: c64, from: usize) {
    let (re, im) = planes_mut::<S>(column, from);
    let (other_re, other_im) = planes::<S>(other, from);
    let (a, b, minus_b) = splat(simd, factor);
    for (((re, im), &x), &y) in re.iter_mut().zip(im).zip(other_re).zip(other_im) {
        *re = simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, minus_b, *re));
        *im = simd.mul_add_e_f64s(x, b, simd.mul_add_e_f64s(y, a, *im));
    }
}

/// column ← column − Σ factors[k] · others[k], from a row on.
#[inline(always)]
fn subtract_panel<S: Simd>(simd: S, column: &mut [f64], others: &[f64], factors: [c64; PANEL], from: usize) {
    let step = column.len();
    let (first, others) = others.split_at(step);
    let (second, others) = others.split_at(step);
    let (third, fourth) = others.split_at(step);
    let (re, im) = planes_mut::<S>(column, from);
    let (x0, y0) = planes::<S>(first, from);
    let (x1, y1) = planes::<S>(second, from);
    let (x2, y2) = planes::<S>(third, from);
    let (x3, y3) = planes::<S>(&fourth[..step], from);
    let (a0, b0, c0) = splat(simd, factors[0]);
    let (a1, b1, c1) = splat(simd, factors[1]);
    let (a2, b2, c2) = splat(simd, factors[2]);
    let (a3, b3, c3) = splat(simd, factors[3]);
    let planes = x0.iter().zip(y0).zip(x1).zip(y1).zip(x2).zip(y2).zip(x3).zip(y3);
    for ((re, im), (((((((&x0, &y0), &x1), &y1), &x2), &y2), &x3), &y3)) in re.iter_mut().zip(im).zip(planes)
    {
        // Two sums each, so that one product need not wait for the one before.
        let re0 = simd.mul_add_e_f64s(x0, a0, simd.mul_add_e_f64s(y0, c0, *re));
        let im0 = simd.mul_add_e_f64s(x0, b0, simd.mul_add_e_f64s(y0, a0, *im));
        let re1 = simd.mul_add_e_f64s(x1, a1, simd.mul_f64s(y1, c1));
        let im1 = simd.mul_add_e_f64s(x1, b1, simd.mul_f64s(y1, a1));
        let re0 = simd.mul_add_e_f64s(x2, a2, simd.mul_add_e_f64s(y2, c2, re0));
        let im0 = simd.mul_add_e_f64s(x2, b2, simd.mul_add_e_f64s(y2, a2, im0));
        let re1 = simd.mul_add_e_f64s(x3, a3, simd.mul_add_e_f64s(y3, c3, re1));
        let im1 = simd.mul_add_e_f64s(x3, b3, simd.mul_add_e_f64s(y3, a3, im1));
        (*re, *im) = (simd.add_f64s(re0, re1), simd.add_f64s(im0, im1));
    }
}

/// Σ a_i b_i from a row on.
#[inline(always)]
fn product<S: Simd>(simd: S, a: &[f64], b: &[f64], from: usize) -> c64 {
    let ((a_re, a_im), (b_re, b_im)) = (planes::<S>(a, from), planes::<S>(b, from));
    let zero = simd.splat_f64s(0.0);
    let [mut squares, mut minus, mut one, mut other] = [zero; 4];
    for (((&a, &b), &x), &y) in a_re.iter().zip(a_im).zip(b_re).zip(b_im) {
        squares = simd.mul_add_e_f64s(a, x, squares);
        minus = simd.mul_add_e_f64s(b, y, minus);
        one = simd.mul_add_e_f64s(a, y, one);
        other = simd.mul_add_e_f64s(b, x, other);
    }
    let sum = |one, other| simd.reduce_sum_f64s(simd.add_f64s(one, other));
    c64::new(simd.reduce_sum_f64s(simd.sub_f64s(squares, minus)), sum(one, other))
}

/// −re, −im and im of a factor.
#[inline(always)]
fn splat<S: Simd>(simd: S, factor: c64) -> (S::f64s, S::f64s, S::f64s) {
    (simd.splat_f64s(-factor.re), simd.splat_f64s(-factor.im), simd.splat_f64s(factor.im))
}

/// The largest entry from a row on, |re| + |im|.
#[inline(always)]
fn largest<S: Simd>(simd: S, column: &[f64], from: usize) -> f64 {
    let (re, im) = planes::<S>(column, register(from));
    let mut largest = simd.splat_f64s(0.0);
    for (&re, &im) in re.iter().zip(im) {
        largest = simd.max_f64s(largest, simd.add_f64s(simd.abs_f64s(re), simd.abs_f64s(im)));
    }
    simd.reduce_max_f64s(largest)
}

/// Where that is. NaN is nowhere: whatever is taken then, nothing is finite.
fn position(column: &[f64], from: usize, largest: f64) -> usize {
    let (re, im) = column.split_at(column.len() / 2);
    let mut sizes = re[from..].iter().zip(&im[from..]).map(|(re, im)| re.abs() + im.abs());
    from + sizes.position(|size| size >= largest).unwrap_or(0)
}

/// |re| + |im|.
fn size(value: c64) -> f64 {
    value.re.abs() + value.im.abs()
}

/// Σ θ_g S_g, real and imaginary parts apart, of the lower triangle; whether all of it is finite.
struct Combination<'a> {
    dim: usize,
    rows: usize,
    parts: &'a [(c64, &'a [f64])],
    sum: &'a mut [f64],
}

impl WithSimd for Combination<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { dim, rows, parts, sum } = self;
        let mut finite = true;
        for (j, column) in sum.chunks_exact_mut((2 * rows).max(1)).enumerate() {
            let (re, im) = column.split_at_mut(rows);
            let from = register(j);
            let (re, im) = (&mut re[from..dim], &mut im[from..dim]);
            for (theta, matrix) in parts {
                let own = &matrix[j * dim..][from..dim];
                for ((re, im), s) in re.iter_mut().zip(im.iter_mut()).zip(own) {
                    *re += theta.re * s;
                    *im += theta.im * s;
                }
            }
            // All of them are looked at: a loop without a way out goes by registers.
            for (re, im) in re.iter().zip(&*im) {
                finite &= re.is_finite() & im.is_finite();
            }
        }
        finite
    }
}

struct Factorise<'a> {
    ldlt: &'a mut Ldlt,
    /// What is left of the diagonal, up to date; zero where there was a pivot.
    diagonal: &'a mut [f64],
    /// Columns that were brought up to date.
    own: &'a mut [f64],
    other: &'a mut [f64],
    /// L D of the pivots that the columns have not met.
    weights: &'a mut [f64],
}

/// The next pivot: the row of one, or of two.
enum Pivot {
    One(usize),
    Two(usize, usize),
}

impl Factorise<'_> {
    /// Brings the column of a row up to date, with the pivots from `first` to `k` that it has not met: zero in rows above k and on the diagonal. The largest
    /// entry.
    #[inline(always)]
    fn column<S: Simd>(&mut self, simd: S, columns: &[f64], [first, k]: [usize; 2], row: usize) -> f64 {
        let (rows, step) = (self.ldlt.rows, 2 * self.ldlt.rows);
        let of = |i: usize| &columns[i * step..][..step];
        let from = register(k);
        for i in k..row {
            set(self.own, i, entry(of(i), row));
        }
        let below = row + 1;
        self.own[below..rows].copy_from_slice(&of(row)[below..rows]);
        self.own[rows + below..].copy_from_slice(&of(row)[rows + below..]);
        for (p, weight) in (first..k).zip(self.weights.chunks_exact(step)) {
            subtract(simd, self.own, of(p), entry(weight, row), from);
        }
        for i in (from..k).chain([row]) {
            set(self.own, i, c64::default());
        }
        largest(simd, self.own, from)
    }

    /// Finds the next pivot, with its columns in `own` and `other`.
    #[inline(always)]
    fn pivot<S: Simd>(&mut self, simd: S, columns: &[f64], [first, k]: [usize; 2]) -> Pivot {
        // The next one as it comes spares the exchange.
        let beside = self.column(simd, columns, [first, k], k);
        let is_small = PIVOT_RATIO * beside > size(entry(self.diagonal, k));
        if !is_small {
            return Pivot::One(k);
        }
        let most = largest(simd, self.diagonal, k);
        let mut row = position(self.diagonal, k, most);
        let mut beside = if row == k { beside } else { self.column(simd, columns, [first, k], row) };
        loop {
            let is_small = PIVOT_RATIO * beside > size(entry(self.diagonal, row));
            if !is_small {
                return Pivot::One(row);
            }
            let next = position(self.own, k, beside);
            std::mem::swap(&mut self.own, &mut self.other);
            let there = self.column(simd, columns, [first, k], next);
            let is_larger = there > beside;
            if !is_larger {
                std::mem::swap(&mut self.own, &mut self.other);
                return Pivot::Two(row, next);
            }
            (row, beside) = (next, there);
        }
    }

    /// Exchanges rows k and `row` of what is left. The columns of the pivot itself are in `own` and `other`: those that they had are no longer used.
    #[inline(always)]
    fn exchange(&mut self, columns: &mut [f64], [first, k]: [usize; 2], row: usize) {
        self.ldlt.exchanged.push(row);
        if row == k {
            return;
        }
        let (rows, step) = (self.ldlt.rows, 2 * self.ldlt.rows);
        let (done, left) = columns.split_at_mut(k * step);
        let (own, right) = left.split_at_mut(step);
        for i in k + 1..row {
            set(&mut right[(i - k - 1) * step..][..step], row, entry(own, i));
        }
        let other = &mut right[(row - k - 1) * step..][..step];
        let below = row + 1;
        other[below..rows].copy_from_slice(&own[below..rows]);
        other[rows + below..].copy_from_slice(&own[rows + below..]);
        let panel = done[first * step..].chunks_exact_mut(step);
        let weights = self.weights.chunks_exact_mut(step).take(k - first);
        panel.chain(weights).for_each(|column| exchange(column, k, row));
        exchange(self.diagonal, k, row);
        exchange(self.own, k, row);
        exchange(self.other, k, row);
    }

    /// A pivot of one row at k.
    #[inline(always)]
    fn eliminate_one<S: Simd>(&mut self, simd: S, columns: &mut [f64], [first, k]: [usize; 2]) {
        let step = 2 * self.ldlt.rows;
        let inverse = entry(self.diagonal, k).inv();
        self.ldlt.inverses.push(Inverse::One(inverse));
        set(self.diagonal, k, c64::default());
        set(self.own, k, c64::default());
        let from = register(k);
        let column = &mut columns[k * step..][..step];
        let (re, im) = planes_mut::<S>(column, from);
        let (own_re, own_im) = planes::<S>(self.own, from);
        let (d_re, d_im) = planes_mut::<S>(self.diagonal, from);
        let (a, b, minus_b) = splat(simd, -inverse);
        for (((((re, im), &x), &y), d_re), d_im) in
            re.iter_mut().zip(im).zip(own_re).zip(own_im).zip(d_re).zip(d_im)
        {
            *re = simd.mul_add_e_f64s(x, a, simd.mul_f64s(y, minus_b));
            *im = simd.mul_add_e_f64s(x, b, simd.mul_f64s(y, a));
            let square_re = simd.sub_f64s(simd.mul_f64s(x, *re), simd.mul_f64s(y, *im));
            let square_im = simd.mul_add_e_f64s(x, *im, simd.mul_f64s(y, *re));
            (*d_re, *d_im) = (simd.sub_f64s(*d_re, square_re), simd.sub_f64s(*d_im, square_im));
        }
        self.weights[(k - first) * step..][..step].copy_from_slice(self.own);
    }

    /// A pivot of two rows at k and k + 1.
    #[inline(always)]
    fn eliminate_two(&mut self, columns: &mut [f64], [first, k]: [usize; 2]) {
        let (n, step) = (self.ldlt.dim, 2 * self.ldlt.rows);
        let (a, b) = (entry(self.diagonal, k), entry(self.diagonal, k + 1));
        let beside = entry(self.own, k + 1);
        // Divided by what is beside the diagonal, which is larger: nothing overflows.
        let (a, b) = (a / beside, b / beside);
        let scale = ((a * b - 1.0) * beside).inv();
        let (inverse_a, inverse_b, inverse_beside) = (b * scale, a * scale, -scale);
        self.ldlt.inverses.push(Inverse::Two([inverse_a, inverse_b], inverse_beside));
        for column in [&mut *self.diagonal, &mut *self.own, &mut *self.other] {
            [k, k + 1].into_iter().for_each(|i| set(column, i, c64::default()));
        }
        let (one, two) = columns[k * step..][..2 * step].split_at_mut(step);
        for i in register(k)..n {
            let (x, y) = (entry(self.own, i), entry(self.other, i));
            let (l, m) = (x * inverse_a + y * inverse_beside, x * inverse_beside + y * inverse_b);
            set(one, i, l);
            set(two, i, m);
            let left = entry(self.diagonal, i) - l * x - m * y;
            set(self.diagonal, i, left);
        }
        self.weights[(k - first) * step..][..step].copy_from_slice(self.own);
        self.weights[(k + 1 - first) * step..][..step].copy_from_slice(self.other);
    }

    /// What is left meets the pivots from `first` to `end`.
    #[inline(always)]
    fn update<S: Simd>(&self, simd: S, columns: &mut [f64], [first, end]: [usize; 2]) {
        let step = 2 * self.ldlt.rows;
        let (done, left) = columns.split_at_mut(end * step);
        let panel = &done[first * step..];
        let count = end - first;
        for (j, column) in (end..).zip(left.chunks_exact_mut(step)) {
            let from = register(j + 1);
            let factor = |p: usize| entry(&self.weights[p * step..][..step], j);
            let together = count / PANEL * PANEL;
            if together == PANEL {
                subtract_panel(simd, column, panel, std::array::from_fn(factor), from);
            }
            for p in together..count {
                subtract(simd, column, &panel[p * step..][..step], factor(p), from);
            }
        }
    }
}

impl WithSimd for Factorise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let (n, start) = (self.ldlt.dim, self.ldlt.start);
        let mut all = std::mem::take(&mut self.ldlt.columns);
        let columns = &mut all[start..][..n * 2 * self.ldlt.rows];
        let mut first = 0;
        while first < n {
            let mut k = first;
            while k < n && k - first < PANEL {
                match self.pivot(simd, columns, [first, k]) {
                    Pivot::One(row) => {
                        self.exchange(columns, [first, k], row);
                        self.eliminate_one(simd, columns, [first, k]);
                        k += 1;
                    }
                    Pivot::Two(row, other) => {
                        self.exchange(columns, [first, k], row);
                        // What was in row k is where the first of them was.
                        let other = if other == k { row } else { other };
                        self.exchange(columns, [first, k + 1], other);
                        self.eliminate_two(columns, [first, k]);
                        k += 2;
                    }
                }
            }
            self.update(simd, columns, [first, k]);
            self.ldlt.ends.push(k);
            first = k;
        }
        self.ldlt.columns = all;
    }
}

struct Solve<'a> {
    ldlt: &'a Ldlt,
    rhs: &'a mut [c64],
    planes: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { ldlt, rhs, planes } = self;
        let (n, step) = (ldlt.dim, 2 * ldlt.rows);
        for (rhs, x) in rhs.chunks_exact(n).zip(planes.chunks_exact_mut(step)) {
            let (re, im) = x.split_at_mut(ldlt.rows);
            for ((re, im), b) in re.iter_mut().zip(im).zip(rhs) {
                (*re, *im) = (b.re, b.im);
            }
        }
        let lower = |k: usize| &ldlt.columns[ldlt.start + k * step..][..step];
        let panels = || std::iter::once(0).chain(ldlt.ends.iter().copied()).zip(ldlt.ends.iter().copied());
        // All right-hand sides together: one step waits for the one before.
        for (first, end) in panels() {
            for x in planes.chunks_exact_mut(step) {
                (first..end).for_each(|k| exchange(x, k, ldlt.exchanged[k]));
            }
            for k in first..end {
                for x in planes.chunks_exact_mut(step) {
                    let factor = entry(x, k);
                    subtract(simd, x, lower(k), factor, register(k));
                }
            }
        }
        for x in planes.chunks_exact_mut(step) {
            let mut k = 0;
            for inverse in &ldlt.inverses {
                let value = entry(x, k);
                match *inverse {
                    Inverse::One(inverse) => {
                        set(x, k, value * inverse);
                        k += 1;
                    }
                    Inverse::Two([own, other], beside) => {
                        let next = entry(x, k + 1);
                        set(x, k, value * own + next * beside);
                        set(x, k + 1, value * beside + next * other);
                        k += 2;
                    }
                }
            }
        }
        let backwards: Vec<(usize, usize)> = panels().collect();
        for &(first, end) in backwards.iter().rev() {
            for k in (first..end).rev() {
                for x in planes.chunks_exact_mut(step) {
                    let value = entry(x, k) - product(simd, lower(k), x, register(k));
                    set(x, k, value);
                }
            }
            for x in planes.chunks_exact_mut(step) {
                (first..end).rev().for_each(|k| exchange(x, k, ldlt.exchanged[k]));
            }
        }
        for (rhs, x) in rhs.chunks_exact_mut(n).zip(planes.chunks_exact(step)) {
            rhs.iter_mut().enumerate().for_each(|(i, rhs)| *rhs = entry(x, i));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::combination;
    use super::*;

    /// Symmetric entries of no pattern. With a diagonal of `diagonal` times these: zero makes every pivot one of two rows.
    fn matrix(n: usize, diagonal: f64) -> Matrix {
        let part = |k: usize| ((k * k + 3 * k) as f64 * 0.618_034).fract() - 0.5;
        Matrix::from_fn(n, n, |i, j| {
            let k = 1 + i.max(j) * n + i.min(j);
            c64::new(part(k), part(7 * k)) * if i == j { diagonal } else { 1.0 }
        })
    }

    /// The largest entry of b − A x over ‖A‖‖x‖: a few roundoffs of a stable factorisation.
    fn residual(a: &Matrix, x: &[c64], b: &[c64]) -> f64 {
        let n = a.nrows();
        let row = |i: usize| (0..n).map(|j| a[(i, j)].norm()).sum::<f64>();
        let of_a = (0..n).map(row).fold(0.0, f64::max);
        let most = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, f64::max);
        let of_x = most(&mut x.iter().map(|x| x.norm()));
        most(&mut a.multiply(x).iter().zip(b).map(|(a, b)| (a - b).norm())) / (of_a * of_x)
    }

    fn rhs(n: usize) -> Vec<c64> {
        (0..3 * n).map(|k| c64::new((k % 7) as f64 - 2.0, 1.0 - (k % 5) as f64)).collect()
    }

    #[test]
    fn solutions_solve_whatever_the_diagonal() {
        for n in (0..40).chain([63, 64, 65, 100, 129]) {
            for diagonal in [1.0, 0.0, 1e-3, 30.0] {
                if n == 1 && diagonal == 0.0 {
                    continue; // singular
                }
                let a = matrix(n, diagonal);
                let ldlt = Ldlt::new(&a).unwrap();
                let (b, mut x) = (rhs(n), rhs(n));
                ldlt.solve(&mut x).unwrap();
                for (x, b) in x.chunks_exact(n.max(1)).zip(b.chunks_exact(n.max(1))) {
                    let off = residual(&a, x, b);
                    assert!(off < 1e-15 * (4 + n) as f64, "{n} {diagonal}: {off}");
                }
                let two = ldlt.inverses.iter().filter(|one| matches!(one, Inverse::Two(..))).count();
                assert_eq!((ldlt.dim(), ldlt.inverses.len() + two), (n, n));
                // Of entries up to half a diagonal thirty times as large needs no pair, and one of zeros begins with one.
                assert!(diagonal != 30.0 || two == 0 || n > 30, "{n}: {two}");
                assert!(diagonal != 0.0 || n == 0 || two > 0, "{n}: {two}");
            }
        }
    }

    #[test]
    fn a_combination_is_factorised_as_its_sum() {
        let theta = [c64::new(0.5, 2.0), c64::new(-1.0, 0.25)];
        for n in [0, 1, 5, 8, 50, 131] {
            let (a, b) = (matrix(n, 1.0), matrix(n, 0.1));
            let part = |of: &Matrix, k: usize| -> Vec<f64> {
                (0..n * n).map(|at| [of[(at % n, at / n)].re, of[(at % n, at / n)].im][k]).collect()
            };
            let (a, b) = (part(&a, 0), part(&b, 1));
            let parts = [(theta[0], a.as_slice()), (theta[1], b.as_slice())];
            let (rhs, mut x) = (rhs(n), rhs(n));
            Ldlt::of_combination(n, &parts).unwrap().solve(&mut x).unwrap();
            let sum = combination(n, n, &parts);
            let mut of_sum = rhs;
            Ldlt::new(&sum).unwrap().solve(&mut of_sum).unwrap();
            assert_eq!(x, of_sum);
        }
        let infinite = [(theta[0], &[f64::INFINITY, 0.0, 0.0, 1.0][..])];
        assert!(Ldlt::of_combination(2, &infinite).is_err());
    }

    #[test]
    fn singular_and_infinite_matrices_are_said_to_be_so() {
        for n in [1, 2, 5, 70] {
            let mut a = matrix(n, 1.0);
            (0..n).for_each(|i| (a[(i, n - 1)], a[(n - 1, i)]) = (c64::default(), c64::default()));
            let singular =
                |a: &Matrix| Ldlt::new(a).and_then(|ldlt| ldlt.solve(&mut vec![c64::new(1.0, 0.0); n]));
            assert_eq!(singular(&a), Err(NoConvergence), "{n}");
            assert_eq!(singular(&Matrix::zeros(n, n)), Err(NoConvergence), "{n}");
            a[(n - 1, 0)] = c64::new(f64::NAN, 0.0);
            assert!(Ldlt::new(&a).is_err());
            // Values that overflow on the way.
            let large = matrix(n, 1.0);
            let large = Matrix::from_fn(n, n, |i, j| large[(i, j)] * 1e308);
            let _either = singular(&large);
        }
    }
}
