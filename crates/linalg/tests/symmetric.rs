//! The real symmetric back-end against the dense one: definite, indefinite and saddle-point matrices.

use frfit_linalg::solve::{Analysis, Breakdown};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Triplets};
use proptest::prelude::*;
use std::sync::Arc;

/// n rows with these couplings, and on the diagonal `signs` times what dominates each row: condition < 1e4.
fn dominant(n: usize, couplings: &[(usize, usize, f64)], sign: impl Fn(usize) -> f64) -> SymmetricMatrix {
    let mut triplets = Triplets::new(n);
    let mut row_sums = vec![1.0; n];
    for &(i, j, value) in couplings {
        let (i, j) = (i % n, j % n);
        if i != j {
            triplets.add(i, j, value);
            row_sums[i] += value.abs();
            row_sums[j] += value.abs();
        }
    }
    row_sums.iter().enumerate().for_each(|(i, sum)| triplets.add(i, i, sign(i) * sum));
    triplets.assemble()
}

/// Solutions of all right-hand sides by a back-end.
fn solve(analysis: &Analysis, matrix: &SymmetricMatrix, rhs: &[f64]) -> Result<Vec<f64>, Breakdown> {
    let mut x = rhs.to_vec();
    analysis.factor(matrix.real_values().unwrap())?.solve(&mut x)?;
    Ok(x)
}

fn couplings() -> impl Strategy<Value = Vec<(usize, usize, f64)>> {
    prop::collection::vec((0usize..150, 0usize..150, -1.0f64..1.0), 0..600)
}

fn rhs(n: usize, columns: usize) -> Vec<f64> {
    (0..n * columns).map(|i| ((i * i + 3) % 17) as f64 / 8.0 - 1.0).collect()
}

proptest! {
    /// L Lᵀ, L B Lᵀ with all signs of pivots, and dense LU have the same solutions.
    #[test]
    fn sparse_is_dense(
        n in 1usize..150,
        couplings in couplings(),
        negative in prop::collection::vec(prop::bool::ANY, 150),
        definite in prop::bool::ANY,
        columns in 1usize..5,
    ) {
        let matrix = dominant(n, &couplings, |i| if negative[i] && !definite { -1.0 } else { 1.0 });
        let rhs = rhs(n, columns);
        let sparse = solve(&Analysis::sparse(matrix.pattern()), &matrix, &rhs).unwrap();
        let dense = solve(&Analysis::dense(matrix.pattern()), &matrix, &rhs).unwrap();
        for (a, b) in sparse.iter().zip(&dense) {
            prop_assert!((a - b).abs() < 1e-11, "{a} against {b}"); // condition < 1e4 times roundoff
        }
    }

    /// An indefinite matrix with a positive diagonal: L Lᵀ is tried, fails, and nothing of it remains.
    #[test]
    fn a_failed_cholesky_leaves_no_trace(n in 60usize..150, at in 0usize..59, couplings in couplings()) {
        let definite = dominant(n, &couplings, |_| 1.0);
        let (mut values, pattern) = (definite.real_values().unwrap().to_vec(), definite.pattern());
        let ties: Vec<_> = pattern.positions().chain([(at + 1, at)]).collect();
        let pattern = Arc::new(Pattern::new(n, ties));
        let wider = definite.on_pattern(&pattern);
        values.clear();
        values.extend(wider.real_values().unwrap());
        // The 2 × 2 minor of this tie is negative.
        let k = pattern.find(at + 1, at).unwrap();
        let diagonal = |i| pattern.find(i, i).unwrap();
        values[k] = 2.0 * values[diagonal(at)].max(values[diagonal(at + 1)]) + 1.0;
        let matrix = SymmetricMatrix::new(Arc::clone(&pattern), frfit_linalg::sparse::Values::Real(values));
        let rhs = rhs(n, 2);
        let sparse = solve(&Analysis::sparse(&pattern), &matrix, &rhs);
        let dense = solve(&Analysis::dense(&pattern), &matrix, &rhs);
        let (Ok(sparse), Ok(dense)) = (sparse, dense) else {
            return Err(TestCaseError::fail("a system with a solution was refused"));
        };
        for (a, b) in sparse.iter().zip(&dense) {
            // The tie may bring its two rows close to dependence on the others, not below 1e-4 of them.
            prop_assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} against {b}");
        }
    }

    /// Constraint rows (zero diagonals) of Lagrange multipliers.
    #[test]
    fn constraints_are_solved(
        n in 20usize..100,
        constraints in 1usize..10,
        couplings in couplings(),
    ) {
        let definite = dominant(n, &couplings, |_| 1.0);
        let mut triplets = Triplets::new(n + constraints);
        for ((i, j), &value) in definite.pattern().positions().zip(definite.real_values().unwrap()) {
            triplets.add(i, j, value);
        }
        for c in 0..constraints {
            triplets.add(n + c, 2 * c, 1.0);
            triplets.add(n + c, 2 * c + 1, -1.0);
        }
        let matrix = triplets.assemble();
        let rhs = rhs(n + constraints, 1);
        let dense = solve(&Analysis::dense(matrix.pattern()), &matrix, &rhs).unwrap();
        let sparse = solve(&Analysis::sparse(matrix.pattern()), &matrix, &rhs).unwrap();
        for (a, b) in sparse.iter().zip(&dense) {
            // Multipliers are as large as the stiffness is: up to 600 couplings at one row.
            prop_assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} against {b}");
        }
    }
}

