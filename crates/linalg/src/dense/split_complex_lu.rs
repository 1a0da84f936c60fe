//! LU of a few dozen rows, real and imaginary parts apart: where the reduced models of one frequency spend their time.
//!
//! A column is its real parts, then its imaginary parts, each filled up to whole registers with zeros. Rows stay where they are: a pivot's row is struck off, not
//! exchanged, and L and U lie apart, each with zeros where the other one is. So every loop goes over whole columns. Columns right of a panel meet all of
//! its pivots at once: a register of theirs is loaded and stored once for [`PANEL`] of them.

use super::Matrix;
use crate::c64;
use pulp::{Arch, NullaryFnOnce, Simd, WithSimd};

/// Numbers of the widest register; rows are filled up to a multiple of it.
const REGISTER_NUMBERS: usize = 8;

/// Pivots of a panel.
const PANEL: usize = 4;

/// P A = L U, L with a diagonal of ones.
#[derive(Debug, Clone)]
pub(super) struct PlanarLu {
    dim: usize,
    /// Rows of a plane.
    rows: usize,
    /// Columns of U without the diagonal, then of L, from `start` on.
    columns: Vec<f64>,
    /// Where registers begin: one that lies across two lines of the cache is two.
    start: usize,
    /// The row of each pivot, and 1/u_kk.
    pivots: Vec<(usize, c64)>,
}

impl PlanarLu {
    /// By columns, with the largest entry of each column as its pivot (|re| + |im|). A pivot of zero makes values that are not finite.
    pub(super) fn new(a: &Matrix) -> Self {
        let dim = a.nrows();
        let mut lu = Self::room(dim);
        let rows = lu.rows;
        for (j, column) in lu.upper_mut().chunks_exact_mut((2 * rows).max(1)).enumerate() {
            let (re, im) = column.split_at_mut(rows);
            for ((re, im), a) in re.iter_mut().zip(im).zip(a.column(j)) {
                (*re, *im) = (a.re, a.im);
            }
        }
        lu.factorised()
    }

    /// The same of Σ θ_g S_g with real S_g, column after column; `None` where a value is not finite.
    pub(super) fn of_combination(dim: usize, parts: &[(c64, &[f64])]) -> Option<Self> {
        let mut lu = Self::room(dim);
        let rows = lu.rows;
        let sum = lu.upper_mut();
        Arch::new().dispatch(PlanarCombination { dim, rows, parts, sum }).then(|| lu.factorised())
    }

    /// Zeros in place of U, and room for L.
    fn room(dim: usize) -> Self {
        let rows = dim.next_multiple_of(REGISTER_NUMBERS);
        let columns = vec![0.0; 4 * rows * dim + REGISTER_NUMBERS];
        let start = columns.as_ptr().align_offset(REGISTER_NUMBERS * size_of::<f64>()).min(REGISTER_NUMBERS);
        Self { dim, rows, columns, start, pivots: Vec::with_capacity(dim) }
    }

    fn upper_mut(&mut self) -> &mut [f64] {
        &mut self.columns[self.start..][..2 * self.rows * self.dim]
    }

    fn factorised(mut self) -> Self {
        // 1 for the rows that had no pivot yet; and room for the sizes of entries.
        let mut left = vec![0.0; 2 * self.rows];
        left[..self.dim].fill(1.0);
        let (left, sizes) = left.split_at_mut(self.rows);
        Arch::new().dispatch(Factorise { lu: &mut self, left, sizes });
        self
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    /// Overwrites right-hand sides, column after column, with the solutions.
    pub(super) fn solve(&self, rhs: &mut [c64]) {
        let mut planes = vec![0.0; rhs.len() / self.dim.max(1) * 2 * self.rows];
        Arch::new().dispatch(Solve { lu: self, rhs, planes: &mut planes });
    }
}

/// Entry i of a column.
#[inline(always)]
fn entry(column: &[f64], i: usize) -> c64 {
    c64::new(column[i], column[column.len() / 2 + i])
}

/// Both planes of a column in registers.
#[inline(always)]
fn planes<S: Simd>(column: &[f64]) -> (&[S::f64s], &[S::f64s]) {
    let (re, im) = column.split_at(column.len() / 2);
    (S::as_simd_f64s(re).0, S::as_simd_f64s(im).0)
}

/// Both planes of a column in registers.
#[inline(always)]
fn planes_mut<S: Simd>(column: &mut [f64]) -> (&mut [S::f64s], &mut [S::f64s]) {
    let (re, im) = column.split_at_mut(column.len() / 2);
    (S::as_mut_simd_f64s(re).0, S::as_mut_simd_f64s(im).0)
}

/// column ← column − factor · other.
#[inline(always)]
fn subtract<S: Simd>(simd: S, column: &mut [f64], other: &[f64], factor: c64) {
    let (re, im) = planes_mut::<S>(column);
    let (other_re, other_im) = planes::<S>(other);
    let (a, b, minus_b) = splat(simd, factor);
    for (((re, im), &x), &y) in re.iter_mut().zip(im).zip(other_re).zip(other_im) {
        *re = simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, minus_b, *re));
        *im = simd.mul_add_e_f64s(x, b, simd.mul_add_e_f64s(y, a, *im));
    }
}

