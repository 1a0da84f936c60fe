//! Matrices for tests.
#![allow(dead_code, reason = "each test file uses a part of it")]

use multifrontal::{Options, Ordering, Scalar, Symbolic};
use rayon::ThreadPoolBuilder;

/// Lower triangle of a matrix by columns.
pub(crate) struct Lower<T> {
    pub(crate) dim: usize,
    pub(crate) col_ptr: Vec<usize>,
    pub(crate) row_idx: Vec<usize>,
    pub(crate) values: Vec<T>,
}

impl<T: Scalar> Lower<T> {
    pub(crate) fn new(dim: usize, entries: impl IntoIterator<Item = (usize, usize, T)>) -> Self {
        let mut columns = vec![std::collections::BTreeMap::new(); dim];
        for (i, j, value) in entries {
            *columns[i.min(j)].entry(i.max(j)).or_insert(T::default()) += value;
        }
        let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in columns {
            row_idx.extend(column.keys());
            values.extend(column.values());
            col_ptr.push(row_idx.len());
        }
        Self { dim, col_ptr, row_idx, values }
    }

    pub(crate) fn symbolic(&self, ordering: &Ordering) -> Symbolic {
        let options = Options::default().with_ordering(ordering.clone());
        Symbolic::new(self.dim, &self.col_ptr, &self.row_idx, &options).unwrap()
    }

    pub(crate) fn times(&self, x: &[T]) -> Vec<T> {
        let mut y = vec![T::default(); self.dim];
        for col in 0..self.dim {
            for k in self.col_ptr[col]..self.col_ptr[col + 1] {
                let row = self.row_idx[k];
                y[row] += self.values[k] * x[col];
                if row != col {
                    y[col] += self.values[k] * x[row];
                }
            }
        }
        y
    }

    /// ‖b − A x‖ / (‖A‖ ‖x‖ + ‖b‖) in the maximum norm.
    pub(crate) fn backward_error(&self, x: &[T], b: &[T]) -> f64 {
        let size = |v: &[T]| v.iter().map(|v| v.modulus()).fold(0.0, f64::max);
        let mut rows = vec![0.0; self.dim];
        for col in 0..self.dim {
            for k in self.col_ptr[col]..self.col_ptr[col + 1] {
                rows[self.row_idx[k]] += self.values[k].modulus();
                if self.row_idx[k] != col {
                    rows[col] += self.values[k].modulus();
                }
            }
        }
        let norm = rows.into_iter().fold(0.0, f64::max);
        let residual: Vec<T> = self.times(x).iter().zip(b).map(|(&y, &b)| b - y).collect();
        size(&residual) / (norm * size(x) + size(b))
    }
}

/// Runs in a pool of so many threads.
pub(crate) fn in_pool<O: Send>(threads: usize, run: impl FnOnce() -> O + Send) -> O {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

/// Numbers without order between −1 and 1.
pub(crate) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// n³ nodes with three dofs, coupled to their neighbours along axes and diagonals, indefinite.
pub(crate) fn solid<T: Scalar>(n: usize, value: impl Fn(f64, f64) -> T, seed: u64) -> Lower<T> {
    let mut noise = noise(seed);
    let node = |p: usize| [p / n / n, p / n % n, p % n];
    let mut entries = Vec::new();
    for p in 0..n * n * n {
        for q in 0..=p {
            if node(p).iter().zip(node(q)).all(|(&a, b)| a.abs_diff(b) <= 1) {
                for k in 0..9 {
                    let (i, j) = (3 * p + k / 3, 3 * q + k % 3);
                    if i >= j {
                        let diagonal = if i == j { 6.0 } else { 0.0 };
                        entries.push((i, j, value(diagonal + noise(), noise())));
                    }
                }
            }
        }
    }
    Lower::new(3 * n * n * n, entries)
}
