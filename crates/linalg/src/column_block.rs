//! A few long real vectors as one matrix: products in blocks, at the speed of dense kernels.

use crate::c64;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

/// N × r, N ≫ r, column after column; grows by columns.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnBlock {
    nrows: usize,
    values: Vec<f64>,
}

impl ColumnBlock {
    /// N × 0.
    pub fn new(nrows: usize) -> Self {
        Self { nrows, values: Vec::new() }
    }

    /// From its columns, one after the other.
    ///
    /// # Panics
    /// Where they are not whole columns of N entries.
    pub fn from_columns(nrows: usize, values: Vec<f64>) -> Self {
        assert_eq!(values.len() % nrows.max(1), 0, "whole columns");
        Self { nrows, values }
    }

    /// N.
    pub fn nrows(&self) -> usize {
        self.nrows
    }

    /// r.
    pub fn ncols(&self) -> usize {
        self.values.len() / self.nrows.max(1)
    }

    /// Column j.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.values[j * self.nrows..(j + 1) * self.nrows]
    }

    /// Some columns, one after the other.
    pub fn columns(&self, range: std::ops::Range<usize>) -> &[f64] {
        &self.values[range.start * self.nrows..range.end * self.nrows]
    }

    /// One more column.
    ///
    /// # Panics
    /// Where it has not N entries.
    pub fn push(&mut self, column: &[f64]) {
        assert_eq!(column.len(), self.nrows);
        self.values.extend_from_slice(column);
    }

    /// Vᵀ X, r × k column after column, for X N × k.
    pub fn transpose_times(&self, x: &[f64]) -> Vec<f64> {
        transpose_product(&self.values, self.nrows, x)
    }

    /// X ← X − V C for C r × k and X N × k.
    pub fn subtract_times(&self, c: &[f64], x: &mut [f64]) {
        let (r, k) = (self.ncols(), x.len() / self.nrows.max(1));
        let c = MatRef::from_column_major_slice(c, r, k);
        let x = MatMut::from_column_major_slice_mut(x, self.nrows, k);
        matmul(x, Accum::Add, self.as_faer(), c, -1.0, Par::Seq);
    }

    /// V C, N × k column after column, for C r × k.
    pub fn times(&self, c: &[f64]) -> Vec<f64> {
        product(&self.values, self.nrows, c)
    }

    /// V y.
    pub fn combine(&self, y: &[c64]) -> Vec<c64> {
        self.combined(&[y]).concat()
    }

    /// V y of several y: one product.
    pub fn combine_all(&self, each: &[Vec<c64>]) -> Vec<Vec<c64>> {
        self.combined(&each.iter().map(Vec::as_slice).collect::<Vec<_>>())
    }

    fn combined(&self, each: &[&[c64]]) -> Vec<Vec<c64>> {
        assert!(each.iter().all(|y| y.len() == self.ncols()));
        let parts = |y: &&[c64]| y.iter().map(|y| y.re).chain(y.iter().map(|y| y.im)).collect::<Vec<f64>>();
        let product = self.times(&each.iter().flat_map(parts).collect::<Vec<f64>>());
        let complex = |of: &[f64]| {
            let (re, im) = of.split_at(self.nrows);
            re.iter().zip(im).map(|(&re, &im)| c64::new(re, im)).collect()
        };
        product.chunks_exact((2 * self.nrows).max(1)).map(complex).collect()
    }

    fn as_faer(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.nrows, self.ncols())
    }
}

/// A B for A m × r and B r × k, all column after column.
pub fn product(a: &[f64], m: usize, b: &[f64]) -> Vec<f64> {
    let r = a.len() / m.max(1);
    let k = b.len() / r.max(1);
    let mut product = vec![0.0; m * k];
    let (a, b) = (MatRef::from_column_major_slice(a, m, r), MatRef::from_column_major_slice(b, r, k));
    let out = MatMut::from_column_major_slice_mut(&mut product, m, k);
    matmul(out, Accum::Replace, a, b, 1.0, Par::Seq);
    product
}

/// Aᵀ B for A m × r and B m × k, all column after column.
pub fn transpose_product(a: &[f64], m: usize, b: &[f64]) -> Vec<f64> {
    let (r, k) = (a.len() / m.max(1), b.len() / m.max(1));
    let mut product = vec![0.0; r * k];
    let (a, b) = (MatRef::from_column_major_slice(a, m, r), MatRef::from_column_major_slice(b, m, k));
    let out = MatMut::from_column_major_slice_mut(&mut product, r, k);
    matmul(out, Accum::Replace, a.transpose(), b, 1.0, Par::Seq);
    product
}

/// A Aᵀ, m × m, for A m × r column after column.
pub fn times_transpose(a: &[f64], m: usize) -> Vec<f64> {
    let r = a.len() / m.max(1);
    let mut product = vec![0.0; m * m];
    let a = MatRef::from_column_major_slice(a, m, r);
    matmul(
        MatMut::from_column_major_slice_mut(&mut product, m, m),
        Accum::Replace,
        a,
        a.transpose(),
        1.0,
        Par::Seq,
    );
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_the_sums_they_stand_for() {
        let mut v = ColumnBlock::new(3);
        v.push(&[1.0, 2.0, 3.0]);
        v.push(&[-1.0, 0.0, 1.0]);
        assert_eq!((v.ncols(), v.column(1)), (2, &[-1.0, 0.0, 1.0][..]));
        assert_eq!(v.transpose_times(&[1.0, 0.0, 0.0, 0.0, 1.0, 1.0]), [1.0, -1.0, 5.0, 1.0]);
        let mut x = [1.0, 1.0, 1.0];
        v.subtract_times(&[1.0, 2.0], &mut x);
        assert_eq!(x, [2.0, -1.0, -4.0]);
        let y = [c64::new(1.0, 1.0), c64::new(0.0, 2.0)];
        assert_eq!(v.combine(&y), [c64::new(1.0, -1.0), c64::new(2.0, 2.0), c64::new(3.0, 5.0)]);
        assert_eq!(v.times(&[1.0, 0.0, 1.0, 2.0]), [1.0, 2.0, 3.0, -1.0, 2.0, 5.0]);
        assert_eq!(times_transpose(&[1.0, 2.0, 3.0, -1.0, 0.0, 1.0], 2), [10.0, -1.0, -1.0, 6.0]);
    }
}
