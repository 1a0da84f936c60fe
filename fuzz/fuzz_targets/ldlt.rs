//! Patterns, orders and values from bytes: no panic, no number that is none without an outcome that says so, and
//! what is called a solution is one.

#![no_main]

use libfuzzer_sys::fuzz_target;
use multifrontal::{FactorError, Options, Ordering, Precision, Scalar, Solver, Symbolic, Threads, c64};
use std::time::Duration;

/// How much larger an entry of L may be than what it comes from, a few times over; refinement mends the rest.
const GROWN: f64 = 1e-8;

/// Rows that one of a few inputs has in place of each: its fronts have several strips, memory of the system, and work for
/// several threads.
const BLOCK: usize = 12;

fuzz_target!(|bytes: &[u8]| {
    let Some((&[dim, kind, seed, size], rest)) = bytes.split_first_chunk::<4>() else { return };
    let (nodes, block) = (usize::from(dim) % 48 + 1, if size % 16 == 0 { BLOCK } else { 1 });
    let dim = nodes * block;
    // Three bytes an entry: row, column, and one of the values that break things, or a small number.
    let mut columns = vec![std::collections::BTreeMap::new(); dim];
    for &[row, col, value] in rest.as_chunks::<3>().0 {
        let (row, col) = (usize::from(row) % nodes, usize::from(col) % nodes);
        let value = match (kind % 4, value) {
            (3, 0) => f64::NAN,
            (3, 1) => f64::INFINITY,
            (2.., 2) => 1e300,
            (2.., 3) => 1e-300,
            (1.., 4) => 1e12,
            (1.., 5) => 1e-12,
            (_, value) => f64::from(value as i8),
        };
        for (i, j) in (0..block).flat_map(|i| (0..block).map(move |j| (i, j))) {
            let (row, col) = (block * row + i, block * col + j);
            columns[row.min(col)].insert(row.max(col), value + ((7 * i + 3 * j) % 11) as f64);
        }
    }
    let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
    for column in columns {
        row_idx.extend(column.keys());
        values.extend(column.values());
        col_ptr.push(row_idx.len());
    }
    let ordering = match seed % 4 {
        0 => Ordering::Automatic,
        1 => Ordering::MinimumDegree,
        2 => Ordering::NestedDissection,
        _ => Ordering::Given((0..dim).map(|k| (k + usize::from(seed)) % dim).collect()),
    };
    let options = Options::default()
        .with_ordering(ordering)
        .with_precision(if seed % 8 < 4 { Precision::Full } else { Precision::Single })
        .with_threads(match size / 16 % 3 {
            0 => Threads::One,
            1 => Threads::Pool,
            _ => Threads::Spinning(Duration::from_millis(1)),
        });
    let symbolic = Symbolic::new(dim, &col_ptr, &row_idx, &options).expect("the pattern is a lower triangle");
    // Values that differ by 600 powers of ten underflow in one product or another.
    let exact = kind % 4 < 2;
    if size < 128 {
        solve(&symbolic, &values, |x| x, &options, exact);
    } else {
        solve(&symbolic, &values, |x| c64::new(x, 0.05 * x.abs()), &options, exact);
    }
});

/// Factorises and solves the matrix of these numbers.
fn solve<T: Scalar>(
    symbolic: &Symbolic,
    values: &[f64],
    number: impl Fn(f64) -> T,
    options: &Options,
    exact: bool,
) {
    let values: Vec<T> = values.iter().map(|&value| number(value)).collect();
    let finite = values.iter().all(|value| value.is_finite());
    let solver = match Solver::new(symbolic, &values, options) {
        Err(error) => {
            assert_eq!(matches!(error, FactorError::NotFinite { .. }), !finite, "{error}");
            return;
        }
        Ok(solver) => solver,
    };
    assert!(finite);
    if let Ok(factor) = solver.factor() {
        let inertia = factor.inertia();
        assert_eq!(inertia.positive + inertia.negative, symbolic.dim());
    }
    let mut x: Vec<T> = (0..symbolic.dim()).map(|k| number((k + 1) as f64)).collect();
    if let Ok(solution) = solver.solve(&mut x) {
        assert!(x.iter().all(|x| x.is_finite()));
        assert!(!exact || solution.backward_error < GROWN, "{solution:?}");
    }
}
