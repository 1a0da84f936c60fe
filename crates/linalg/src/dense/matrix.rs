//! A small complex matrix.

use crate::c64;
use faer::MatRef;
use std::ops::{Index, IndexMut};

/// A dense complex matrix, column after column.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    nrows: usize,
    ncols: usize,
    values: Vec<c64>,
}

impl Matrix {
    /// nrows × ncols zeros.
    pub fn zeros(nrows: usize, ncols: usize) -> Self {
        Self { nrows, ncols, values: vec![c64::default(); nrows * ncols] }
    }

    /// Entry (i, j) is `entry(i, j)`.
    pub fn from_fn(nrows: usize, ncols: usize, mut entry: impl FnMut(usize, usize) -> c64) -> Self {
        let mut matrix = Self::zeros(nrows, ncols);
        for j in 0..ncols {
            for i in 0..nrows {
                matrix[(i, j)] = entry(i, j);
            }
        }
        matrix
    }

    /// Of its values, column after column.
    pub(super) fn of(nrows: usize, ncols: usize, values: Vec<c64>) -> Self {
        assert_eq!(values.len(), nrows * ncols);
        Self { nrows, ncols, values }
    }

    /// Number of rows.
    pub fn nrows(&self) -> usize {
        self.nrows
    }

    /// Number of columns.
    pub fn ncols(&self) -> usize {
        self.ncols
    }

    /// One column.
    pub fn column(&self, j: usize) -> &[c64] {
        &self.values[j * self.nrows..(j + 1) * self.nrows]
    }

    /// A x.
    ///
    /// # Panics
    /// Where x has not one entry for each column.
    pub fn multiply(&self, x: &[c64]) -> Vec<c64> {
        let mut product = vec![c64::default(); self.nrows];
        self.multiply_add(c64::new(1.0, 0.0), x, &mut product);
        product
    }

    /// out += factor · A x.
    ///
    /// # Panics
    /// Where a length does not fit.
    pub fn multiply_add(&self, factor: c64, x: &[c64], out: &mut [c64]) {
        assert!(x.len() == self.ncols && out.len() == self.nrows);
        for (j, &xj) in x.iter().enumerate() {
            let scaled = factor * xj;
            out.iter_mut().zip(self.column(j)).for_each(|(sum, &a)| *sum += a * scaled);
        }
    }

    /// A ← A + factor · B.
    ///
    /// # Panics
    /// Where the sizes differ.
    pub fn add_scaled(&mut self, factor: c64, other: &Self) {
        assert!(self.nrows == other.nrows && self.ncols == other.ncols);
        self.values.iter_mut().zip(&other.values).for_each(|(a, b)| *a += factor * b);
    }

    /// max |aᵢⱼ|, NaN where there is one.
    pub fn max_modulus(&self) -> f64 {
        crate::scalar::max_modulus(&self.values)
    }

    pub(super) fn as_faer(&self) -> MatRef<'_, c64> {
        MatRef::from_column_major_slice(&self.values, self.nrows, self.ncols)
    }

    pub(super) fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value.is_finite())
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = c64;
    fn index(&self, (i, j): (usize, usize)) -> &c64 {
        &self.values[i + j * self.nrows]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut c64 {
        &mut self.values[i + j * self.nrows]
    }
}
