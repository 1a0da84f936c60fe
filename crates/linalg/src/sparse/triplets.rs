//! Assembly: contributions summed where they meet.

use super::{Pattern, SymmetricMatrix, Values};
use crate::c64;
use std::sync::Arc;

/// Contributions (row, column, value) to the lower triangle of a symmetric matrix; those at one position add up.
#[derive(Debug, Clone, Default)]
pub struct Triplets {
    dim: usize,
    rows: Vec<usize>,
    cols: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    /// No contributions yet to an n × n matrix.
    pub fn new(dim: usize) -> Self {
        Self { dim, ..Self::default() }
    }

    /// Adds `value` at (row, col) **and** its mirror image, which is one position of the lower triangle.
    pub fn add(&mut self, row: usize, col: usize, value: f64) {
        self.rows.push(row.max(col));
        self.cols.push(row.min(col));
        self.values.push(value);
    }

    /// Adds a symmetric element matrix (row-major, k × k) at the global dofs; `None` is a fixed dof, left out.
    ///
    /// # Panics
    /// Where `element` is not k × k for k dofs.
    pub fn add_element(&mut self, dofs: &[Option<usize>], element: &[f64]) {
        assert_eq!(element.len(), dofs.len() * dofs.len());
        for (i, row) in dofs.iter().enumerate() {
            for (j, col) in dofs.iter().enumerate().take(i + 1) {
                if let (Some(row), Some(col)) = (row, col) {
                    // Two dofs of one element on one global dof: both mirror images land on the diagonal.
                    let twice = if row == col && i != j { 2.0 } else { 1.0 };
                    self.add(*row, *col, twice * element[i * dofs.len() + j]);
                }
            }
        }
    }

    /// The assembled matrix.
    pub fn assemble(self) -> SymmetricMatrix {
        let pattern = Pattern::new(self.dim, self.rows.iter().copied().zip(self.cols.iter().copied()));
        let mut values = vec![0.0; pattern.stored()];
        accumulate(&pattern, &self.rows, &self.cols, &self.values, |k, value| values[k] += value);
        SymmetricMatrix::new(Arc::new(pattern), Values::Real(values))
    }
}

/// The matrix of distinct or repeated complex triplets of a lower triangle.
pub(super) fn assemble_complex(
    dim: usize,
    rows: &[usize],
    cols: &[usize],
    entries: &[c64],
) -> SymmetricMatrix {
    let pattern = Pattern::new(dim, rows.iter().copied().zip(cols.iter().copied()));
    let mut values = vec![c64::default(); pattern.stored()];
    accumulate(&pattern, rows, cols, entries, |k, value| values[k] += value);
    SymmetricMatrix::new(Arc::new(pattern), Values::Complex(values))
}

fn accumulate<T: Copy>(
    pattern: &Pattern,
    rows: &[usize],
    cols: &[usize],
    values: &[T],
    mut add: impl FnMut(usize, T),
) {
    for ((&row, &col), &value) in rows.iter().zip(cols).zip(values) {
        if let Some(k) = pattern.find(row, col) {
            add(k, value);
        }
    }
}
