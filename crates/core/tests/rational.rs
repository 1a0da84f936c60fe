//! The rational response where the series fails: on and between the resonances of lightly damped structures.

use crate::common;

use common::{c, chain, tip_load, unknown};
use frfit::c64;
use frfit::model::{DynamicStiffness, Experiment, Parameter};
use frfit::rational::RationalResponse;
use frfit::response::{FullModel, Response};
use frfit::series::{NeumannSeries, convergence_radius};
use proptest::prelude::*;

fn springs(model: &DynamicStiffness) -> Parameter {
    Parameter::factor_of(model, &["springs"]).unwrap()
}

#[test]
fn reaches_far_beyond_the_circle_of_convergence() {
    // η = 1e-3, driven between resonances; the series diverges at twice its radius, the rational response does not.
    let model = chain(40, c(1e4, 10.0), 1.0);
    let experiment = tip_load(&model, &[39, 10]);
    let system = FullModel::new(model.at(4.0, &[springs(&model)]).unwrap(), &experiment).unwrap();
    let rational = RationalResponse::new(&system, 0, 39).unwrap();
    let series = NeumannSeries::new(&system, 0, 39).unwrap();
    let radius = convergence_radius(&system, 0).unwrap();
    let change = c(2.0 / radius.per_unit, 0.0);
    let exact = system.solve_at(&[change]).unwrap();
    let error = |x: &[c64]| (x[0] - exact[0]).norm() / exact[0].norm();
    assert!(error(&series.respond(change, 39)) > 1.0);
    // 40 unknowns, 40 vectors: the reduction is the whole, the rest is roundoff times the condition near a resonance.
    assert!(error(&rational.respond(change).unwrap()) < 1e-8);
    assert!(rational.residual(change).unwrap() < 1e-8);
}

#[test]
fn the_residual_is_that_of_the_full_system() {
    let model = chain(200, c(1e4, 100.0), 1.0);
    let experiment = tip_load(&model, &[199]);
    let system = FullModel::new(model.at(2.0, &[springs(&model)]).unwrap(), &experiment).unwrap();
    let rational = RationalResponse::new(&system, 0, 6).unwrap();
    let exact_at = |change| system.solve_at(&[change]).unwrap()[0];
    // At the nominal value the first basis vector alone is the answer.
    assert!(rational.residual(c64::default()).unwrap() < 1e-12);
    // Away from it, a small residual comes with a small error, and more vectors bring both down.
    let change = c(-2e3, 50.0);
    let (mut last, mut reached) = (f64::INFINITY, 0);
    for order in [4, 8, 12, 16, 20] {
        let rational = RationalResponse::new(&system, 0, order).unwrap();
        let residual = rational.residual(change).unwrap();
        let error = (rational.respond(change).unwrap()[0] / exact_at(change) - 1.0).norm();
        // The residual is Galerkin's, not the smallest: it may stand still for a step, but falls over two.
        assert!(residual < 10.0 * last, "order {order}: {residual:e} after {last:e}");
        if residual < 1e-10 {
            reached += 1;
            assert!(error < 1e-6, "order {order}: {error:e}"); // condition of D below 1e4 here
        }
        last = residual;
    }
    assert!(reached > 0);
}

#[test]
fn one_solve_for_each_basis_vector() {
    let model = chain(100, c(1e4, 100.0), 1.0);
    let experiment = tip_load(&model, &[99]);
    let system = FullModel::new(model.at(2.0, &[springs(&model)]).unwrap(), &experiment).unwrap();
    let rational = RationalResponse::new(&system, 0, 10).unwrap();
    assert_eq!(rational.size(), 11);
    assert_eq!((system.work().factorisations, system.work().solves), (1, 11));
}

/// The relative distance of the nearest root to the planted correction.
fn distance(rational: &RationalResponse, measured: c64, planted: c64) -> f64 {
    let roots = rational.roots(0, measured).unwrap();
    roots.iter().map(|root| (root.correction - planted).norm() / planted.norm()).fold(f64::INFINITY, f64::min)
}

#[test]
fn finds_every_modulus_that_explains_one_sensor() {
    // A chain of n masses: x_m(E) = u is a polynomial equation in E of degree n with m = the driven row; all its roots solve the
    // full system too, checked here by a fresh direct solve.
    let n = 8;
    let model = chain(n, c(1e4, 100.0), 1.0);
    let experiment: Experiment = tip_load(&model, &[n - 1]);
    let system = FullModel::new(model.at(9.0, &[springs(&model)]).unwrap(), &experiment).unwrap();
    let truth = c(-2.5e3, -30.0);
    let measured = system.solve_at(&[truth]).unwrap()[0];
    let rational = RationalResponse::new(&system, 0, n - 1).unwrap();
    let roots = rational.roots(0, measured).unwrap();
    assert_eq!(roots.len(), n, "{roots:?}");
    for root in &roots {
        let again = system.solve_at(&[root.correction]).unwrap()[0];
        assert!((again - measured).norm() < 1e-7 * measured.norm(), "{root:?}");
    }
    assert!(distance(&rational, measured, truth) < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The planted correction is among the roots, through resonances, whatever the power with which the parameter enters (B-8).
    #[test]
    fn the_truth_is_among_the_roots(
        frequency_hz in 0.5f64..20.0,
        change in -0.5f64..0.5,
        loss in 1e-3f64..0.1,
        power in 1usize..4,
    ) {
        prop_assume!(change.abs() > 0.02);
        let n = 6;
        let model = chain(n, c(1e4, 1e4 * loss), 1.0);
        let nominal = c(20.0, 10.0 * loss);
        let at = model.at(frequency_hz, &[unknown(0, power, nominal)]).unwrap();
        let experiment = tip_load(&model, &[0]);
        let Ok(system) = FullModel::new(at, &experiment) else { return Ok(()) };
        let truth = nominal * change;
        let measured = system.solve_at(&[truth]).unwrap()[0];
        let rational = RationalResponse::new(&system, 0, n - 1).unwrap();
        prop_assert_eq!(rational.size(), n);
        // A solution is as good as its response is sensitive: near a stationary point, the square root of roundoff.
        let found = distance(&rational, measured, truth);
        prop_assert!(found < 1e-5, "{found:e}");
    }
}
