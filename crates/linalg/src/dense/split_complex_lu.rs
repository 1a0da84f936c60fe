//! LU of a few dozen rows, real and imaginary parts apart: where the reduced models of one frequency spend their time.
//!
//! A column is its real parts, then its imaginary parts, each filled up to whole registers with zeros. Rows stay where they are: a pivot's row is struck off, not
//! exchanged, and L and U lie apart, each with zeros where the other one is. So every loop goes over whole columns.

use super::Matrix;
use crate::c64;
use pulp::{Arch, Simd, WithSimd};

/// Numbers of the widest register; rows are filled up to a multiple of it.
const REGISTER_NUMBERS: usize = 8;

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
        let rows = dim.next_multiple_of(REGISTER_NUMBERS);
        let mut columns = vec![0.0; 4 * rows * dim + REGISTER_NUMBERS];
        let start = columns.as_ptr().align_offset(REGISTER_NUMBERS * size_of::<f64>()).min(REGISTER_NUMBERS);
        for (j, column) in columns[start..].chunks_exact_mut((2 * rows).max(1)).take(dim).enumerate() {
            let (re, im) = column.split_at_mut(rows);
            for ((re, im), a) in re.iter_mut().zip(im).zip(a.column(j)) {
                (*re, *im) = (a.re, a.im);
            }
        }
        let mut lu = Self { dim, rows, columns, start, pivots: Vec::with_capacity(dim) };
        // 1 for the rows that had no pivot yet; and room for the sizes of entries.
        let mut left = vec![0.0; 2 * rows];
        left[..dim].fill(1.0);
        let (left, sizes) = left.split_at_mut(rows);
        Arch::new().dispatch(Factorise { lu: &mut lu, left, sizes });
        lu
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
    let (a, b) = (simd.splat_f64s(-factor.re), simd.splat_f64s(-factor.im));
    let minus_b = simd.splat_f64s(factor.im);
    for (((re, im), &x), &y) in re.iter_mut().zip(im).zip(other_re).zip(other_im) {
        *re = simd.mul_add_e_f64s(x, a, simd.mul_add_e_f64s(y, minus_b, *re));
        *im = simd.mul_add_e_f64s(x, b, simd.mul_add_e_f64s(y, a, *im));
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
}

impl WithSimd for Factorise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let (n, step) = (self.lu.dim, 2 * self.lu.rows);
        let mut columns = std::mem::take(&mut self.lu.columns);
        let (upper, lower) = columns[self.lu.start..].split_at_mut(n * step);
        for k in 0..n {
            let (own, right) = upper[k * step..].split_at_mut(step);
            let row = self.pivot(simd, own);
            let inverse = entry(own, row).inv();
            self.lu.pivots.push((row, inverse));
            self.left[row] = 0.0;
            own[row] = 0.0;
            own[step / 2 + row] = 0.0;
            let multipliers = &mut lower[k * step..][..step];
            let (re, im) = planes_mut::<S>(own);
            let (lower_re, lower_im) = planes_mut::<S>(multipliers);
            let (a, b, minus_b) =
                (simd.splat_f64s(inverse.re), simd.splat_f64s(inverse.im), simd.splat_f64s(-inverse.im));
            let left = S::as_simd_f64s(self.left).0;
            for ((((re, im), lower_re), lower_im), &left) in
                re.iter_mut().zip(im).zip(lower_re).zip(lower_im).zip(left)
            {
                let (x, y) = (simd.mul_f64s(*re, left), simd.mul_f64s(*im, left));
                (*re, *im) = (simd.sub_f64s(*re, x), simd.sub_f64s(*im, y));
                *lower_re = simd.mul_add_e_f64s(x, a, simd.mul_f64s(y, minus_b));
                *lower_im = simd.mul_add_e_f64s(x, b, simd.mul_f64s(y, a));
            }
            for column in right.chunks_exact_mut(step) {
                let factor = entry(column, row);
                subtract(simd, column, multipliers, factor);
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
