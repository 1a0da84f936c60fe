//! Solutions of random matrices against their residuals, in every precision and with any number of threads.

use proptest::prelude::*;
use sparse_ldlt::{Options, Ordering, Scalar, Symbolic, c64};

/// Roundoff, and the growth that pivots a hundred times smaller than their neighbours allow; 1e-14 was seen.
const GROWN: f64 = 1e-12;

/// Lower triangle of a matrix by columns.
struct Lower<T> {
    dim: usize,
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    values: Vec<T>,
}

impl<T: Scalar> Lower<T> {
    fn new(dim: usize, entries: impl IntoIterator<Item = (usize, usize, T)>) -> Self {
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

    fn symbolic(&self, ordering: &Ordering) -> Symbolic {
        Symbolic::new(self.dim, &self.col_ptr, &self.row_idx, ordering).unwrap()
    }

    fn times(&self, x: &[T]) -> Vec<T> {
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
    fn backward_error(&self, x: &[T], b: &[T]) -> f64 {
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

/// Numbers without order between −1 and 1.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// n³ nodes with three dofs, coupled to their neighbours along axes and diagonals, indefinite.
fn solid<T: Scalar>(n: usize, value: impl Fn(f64, f64) -> T, seed: u64) -> Lower<T> {
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

fn check<T: Scalar>(matrix: &Lower<T>, columns: usize, tolerance: f64, value: impl Fn(f64, f64) -> T) {
    let orderings = [
        ("automatic", Ordering::Automatic),
        ("minimum degree", Ordering::MinimumDegree),
        ("nested dissection", Ordering::NestedDissection),
        ("backwards", Ordering::Given((0..matrix.dim).rev().collect())),
    ];
    for (name, ordering) in orderings {
        let symbolic = matrix.symbolic(&ordering);
        let factor = symbolic.factor(&matrix.values, &Options::default()).unwrap();
        let mut noise = noise(7);
        let b: Vec<T> = (0..matrix.dim * columns).map(|_| value(noise(), noise())).collect();
        let mut x = b.clone();
        factor.solve_in_place(&mut x, 1);
        for (x, b) in x.chunks(matrix.dim).zip(b.chunks(matrix.dim)) {
            let error = matrix.backward_error(x, b);
            assert!(error <= tolerance, "{name}: {error:e}");
        }
        // Threads change nothing.
        let again = symbolic.factor(&matrix.values, &Options { threads: 3, ..Options::default() }).unwrap();
        let mut y = b.clone();
        again.solve_in_place(&mut y, 2);
        assert_eq!(x, y, "{name}");
    }
}

#[test]
fn real_solids() {
    for n in [1, 2, 3, 5, 8] {
        check(&solid(n, |re, _| re, 1), 3, GROWN, |re, _| re);
    }
}

#[test]
fn complex_solids() {
    for n in [1, 2, 3, 5, 8] {
        check(&solid(n, c64::new, 1), 9, GROWN, c64::new);
    }
}

#[test]
fn single_precision_solids() {
    check(&solid(5, |re, _| re as f32, 1), 4, 1e-5, |re, _| re as f32);
    check(&solid(5, |re, im| num_complex::Complex32::new(re as f32, im as f32), 1), 4, 1e-5, |re, im| {
        num_complex::Complex32::new(re as f32, im as f32)
    });
}

proptest! {
    /// Saddle points and zeros on the diagonal: only delayed pivots and blocks of two get through.
    #[test]
    fn indefinite_with_zero_diagonals(
        dim in 1usize..120,
        couplings in prop::collection::vec((0usize..120, 0usize..120, -1.0f64..1.0), 0..600),
        zeros in prop::collection::vec(any::<bool>(), 120),
        seed in 0u64..1000,
    ) {
        let mut noise = noise(seed);
        let entries = couplings.iter().map(|&(i, j, value)| (i % dim, j % dim, value)).filter(|(i, j, _)| i != j);
        let diagonal = (0..dim).map(|i| (i, i, if zeros[i] { 0.0 } else { noise() }));
        let matrix = Lower::new(dim, entries.chain(diagonal).collect::<Vec<_>>());
        let b: Vec<f64> = (0..dim).map(|_| noise()).collect();
        for ordering in [Ordering::Automatic, Ordering::Given((0..dim).collect())] {
            let Ok(factor) = matrix.symbolic(&ordering).factor(&matrix.values, &Options::default()) else { continue };
            prop_assert_eq!(factor.inertia().positive + factor.inertia().negative, dim);
            let mut x = b.clone();
            factor.solve_in_place(&mut x, 1);
            if x.iter().all(|x| x.is_finite()) {
                // L is bounded by 100 an entry, so that a growth of some hundreds is possible and was seen.
                prop_assert!(matrix.backward_error(&x, &b) < 1e-11, "{:e}", matrix.backward_error(&x, &b));
            }
        }
    }
}
