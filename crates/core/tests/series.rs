//! The Neumann series against exact rational arithmetic, contour integrals and direct solves.

use crate::common;

use common::{c, chain, full, taylor_on_circle, term, tip_load, unknown};
use frfit::c64;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor};
use frfit::response::{FullModel, Response, Work};
use frfit::series::{NeumannSeries, convergence_radius};
use num_bigint::BigInt;
use num_complex::Complex;
use num_rational::BigRational;
use proptest::prelude::*;

type Exact = Complex<BigRational>;

fn exact(value: c64) -> Exact {
    let part = |x: f64| BigRational::from_float(x).unwrap();
    Exact::new(part(value.re), part(value.im))
}

fn rounded(value: &Exact) -> c64 {
    // Numerator and denominator have thousands of digits: keep 80 bits of the quotient.
    let part = |x: &BigRational| {
        let scaled = (x.numer() << 400u32) / x.denom();
        let text = scaled.to_string();
        text.parse::<f64>().unwrap() / 2f64.powi(400)
    };
    c(part(&value.re), part(&value.im))
}

/// Gaussian elimination over the rationals: no rounding anywhere.
fn solve_exactly(matrix: &[Vec<Exact>], rhs: &[Exact]) -> Vec<Exact> {
    let n = rhs.len();
    let mut a: Vec<Vec<Exact>> = matrix.to_vec();
    let mut b = rhs.to_vec();
    let zero = exact(c(0.0, 0.0));
    for col in 0..n {
        let pivot = (col..n).find(|&row| a[row][col] != zero).unwrap();
        a.swap(col, pivot);
        b.swap(col, pivot);
        for row in 0..n {
            if row != col && a[row][col] != zero {
                let factor = a[row][col].clone() / a[col][col].clone();
                let pivot_row = a[col].clone();
                for (entry, above) in a[row].iter_mut().zip(pivot_row).skip(col) {
                    *entry = entry.clone() - factor.clone() * above;
                }
                let change = factor * b[col].clone();
                b[row] = b[row].clone() - change;
            }
        }
    }
    (0..n).map(|i| b[i].clone() / a[i][i].clone()).collect()
}

/// A model whose A₀ at ω with ω² irrelevant is `a0` and whose unknown term is `a1`.
fn random_model(n: usize, a0: &[c64], a1: &[c64]) -> DynamicStiffness {
    DynamicStiffness::new(vec![
        term("fixed", Role::Stiffness, full(n, a0), c(1.0, 0.0)),
        term("unknown", Role::Stiffness, full(n, a1), c(0.5, 0.25)),
    ])
    .unwrap()
}

#[test]
fn derivatives_equal_exact_rational_arithmetic() {
    let n = 5;
    let a0: Vec<c64> = (0..15).map(|k| c(f64::from(k * k % 11) - 3.0, f64::from(k % 4) + 0.5)).collect();
    let a1: Vec<c64> = (0..15).map(|k| c(f64::from(k * 7 % 9) - 4.0, f64::from(k % 3) - 1.0)).collect();
    let model = random_model(n, &a0, &a1);
    let experiment = tip_load(&model, &[0, 2, 4]);
    let parameter = Parameter::factor_of(&model, &["unknown"]).unwrap();
    let at = model.at(1.0, &[parameter]).unwrap();
    let dense = |values: &dyn Fn(usize, usize) -> c64| -> Vec<Vec<Exact>> {
        (0..n).map(|i| (0..n).map(|j| exact(values(i, j))).collect()).collect()
    };
    let terms = model.terms();
    let nominal = dense(&|i, j| terms[0].matrix.get(i, j) + c(0.5, 0.25) * terms[1].matrix.get(i, j));
    let change = dense(&|i, j| terms[1].matrix.get(i, j));
    let series = NeumannSeries::new(&FullModel::new(at, &experiment).unwrap(), 0, 10).unwrap();
    // ∂ᵏx/∂cᵏ = −k A₀⁻¹A₁ ∂ᵏ⁻¹x/∂cᵏ⁻¹, P-26, without a single rounding.
    let mut derivative =
        solve_exactly(&nominal, &experiment.load.iter().map(|&f| exact(f)).collect::<Vec<_>>());
    for k in 0..=10usize {
        if k > 0 {
            let factor =
                Exact::new(BigRational::from(BigInt::from(-(k as i64))), BigRational::from(BigInt::from(0)));
            let product: Vec<Exact> = (0..n)
                .map(|i| {
                    let zero = exact(c(0.0, 0.0));
                    (0..n).fold(zero, |sum, j| sum + change[i][j].clone() * derivative[j].clone())
                        * factor.clone()
                })
                .collect();
            derivative = solve_exactly(&nominal, &product);
        }
        let found = series.derivative(k).unwrap();
        for (sensor, row) in [0usize, 2, 4].into_iter().enumerate() {
            let expected = rounded(&derivative[row]);
            let relative = (found[sensor] - expected).norm() / expected.norm();
            assert!(relative < 1e-10, "order {k}, row {row}: {relative:e}");
        }
    }
    assert_eq!(series.derivative(11), None);
}

