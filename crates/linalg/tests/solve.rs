//! Analyse → factor → solve against dense oracles, on random and on hostile matrices.

use frfit_linalg::solve::{Analysis, Breakdown};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Triplets, Values};
use frfit_linalg::{c64, modes};
use proptest::prelude::*;
use std::sync::Arc;

/// Free–free chain of n masses: stiffness 1 between neighbours, mass 1 each.
fn chain(n: usize) -> (SymmetricMatrix, SymmetricMatrix) {
    let (mut k, mut m) = (Triplets::new(n), Triplets::new(n));
    for i in 0..n {
        m.add(i, i, 1.0);
        if i + 1 < n {
            k.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    (k.assemble(), m.assemble())
}

fn dense_product(pattern: &Pattern, values: &[c64], x: &[c64]) -> Vec<c64> {
    let mut out = vec![c64::default(); x.len()];
    for ((i, j), &a) in pattern.positions().zip(values) {
        out[i] += a * x[j];
        if i != j {
            out[j] += a * x[i];
        }
    }
    out
}

proptest! {
    /// Sparse and dense back-ends solve the same random complex symmetric system.
    #[test]
    fn back_ends_agree(
        n in 1usize..80,
        positions in prop::collection::vec((0usize..80, 0usize..80), 0..240),
        seed in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 320 + 80),
        columns in 1usize..4,
    ) {
        let pattern = Arc::new(Pattern::new(n, positions.iter().map(|&(i, j)| (i % n, j % n))));
        let mut values: Vec<c64> =
            (0..pattern.stored()).map(|k| c64::new(seed[k % seed.len()].0, seed[k % seed.len()].1)).collect();
        // A diagonal that dominates bounds the condition number, so that solutions can be compared.
        for i in 0..n {
            values[pattern.find(i, i).unwrap()] += c64::new(0.0, 2.0 + pattern.stored() as f64 / n as f64 * 3.0);
        }
        let rhs: Vec<c64> = (0..n * columns).map(|i| c64::new(seed[i % 400].1, seed[(7 * i) % 400].0)).collect();
        let (mut sparse, mut dense) = (rhs.clone(), rhs.clone());
        let report = Analysis::sparse(&pattern).factor(&values).unwrap().solve(&mut sparse).unwrap();
        Analysis::dense(&pattern).factor(&values).unwrap().solve(&mut dense).unwrap();
        prop_assert!(report.backward_error < 1e-14);
        for (a, b) in sparse.iter().zip(&dense) {
            prop_assert!((a - b).norm() < 1e-11, "{} against {}", a, b); // condition < 1e4 times roundoff
        }
        let product = dense_product(&pattern, &values, &sparse[..n]);
        for (p, b) in product.iter().zip(&rhs) {
            prop_assert!((p - b).norm() < 1e-11);
        }
    }

    /// Real and complex factorisations of one real indefinite matrix agree.
    #[test]
    fn real_is_complex_with_no_imaginary_part(n in 2usize..120, shift in 0.05f64..3.9) {
        let (k, m) = chain(n);
        let pattern = Pattern::union(&[k.pattern(), m.pattern()]);
        let (k, m) = (k.on_pattern(&pattern), m.on_pattern(&pattern));
        let real: Vec<f64> =
            k.real_values().unwrap().iter().zip(m.real_values().unwrap()).map(|(k, m)| k - shift * m).collect();
        let complex: Vec<c64> = real.iter().map(|&a| c64::new(a, 0.0)).collect();
        let analysis = Analysis::sparse(&pattern);
        let mut x: Vec<f64> = (0..n).map(|i| ((i * i) % 5) as f64 - 1.5).collect();
        let mut z: Vec<c64> = x.iter().map(|&b| c64::new(b, 0.0)).collect();
        let (Ok(a), Ok(_)) = (
            analysis.factor(&real).unwrap().solve(&mut x),
            analysis.factor(&complex).unwrap().solve(&mut z),
        ) else {
            // A shift on an eigenvalue: both may refuse.
            return Ok(());
        };
        let tolerance = 1e-14 * a.condition_at_least.max(1.0) * 1e3 * z.iter().map(|z| z.norm()).fold(1.0, f64::max);
        for (x, z) in x.iter().zip(&z) {
            prop_assert!((x - z.re).abs() <= tolerance && z.im.abs() <= tolerance, "{x} {z}");
        }
    }
}

/// Bending stiffness of n points on a line, of second differences: its condition grows as n⁴.
fn beam(n: usize) -> SymmetricMatrix {
    let mut k = Triplets::new(n);
    for i in 1..n - 1 {
        let difference = [1.0, -2.0, 1.0];
        let element: Vec<f64> = difference.iter().flat_map(|a| difference.map(|b| a * b)).collect();
        k.add_element(&[Some(i - 1), Some(i), Some(i + 1)], &element);
    }
    k.assemble()
}

#[test]
fn single_precision_has_the_residuals_of_double() {
    // The lowest elastic eigenvalue is some 500/n⁴, and single precision resolves 1e-6: at 300 points some thirty modes are lost in it.
    for (n, shift) in [(60, 1e-4), (300, 1e-2), (300, 1e-5)] {
        let k = beam(n);
        let diagonal: Vec<bool> = k.pattern().positions().map(|(row, col)| row == col).collect();
        let values = k.real_values().unwrap().iter().zip(&diagonal);
        let real: Vec<f64> = values.map(|(k, &on)| if on { k - shift } else { *k }).collect();
        let complex: Vec<c64> = real.iter().map(|&a| c64::new(a, 1e-3 * a)).collect();
        let double = Analysis::sparse(k.pattern());
        let single = double.in_single_precision().unwrap();
        assert!(single.is_single_precision() && !double.is_single_precision());

        let rhs: Vec<f64> = (0..6 * n).map(|i| ((i * i) % 7) as f64 - 3.0).collect();
        let [(x, of_double, below), (y, of_single, too)] = [&double, &single].map(|analysis| {
            let (mut x, factor) = (rhs.clone(), analysis.factor(&real).unwrap());
            let report = factor.solve(&mut x).unwrap();
            (x, report, factor.negative_eigenvalues())
        });
        assert!(of_single.refined && of_single.backward_error <= 1e-14, "{n}: {of_single:?}");
        assert_eq!(below, too, "{n}");
        let largest = x.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let farthest = x.iter().zip(&y).fold(0.0, |a: f64, (x, y)| a.max((x - y).abs()));
        // ‖A‖ ‖A⁻¹‖ of the residual, of which the report says the least.
        assert!(
            farthest <= 1e2 * 1e-14 * of_double.condition_at_least * largest,
            "{n}: {farthest:e} of {largest:e}"
        );

        let mut z: Vec<c64> = rhs[..n].iter().map(|&b| c64::new(b, 0.0)).collect();
        let of_single = single.factor(&complex).unwrap().solve(&mut z).unwrap();
        assert!(of_single.backward_error <= 1e-14, "{n}: {of_single:?}");
    }
}

#[test]
fn a_singular_matrix_is_a_typed_outcome() {
    // A free chain has a rigid-body mode: K alone is singular, whatever the back-end.
    for n in [3, 100] {
        let (k, _) = chain(n);
        let values: Vec<c64> = k.real_values().unwrap().iter().map(|&a| c64::new(a, 0.0)).collect();
        for analysis in [Analysis::dense(k.pattern()), Analysis::sparse(k.pattern())] {
            let mut rhs = vec![c64::new(1.0, 0.0); n];
            let outcome = analysis.factor(&values).and_then(|factor| factor.solve(&mut rhs));
            assert!(
                matches!(outcome, Err(Breakdown::Singular { .. } | Breakdown::Inaccurate { .. })),
                "{outcome:?}"
            );
            let mut rhs = vec![1.0; n];
            let outcome = analysis.factor(k.real_values().unwrap()).and_then(|factor| factor.solve(&mut rhs));
            assert!(
                matches!(outcome, Err(Breakdown::Singular { .. } | Breakdown::Inaccurate { .. })),
                "{outcome:?}"
            );
        }
    }
}

#[test]
fn values_that_are_not_finite_are_refused() {
    let (k, _) = chain(60);
    let analysis = Analysis::new(k.pattern());
    let mut values: Vec<c64> = k.real_values().unwrap().iter().map(|&a| c64::new(a, 1.0)).collect();
    let factor = analysis.factor(&values).unwrap();
    assert_eq!(factor.solve(&mut vec![c64::new(f64::INFINITY, 0.0); 60]), Err(Breakdown::NotFinite));
    values[5] = c64::new(f64::NAN, 0.0);
    assert!(matches!(analysis.factor(&values), Err(Breakdown::NotFinite)));
}

#[test]
fn complex_symmetric_is_not_taken_for_hermitian() {
    // [[1, i], [i, 2]]: symmetric solution (b = e₁) is x = [2, −i]/3; a Hermitian reading gives another.
    let pattern = Arc::new(Pattern::new(2, [(1, 0)]));
    let values = [c64::new(1.0, 0.0), c64::new(0.0, 1.0), c64::new(2.0, 0.0)];
    for analysis in [Analysis::dense(&pattern), Analysis::sparse(&pattern)] {
        let mut x = [c64::new(1.0, 0.0), c64::default()];
        analysis.factor(&values).unwrap().solve(&mut x).unwrap();
        assert!((x[0] - c64::new(2.0 / 3.0, 0.0)).norm() < 1e-15);
        assert!((x[1] - c64::new(0.0, -1.0 / 3.0)).norm() < 1e-15);
    }
}

#[test]
fn patterns_unite_and_matrices_spread() {
    let a = SymmetricMatrix::from_complex_triplets(
        3,
        &[1, 1],
        &[0, 0],
        &[c64::new(1.0, 2.0), c64::new(0.5, 0.0)],
    );
    let b = SymmetricMatrix::new(Arc::new(Pattern::new(3, [(0, 2)])), Values::Real(vec![1.0, 2.0, 3.0, 4.0]));
    let union = Pattern::union(&[a.pattern(), b.pattern()]);
    assert_eq!(union.positions().collect::<Vec<_>>(), [(0, 0), (1, 0), (2, 0), (1, 1), (2, 2)]);
    let (a, b) = (a.on_pattern(&union), b.on_pattern(&union));
    assert_eq!(a.get(0, 1), c64::new(1.5, 2.0));
    assert_eq!((b.get(0, 2), b.get(1, 0)), (c64::new(2.0, 0.0), c64::default()));
    let mut out = vec![c64::default(); 3];
    a.multiply_add(c64::new(0.0, 1.0), &[c64::new(1.0, 0.0), c64::new(2.0, 0.0), c64::default()], &mut out);
    assert_eq!(out, [c64::new(-4.0, 3.0), c64::new(-2.0, 1.5), c64::default()]);
}

#[test]
fn modes_of_a_free_chain() {
    // ω² = 4 sin²(kπ/2n), k = 0, 1, …: the first is the rigid-body mode. Beside its 1/|σ| the inverse of the last of 160 modes is 1e-9, and roundoff 1e-6 of that.
    let n = 400;
    let (k, m) = chain(n);
    for count in [6, 160] {
        let modes = modes::lowest(&k, &m, count).unwrap();
        let top = 4.0;
        for (j, &found) in modes.omega_squared.iter().enumerate() {
            let exact = 4.0 * (j as f64 * std::f64::consts::PI / (2 * n) as f64).sin().powi(2);
            // The shift of −1e-9 tr K/tr M and roundoff of K φ: both relative to the highest ω².
            let most = 1e-13 * top + 1e-10 * exact;
            assert!((found - exact).abs() < most, "mode {j}: {found:e} against {exact:e}");
        }
    }
}

#[test]
fn modes_of_a_chain_with_every_second_mass() {
    // Two springs in a row between masses: ω² = 2 sin²(kπ/2n) of n masses. All of them, and no more.
    let n = 100;
    let (mut k, mut m) = (Triplets::new(2 * n - 1), Triplets::new(2 * n - 1));
    for i in 0..2 * n - 1 {
        if i % 2 == 0 {
            m.add(i, i, 1.0);
        }
        if i > 0 {
            k.add_element(&[Some(i - 1), Some(i)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    let (k, m) = (k.assemble(), m.assemble());
    for (count, expected) in [(40, 40), (100, 100), (120, 100)] {
        let modes = modes::lowest(&k, &m, count).unwrap();
        assert_eq!(modes.omega_squared.len(), expected);
        for (j, &found) in modes.omega_squared.iter().enumerate() {
            let exact = 2.0 * (j as f64 * std::f64::consts::PI / (2 * n) as f64).sin().powi(2);
            assert!((found - exact).abs() < 1e-12 + 1e-10 * exact, "mode {j}: {found:e} against {exact:e}");
        }
    }
}

#[test]
fn double_modes_come_out_twice() {
    // Two identical chains side by side: every mode is double.
    let n = 60;
    let (mut k, mut m) = (Triplets::new(2 * n), Triplets::new(2 * n));
    for i in 0..2 * n {
        m.add(i, i, 1.0);
        k.add(i, i, 0.1);
        if (i + 1) % n != 0 {
            k.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    let modes = modes::lowest(&k.assemble(), &m.assemble(), 6).unwrap();
    for (j, &found) in modes.omega_squared.iter().enumerate() {
        let exact = 0.1 + 4.0 * ((j / 2) as f64 * std::f64::consts::PI / (2 * n) as f64).sin().powi(2);
        assert!((found / exact - 1.0).abs() < 1e-10, "mode {j}: {found} against {exact}");
    }
}

/// A chain has as many negative eigenvalues of K − ω²M as it has modes below ω, whichever back-end counts them.
#[test]
fn negative_eigenvalues_are_the_modes_below() {
    for n in [5, 60] {
        let (k, m) = chain(n);
        let pattern = Pattern::union(&[k.pattern(), m.pattern()]);
        let (k, m) = (k.on_pattern(&pattern), m.on_pattern(&pattern));
        for omega in [0.1_f64, 0.9, 1.7] {
            let shifted = |(k, m): (&f64, &f64)| k - omega * omega * m;
            let values: Vec<f64> =
                k.real_values().unwrap().iter().zip(m.real_values().unwrap()).map(shifted).collect();
            // Free–free: ω_j = 2 sin(jπ/2n), j = 0 … n − 1.
            let own = |j: usize| 2.0 * (j as f64 * std::f64::consts::PI / (2 * n) as f64).sin();
            let expected = (0..n).filter(|&j| own(j) < omega).count();
            for analysis in [Analysis::dense(&pattern), Analysis::sparse(&pattern)] {
                assert_eq!(analysis.factor(&values).unwrap().negative_eigenvalues(), expected, "{n} {omega}");
            }
        }
    }
}