/// A cube of n³ nodes with three dofs each, springs to all 26 neighbours, free: K is singular, K + M is not.
fn free_cube(n: usize) -> (SymmetricMatrix, SymmetricMatrix) {
    let dofs = 3 * n * n * n;
    let (mut k, mut m) = (Triplets::new(dofs), Triplets::new(dofs));
    let node = |p: [usize; 3]| (p[0] * n + p[1]) * n + p[2];
    for a in (0..n * n * n).map(|a| [a / n / n, a / n % n, a % n]) {
        for step in 1..27 {
            let b: [usize; 3] = std::array::from_fn(|d| a[d] + step / 3usize.pow(d as u32) % 3);
            let Some(b) = b.iter().all(|&x| x >= 1 && x <= n).then(|| b.map(|x| x - 1)) else { continue };
            let r: [f64; 3] = std::array::from_fn(|d| b[d] as f64 - a[d] as f64);
            if node(b) <= node(a) {
                continue;
            }
            let ends: Vec<_> =
                [a, b].iter().flat_map(|&p| (0..3).map(move |d| Some(3 * node(p) + d))).collect();
            let entry = |i: usize, j: usize| if i / 3 == j / 3 { 1.0 } else { -1.0 } * r[i % 3] * r[j % 3];
            let element: Vec<f64> = (0..36).map(|at| entry(at / 6, at % 6)).collect();
            k.add_element(&ends, &element);
        }
    }
    (0..dofs).for_each(|i| m.add(i, i, 1.0));
    (k.assemble(), m.assemble())
}

#[test]
fn a_free_body_with_a_little_mass() {
    // Large enough to be dissected; 1e-9 of tr K / tr M is the shift of `modes::lowest`.
    let (k, m) = free_cube(12);
    let m = m.on_pattern(k.pattern());
    let trace: f64 = (0..k.dim()).map(|i| k.get(i, i).re).sum();
    let sigma = 1e-9 * trace / k.dim() as f64;
    let values = k.real_values().unwrap().iter().zip(m.real_values().unwrap()).map(|(k, m)| k + sigma * m);
    let values: Vec<f64> = values.collect();
    let analysis = Analysis::new(k.pattern());
    let factor = analysis.factor(&values).unwrap();
    // A uniform force moves the body uniformly: x = b/σ, through K alone undetermined.
    let mut x: Vec<f64> =
        (0..3 * k.dim()).map(|i| if (i + i / k.dim()) % 3 == 0 { sigma } else { 0.0 }).collect();
    let expected: Vec<f64> = x.iter().map(|b| b / sigma).collect();
    let report = factor.solve(&mut x).unwrap();
    assert!(report.backward_error < 1e-14);
    for (x, expected) in x.iter().zip(&expected) {
        assert!((x - expected).abs() < 1e-5, "{x} {expected}"); // condition 1e10 times roundoff
    }
}

#[test]
fn right_hand_sides_together_are_right_hand_sides_alone() {
    let (k, m) = free_cube(8);
    let m = m.on_pattern(k.pattern());
    for shift in [1.0, -0.37] {
        let values = k.real_values().unwrap().iter().zip(m.real_values().unwrap());
        let values: Vec<f64> = values.map(|(k, m)| k + shift * m).collect();
        let factor = Analysis::new(k.pattern()).factor(&values).unwrap();
        let given = rhs(k.dim(), 8);
        let mut together = given.clone();
        factor.solve(&mut together).unwrap();
        for (b, x) in given.chunks_exact(k.dim()).zip(together.chunks_exact(k.dim())) {
            let mut alone = b.to_vec();
            let report = factor.solve(&mut alone).unwrap();
            let size = alone.iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let tolerance = 1e-12 * report.condition_at_least.max(1e3) * size;
            assert!(x.iter().zip(&alone).all(|(a, b)| (a - b).abs() <= tolerance));
        }
    }
}