#[test]
fn derivatives_of_a_structure_equal_contour_integrals() {
    // A hysteretic chain between its first and second resonance, modulus of 1e11: raw derivatives would overflow.
    let e = c(2e11, 1e10);
    let model = chain(80, e, 3e3);
    let experiment = tip_load(&model, &[79, 40]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let system = FullModel::new(model.at(45.0, &[parameter]).unwrap(), &experiment).unwrap();
    let series = NeumannSeries::new(&system, 0, 10).unwrap();
    // The integral knows a coefficient to roundoff of the largest: the nearer r is to the radius, the less they fall.
    let r = 0.7 / convergence_radius(&system, 0).unwrap().per_unit;
    for sensor in 0..2 {
        let oracle = taylor_on_circle(&system, r, 11, sensor);
        for (k, expected) in oracle.iter().enumerate() {
            let found = series.derivative(k).unwrap()[sensor];
            let factorial: f64 = (1..=k).map(|j| j as f64).product();
            let found = found / factorial * r.powi(k as i32);
            assert!(
                (found - expected).norm() < 1e-10 * expected.norm(),
                "order {k}: {found} against {expected}"
            );
        }
    }
}

#[test]
fn density_and_damper_are_parameters_like_any_other() {
    let e = c(4e4, 2e3);
    let mut terms = chain(30, e, 2.0).terms().to_vec();
    let mut damper = frfit_linalg::sparse::Triplets::new(30);
    damper.add(12, 12, 1.0);
    terms.push(term("damper", Role::Viscous, damper.assemble(), c(15.0, 0.0)));
    let model = DynamicStiffness::new(terms).unwrap();
    let experiment = tip_load(&model, &[29]);
    for (name, change) in [("masses", c(0.02, 0.0)), ("damper", c(3.0, 0.0)), ("springs", c(400.0, 900.0))] {
        let parameter = Parameter::factor_of(&model, &[name]).unwrap();
        let system = FullModel::new(model.at(7.0, &[parameter]).unwrap(), &experiment).unwrap();
        let rho = convergence_radius(&system, 0).unwrap().at(change);
        assert!(rho < 0.6, "{name}: the test wants a convergent case, ρ = {rho}");
        let series = NeumannSeries::new(&system, 0, 60).unwrap();
        let (found, expected) = (series.respond(change, 60)[0], system.solve_at(&[change]).unwrap()[0]);
        // ρ⁶¹ is below 1e-13; the rest is roundoff of two solves.
        assert!((found - expected).norm() < 1e-11 * expected.norm(), "{name}: {found} against {expected}");
    }
}

#[test]
fn a_parameter_that_is_nominally_absent_has_a_scale_too() {
    let mut terms = chain(10, c(100.0, 5.0), 1.0).terms().to_vec();
    let mut spring = frfit_linalg::sparse::Triplets::new(10);
    spring.add(9, 9, 1.0);
    terms.push(term("support", Role::Stiffness, spring.assemble(), c(0.0, 0.0)));
    let model = DynamicStiffness::new(terms).unwrap();
    let experiment = tip_load(&model, &[9]);
    let parameter = Parameter::factor_of(&model, &["support"]).unwrap();
    let system = FullModel::new(model.at(0.1, &[parameter]).unwrap(), &experiment).unwrap();
    let series = NeumannSeries::new(&system, 0, 40).unwrap();
    let change = c(0.3 / convergence_radius(&system, 0).unwrap().per_unit, 0.0);
    let expected = system.solve_at(&[change]).unwrap()[0];
    assert!((series.respond(change, 40)[0] - expected).norm() < 1e-13 * expected.norm());
}

#[test]
fn work_is_one_factorisation_and_one_solve_a_term() {
    let model = chain(60, c(1e4, 500.0), 1.0);
    let experiment = tip_load(&model, &[59, 3]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let system = FullModel::new(model.at(3.0, &[parameter]).unwrap(), &experiment).unwrap();
    NeumannSeries::new(&system, 0, 30).unwrap();
    assert_eq!(system.work(), Work { factorisations: 1, solves: 31 });
    system.solve_at(&[c(1.0, 0.0)]).unwrap();
    assert_eq!(system.work(), Work { factorisations: 2, solves: 32 });
}

#[test]
fn radius_of_a_chain_is_the_distance_to_its_nearest_pole() {
    // D = E K − ω² M is singular at E = ω²/λ_j, λ_j = 4 sin²((2j − 1)π/(4n + 2)) of the clamped–free chain.
    let (n, e, f) = (40, c(1e4, 300.0), 5.0);
    let model = chain(n, e, 1.0);
    let experiment = tip_load(&model, &[0]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let system = FullModel::new(model.at(f, &[parameter]).unwrap(), &experiment).unwrap();
    let omega2 = (std::f64::consts::TAU * f).powi(2);
    let distance = (1..=n)
        .map(|j| 4.0 * ((2 * j - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64).sin().powi(2))
        .map(|lambda| (e - omega2 / lambda).norm())
        .fold(f64::INFINITY, f64::min);
    let radius = convergence_radius(&system, 0).unwrap();
    // The residual is below 1e-4, and the eigenvalue's error of the order of its square.
    assert!(radius.converged && (radius.per_unit * distance - 1.0).abs() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Neumann = Taylor: the series' coefficients are those of the exact response, for random complex symmetric systems
    /// and for parameters that enter with a power (B-8).
    #[test]
    fn neumann_is_taylor(
        n in 2usize..7,
        power in 1usize..4,
        values in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 56),
    ) {
        let number = |k: usize| c(values[k].0, values[k].1);
        let mut a0: Vec<c64> = (0..28).map(number).collect();
        a0[0] += c(0.0, 4.0);
        // Diagonally dominant, so that the nominal system is well posed whatever was drawn.
        let mut diagonal = frfit_linalg::sparse::Triplets::new(n);
        (0..n).for_each(|i| diagonal.add(i, i, 8.0));
        let model = DynamicStiffness::new(vec![
            term("fixed", Role::Stiffness, full(n, &a0), c(1.0, 0.0)),
            term("dominant", Role::Stiffness, diagonal.assemble(), c(1.0, 0.0)),
            term("unknown", Role::Stiffness, full(n, &(28..56).map(number).collect::<Vec<_>>()), c(0.0, 0.0)),
        ]).unwrap();
        let experiment = Experiment::driven_at(
            n, Sensor { row: 0, sign: 1.0 }, vec![Sensor { row: n - 1, sign: -1.0 }]);
        let nominal = c(0.4, 0.1);
        let system = FullModel::new(model.at(1.0, &[unknown(2, power, nominal)]).unwrap(), &experiment).unwrap();
        let radius = convergence_radius(&system, 0).unwrap();
        prop_assume!(radius.per_unit > 1e-3);
        let r = 0.3 / radius.per_unit;
        let series = NeumannSeries::new(&system, 0, 8).unwrap();
        let oracle = taylor_on_circle(&system, r, 9, 0);
        let size = oracle.iter().map(|a| a.norm()).fold(0.0, f64::max);
        for (k, expected) in oracle.iter().enumerate() {
            let found = series.coefficients(0)[k] * (r / series.scale()).powi(k as i32);
            // The contour integral knows each coefficient to roundoff of the largest.
            prop_assert!((found - expected).norm() < 1e-12 * size, "order {}: {} against {}", k, found, expected);
        }
    }

    /// Exact at c = 0; elsewhere the error falls like ρ^{n+1}.
    #[test]
    fn error_falls_with_the_spectral_radius(
        frequency_hz in 0.5f64..12.0,
        rho in 0.2f64..0.7,
        angle in 0.0f64..std::f64::consts::TAU,
    ) {
        let model = chain(25, c(1e4, 1e3), 1.0);
        let experiment = tip_load(&model, &[24]);
        let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
        let system = FullModel::new(model.at(frequency_hz, &[parameter]).unwrap(), &experiment).unwrap();
        let series = NeumannSeries::new(&system, 0, 60).unwrap();
        let direct = system.solve_at(&[c64::default()]).unwrap()[0];
        prop_assert!((series.respond(c64::default(), 60)[0] - direct).norm() <= 1e-13 * direct.norm());
        let change = c64::from_polar(rho / convergence_radius(&system, 0).unwrap().per_unit, angle);
        let exact = system.solve_at(&[change]).unwrap()[0];
        let error = |n: usize| (series.respond(change, n)[0] - exact).norm();
        // The tail is Σ_{k>n} of terms that fall like ρᵏ times a modal constant; the constant is bounded by what the
        // first terms show, over all orders at once, with ρ raised by 5 % for the other modes' beat.
        let size = (0..4).map(|n| error(n) / (rho * 1.05).powi(n as i32 + 1)).fold(exact.norm(), f64::max);
        for n in [8, 16, 24, 32] {
            let bound = 20.0 * size * (rho * 1.05).powi(n as i32 + 1) + 1e-12 * exact.norm();
            prop_assert!(error(n) <= bound, "order {}: {:e} above {:e}", n, error(n), bound);
        }
    }
}
