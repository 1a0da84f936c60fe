//! Poles and residues of the rational response against the series themselves and direct solves.

use crate::common;

use common::{Case, bar, beam, c, chain, plate, tip_load, unknown};
use frfit::c64;
use frfit::model::Parameter;
use frfit::rational::RationalResponse;
use frfit::response::FullModel;
use frfit::series::{NeumannSeries, convergence_radius};
use frfit_fem::Mass;

fn springs() -> Case {
    let model = chain(40, c(1e4, 100.0), 1.0);
    let experiment = tip_load(&model, &[39, 10]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    Case { name: "chain", model, experiment, parameter, band_hz: [0.5, 10.0], box_ratio: [0.5, 2.0] }
}

fn cases() -> [Case; 4] {
    [springs(), bar(60), beam(20, 1e-2, Mass::Consistent), plate(8, 0.4, 1e-2)]
}

#[test]
fn the_predicted_order_is_the_one_that_the_series_needs() {
    let (mut tried, mut long) = (0, 0);
    for case in cases() {
        for (frequency_hz, _) in case.scattered(5) {
            let system = FullModel::new(case.at(frequency_hz), &case.experiment).unwrap();
            let poles = RationalResponse::new(&system, 0, 40).unwrap().poles().unwrap().unwrap();
            let series = NeumannSeries::new(&system, 0, 100).unwrap();
            let radius = convergence_radius(&system, 0).unwrap();
            for rho in [0.05, 0.3, 0.6, 0.8, 0.9] {
                for angle in [0.0, 1.0, 3.0] {
                    let correction = c64::from_polar(rho / radius.per_unit, angle);
                    let exact = case.direct(frequency_hz, correction).unwrap();
                    for (m, exact) in exact.iter().enumerate() {
                        let order = poles.required_order(m, correction, 1e-6).unwrap();
                        if order > series.order() {
                            continue;
                        }
                        let error = |order: usize| {
                            (series.respond(correction, order)[m] - exact).norm() / exact.norm()
                        };
                        let at = || format!("{} at {frequency_hz} Hz, ρ {rho}, order {order}", case.name);
                        // Each pole's share is below 1e-6, a few of them add up to more.
                        assert!(error(order) < 1e-5, "{}: {:e}", at(), error(order));
                        if order >= 3 {
                            assert!(error(order - 3) > 1e-6, "{}: {:e}", at(), error(order - 3));
                        }
                        tried += 1;
                        long += usize::from(order > 30);
                    }
                }
            }
            for rho in [1.01, 1.5, 10.0] {
                // Every mode of these structures is driven, and seen by one of the sensors.
                let correction = c64::from_polar(rho / radius.per_unit, 0.5);
                let mut sensors = 0..case.experiment.sensors.len();
                let diverges = sensors.any(|m| poles.required_order(m, correction, 1e-6).is_none());
                assert!(diverges, "{} ρ {rho}", case.name);
            }
            assert!((poles.radius_per_unit() / radius.per_unit - 1.0).abs() < 1e-3);
            assert_eq!(poles.required_order(0, c64::default(), 1e-6), Some(0));
        }
    }
    assert!(tried > 400 && long > 100, "{tried} {long}");
}

#[test]
fn the_sum_over_the_poles_is_the_rational_response() {
    for case in cases() {
        for (frequency_hz, ratio) in case.scattered(8) {
            let system = FullModel::new(case.at(frequency_hz), &case.experiment).unwrap();
            let rational = RationalResponse::new(&system, 0, 40).unwrap();
            let poles = rational.poles().unwrap().unwrap();
            let correction = case.correction(frequency_hz, ratio);
            let (values, slopes) = poles.respond_with_slope(correction);
            let (exact, exact_slopes) = rational.respond_with_slope(correction).unwrap();
            for m in 0..values.len() {
                // Good for the way to a solution, not for its last digits.
                assert!((values[m] - exact[m]).norm() < 1e-7 * exact[m].norm(), "{}", case.name);
                assert!(
                    (slopes[m] - exact_slopes[m]).norm() < 1e-6 * exact_slopes[m].norm(),
                    "{}",
                    case.name
                );
            }
        }
    }
}

#[test]
fn a_parameter_with_powers_has_no_poles_of_this_kind() {
    let case = springs();
    let at = case.model.at(3.0, &[unknown(0, 2, c(100.0, 1.0))]).unwrap();
    let system = FullModel::new(at, &case.experiment).unwrap();
    assert_eq!(RationalResponse::new(&system, 0, 8).unwrap().poles().unwrap(), None);
}
