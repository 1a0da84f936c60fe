//! Patterns, orders and values from bytes: no panic, no number that is none without an outcome that says so, and
//! what is called a solution is one.

#![no_main]

use libfuzzer_sys::fuzz_target;
use multifrontal::{FactorError, Options, Ordering, Precision, Solver, Symbolic};

/// How much larger an entry of L may be than what it comes from, a few times over; refinement mends the rest.
const GROWN: f64 = 1e-8;

fuzz_target!(|bytes: &[u8]| {
    let Some((&[dim, kind, seed], rest)) = bytes.split_first_chunk::<3>() else { return };
    let dim = usize::from(dim) % 48 + 1;
    // Three bytes an entry: row, column, and one of the values that break things, or a small number.
    let mut columns = vec![std::collections::BTreeMap::new(); dim];
    for &[row, col, value] in rest.as_chunks::<3>().0 {
        let (row, col) = (usize::from(row) % dim, usize::from(col) % dim);
        let value = match (kind % 4, value) {
            (3, 0) => f64::NAN,
            (3, 1) => f64::INFINITY,
            (2.., 2) => 1e300,
            (2.., 3) => 1e-300,
            (1.., 4) => 1e12,
            (1.., 5) => 1e-12,
            (_, value) => f64::from(value as i8),
        };
        columns[row.min(col)].insert(row.max(col), value);
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
    let symbolic = Symbolic::new(dim, &col_ptr, &row_idx, &ordering).expect("the pattern is a lower triangle");
    let precision = if seed % 8 < 4 { Precision::Full } else { Precision::Single };
    let finite = values.iter().all(|value: &f64| value.is_finite());
    let solver = match Solver::new(&symbolic, &values, precision, &Options::default()) {
        Err(error) => {
            assert_eq!(matches!(error, FactorError::NotFinite { .. }), !finite, "{error}");
            return;
        }
        Ok(solver) => solver,
    };
    assert!(finite);
    if let Ok(factor) = solver.factor() {
        let inertia = factor.inertia();
        assert_eq!(inertia.positive + inertia.negative, dim);
    }
    let mut x: Vec<f64> = (0..dim).map(|k| (k + 1) as f64).collect();
    if let Ok(solution) = solver.solve(&mut x) {
        assert!(x.iter().all(|x| x.is_finite()));
        // Values that differ by 600 powers of ten underflow in one product or another.
        assert!(kind % 4 > 1 || solution.backward_error < GROWN, "{solution:?}");
    }
});