/// column ← column − Σ factors[k] · others[k].
#[inline(always)]
fn subtract_panel<S: Simd>(simd: S, column: &mut [f64], others: &[f64], factors: [c64; PANEL]) {
    let step = column.len();
    let (first, others) = others.split_at(step);
    let (second, others) = others.split_at(step);
    let (third, fourth) = others.split_at(step);
    let (re, im) = planes_mut::<S>(column);
    let (x0, y0) = planes::<S>(first);
    let (x1, y1) = planes::<S>(second);
    let (x2, y2) = planes::<S>(third);
    let (x3, y3) = planes::<S>(fourth);
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

/// −re, −im and im of a factor.
#[inline(always)]
fn splat<S: Simd>(simd: S, factor: c64) -> (S::f64s, S::f64s, S::f64s) {
    (simd.splat_f64s(-factor.re), simd.splat_f64s(-factor.im), simd.splat_f64s(factor.im))
}

/// Σ θ_g S_g, real and imaginary parts apart; whether all of it is finite.
struct PlanarCombination<'a> {
    dim: usize,
    rows: usize,
    parts: &'a [(c64, &'a [f64])],
    sum: &'a mut [f64],
}

impl NullaryFnOnce for PlanarCombination<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { dim, rows, parts, sum } = self;
        let mut finite = true;
        for (j, column) in sum.chunks_exact_mut((2 * rows).max(1)).enumerate() {
            let (re, im) = column.split_at_mut(rows);
            for (theta, matrix) in parts {
                let own = &matrix[j * dim..][..dim];
                for ((re, im), s) in re.iter_mut().zip(im.iter_mut()).zip(own) {
                    *re += theta.re * s;
                    *im += theta.im * s;
                }
            }
            // All of them are looked at: a loop without a way out goes by registers.
            for x in column {
                finite &= x.is_finite();
            }
        }
        finite
    }
}

struct Factorise<'a> {
    lu: &'a mut PlanarLu,
    left: &'a mut [f64],
    sizes: &'a mut [f64],
}

impl Factorise<'_> {
    /// The row of the largest entry among those that are left.
    #[inline(always)]
    fn pivot<S: Simd>(&mut self, simd: S, column: &[f64]) -> usize {
        let (re, im) = planes::<S>(column);
        let mut largest = simd.splat_f64s(0.0);
        let sizes = S::as_mut_simd_f64s(self.sizes).0;
        for (((&re, &im), &left), size) in re.iter().zip(im).zip(S::as_simd_f64s(self.left).0).zip(sizes) {
            *size = simd.mul_f64s(left, simd.add_f64s(simd.abs_f64s(re), simd.abs_f64s(im)));
            largest = simd.max_f64s(largest, *size);
        }
        let largest = simd.reduce_max_f64s(largest);
        let at = |(size, left): (&f64, &f64)| *size >= largest && *left > 0.0;
        // NaN is nowhere: whatever is taken then, nothing is finite.
        let found = self.sizes.iter().zip(&*self.left).position(at);
        found.or(self.left.iter().position(|&left| left > 0.0)).unwrap_or(0)
    }

    /// Finds the pivot of a column, and moves what is below it to L: its row.
    #[inline(always)]
    fn eliminate<S: Simd>(&mut self, simd: S, own: &mut [f64], multipliers: &mut [f64]) -> usize {
        let row = self.pivot(simd, own);
        let inverse = entry(own, row).inv();
        self.lu.pivots.push((row, inverse));
        self.left[row] = 0.0;
        own[row] = 0.0;
        own[self.lu.rows + row] = 0.0;
        let (re, im) = planes_mut::<S>(own);
        let (lower_re, lower_im) = planes_mut::<S>(multipliers);
        let (a, b, minus_b) = splat(simd, -inverse);
        let left = S::as_simd_f64s(self.left).0;
        for ((((re, im), lower_re), lower_im), &left) in
            re.iter_mut().zip(im).zip(lower_re).zip(lower_im).zip(left)
        {
            let (x, y) = (simd.mul_f64s(*re, left), simd.mul_f64s(*im, left));
            (*re, *im) = (simd.sub_f64s(*re, x), simd.sub_f64s(*im, y));
            *lower_re = simd.mul_add_e_f64s(x, a, simd.mul_f64s(y, minus_b));
            *lower_im = simd.mul_add_e_f64s(x, b, simd.mul_f64s(y, a));
        }
        row
    }
}

impl WithSimd for Factorise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let (n, step) = (self.lu.dim, 2 * self.lu.rows);
        let mut columns = std::mem::take(&mut self.lu.columns);
        let (upper, lower) = columns[self.lu.start..].split_at_mut(n * step);
        for first in (0..n).step_by(PANEL) {
            let end = (first + PANEL).min(n);
            let (panel, right) = upper[first * step..].split_at_mut((end - first) * step);
            for k in first..end {
                let (own, rest) = panel[(k - first) * step..].split_at_mut(step);
                let multipliers = &mut lower[k * step..][..step];
                let row = self.eliminate(simd, own, multipliers);
                for column in rest.chunks_exact_mut(step) {
                    let factor = entry(column, row);
                    subtract(simd, column, multipliers, factor);
                }
            }
            if end - first < PANEL {
                break;
            }
            let others = &lower[first * step..end * step];
            let [r0, r1, r2, r3] = [first, first + 1, first + 2, first + 3].map(|k| self.lu.pivots[k].0);
            // What the earlier pivots of the panel leave in the rows of the later ones.
            let (l0, l1, l2) = (&others[..step], &others[step..2 * step], &others[2 * step..3 * step]);
            let (l10, l20, l30) = (entry(l0, r1), entry(l0, r2), entry(l0, r3));
            let (l21, l31, l32) = (entry(l1, r2), entry(l1, r3), entry(l2, r3));
            for column in right.chunks_exact_mut(step) {
                let f0 = entry(column, r0);
                let f1 = entry(column, r1) - f0 * l10;
                let f2 = entry(column, r2) - f0 * l20 - f1 * l21;
                let f3 = entry(column, r3) - f0 * l30 - f1 * l31 - f2 * l32;
                subtract_panel(simd, column, others, [f0, f1, f2, f3]);
            }
        }
        self.lu.columns = columns;
    }
}

struct Solve<'a> {
    lu: &'a PlanarLu,
    rhs: &'a mut [c64],
    planes: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { lu, rhs, planes } = self;
        let (n, step) = (lu.dim, 2 * lu.rows);
        for (rhs, x) in rhs.chunks_exact(n).zip(planes.chunks_exact_mut(step)) {
            let (re, im) = x.split_at_mut(lu.rows);
            for ((re, im), b) in re.iter_mut().zip(im).zip(rhs) {
                (*re, *im) = (b.re, b.im);
            }
        }
        let (upper, lower) = lu.columns[lu.start..].split_at(n * step);
        // All right-hand sides together: one step waits for the one before.
        for (lower, &(row, _)) in lower.chunks_exact(step).zip(&lu.pivots) {
            for x in planes.chunks_exact_mut(step) {
                let factor = entry(x, row);
                subtract(simd, x, lower, factor);
            }
        }
        for (k, (upper, &(row, inverse))) in upper.chunks_exact(step).zip(&lu.pivots).enumerate().rev() {
            for (x, rhs) in planes.chunks_exact_mut(step).zip(rhs.chunks_exact_mut(n)) {
                rhs[k] = entry(x, row) * inverse;
                subtract(simd, x, upper, rhs[k]);
            }
        }
    }
}
