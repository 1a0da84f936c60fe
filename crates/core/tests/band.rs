//! A band at once against direct solves of the full model.

mod common;

use common::{Case, bar, beam, plate, sandwich};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{Band, BandOutcome, Hooks, Identified, Noise, Options, Stage, identify_band, relative_error};
use frfit::material::Law;
use frfit::roots::Bounds;
use frfit_fem::Mass;

fn quiet(_: Stage, _: usize, _: usize) {}

fn scaled(law: &Law, by: f64) -> Law {
    match law {
        Law::Constant(value) => Law::Constant(value * by),
        Law::Fractional { e0, e1, alpha } => Law::Fractional { e0: e0 * by, e1: e1 * by, alpha: *alpha },
        Law::Table(_) => unreachable!("no test has one"),
    }
}

/// What would be measured if the factor were the case's nominal one: direct solves.
fn measured(case: &Case, frequency_hz: &[f64]) -> Vec<Vec<c64>> {
    frequency_hz.iter().map(|&f| case.direct(f, c64::default()).unwrap()).collect()
}

fn identify(case: &Case, frequency_hz: &[f64], measured: &[Vec<c64>], options: &Options) -> BandOutcome {
    let band = Band {
        model: &case.model,
        experiment: &case.experiment,
        parameter: &case.parameter,
        frequency_hz,
        measured,
        noise: Noise::Unknown,
    };
    identify_band(&band, options, Hooks { for_each: &sequential, progress: &quiet }).unwrap()
}

/// Distance of the nearest admitted root from the truth, relative to it.
fn nearest(outcome: &Identified, truth: c64) -> f64 {
    let admitted = outcome.roots.iter().filter(|root| root.refusal.is_none());
    admitted
        .map(|root| (outcome.nominal + root.correction - truth).norm() / truth.norm())
        .fold(f64::INFINITY, f64::min)
}


/// Wide bounds about a real factor of this size, passive.
fn within(size: f64, by: f64) -> Options {
    let bounds = Bounds { storage: Some([size / by, size * by]), loss_factor: Some([0.0, 2.0]) };
    Options { bounds, ..Options::default() }
}

/// Everything that an outcome says is a number.
fn assert_no_nan(outcome: &Identified) {
    let text = format!("{outcome:?}");
    assert!(!text.contains("NaN"), "{text}");
    let shown = [outcome.error, outcome.spectral_radius, outcome.certificate, outcome.pole_distance()];
    assert!(shown.iter().flatten().all(|value| value.is_finite()), "{text}");
}

/// The truth is an admitted root at every frequency, and what is chosen is what the full model says it is.
fn assert_truth(mut case: Case, offs: &[f64], frequencies: usize, digits: f64) {
    let truth = case.parameter.nominal.clone();
    let frequency_hz = linear_hz(case.band_hz[0], case.band_hz[1], frequencies);
    let u = measured(&case, &frequency_hz);
    for &off in offs {
        case.parameter.nominal = scaled(&truth, off);
        let options = within(truth.at(case.band_hz[1]).unwrap().re, 10.0);
        let band = identify(&case, &frequency_hz, &u, &options);
        assert!(band.subspace_size.is_some_and(|size| size < 130), "{:?}", band.subspace_size);
        for outcome in &band.outcomes {
            let f = outcome.frequency_hz;
            let missed = nearest(outcome, truth.at(f).unwrap());
            assert!(missed < digits, "{} × {off} at {f} Hz: {missed:e}", case.name);
            assert_no_nan(outcome);
            let correction = outcome.correction.unwrap();
            let exact = case.direct(f, correction).unwrap();
            let error = relative_error(&exact, &outcome.updated_response);
            let certificate = outcome.certificate.unwrap();
            assert!(error <= 5.0 * certificate, "{} × {off} at {f} Hz: {error:e} {certificate:e}", case.name);
        }
    }
}

/// Nominal over true factor.
const OFF: [f64; 6] = [1.25, 0.75, 1.5, 0.5, 3.0, 1.0 / 3.0];

#[test]
fn the_truth_is_admitted_on_plates_with_double_modes_and_almost_no_damping() {
    assert_truth(plate(8, 0.32, 1e-3), &OFF, 80, 1e-6);
    assert_truth(plate(8, 0.4, 1e-5), &OFF, 80, 1e-6);
}

#[test]
fn the_truth_is_admitted_on_bar_and_sandwich() {
    assert_truth(bar(80), &OFF, 80, 1e-6);
    assert_truth(sandwich(12, 1), &[1.25, 0.5, 3.0], 80, 1e-6);
}

#[test]
fn the_truth_is_admitted_on_antiresonances_and_resonances() {
    // The extremes of the response of a fine sweep, each with its neighbours.
    for case in [plate(8, 0.32, 1e-4), beam(20, 1e-4, Mass::Consistent)] {
        let sweep = linear_hz(case.band_hz[0], case.band_hz[1], 2000);
        let (model, _) = case.trained(1e-9);
        let size = |f: f64| model.projection().assess(&case.at(f), c64::default()).unwrap().response[0].norm();
        let sizes: Vec<f64> = sweep.iter().map(|&f| size(f)).collect();
        let extreme = |i: &usize| {
            let [a, b, c] = [sizes[i - 1], sizes[*i], sizes[i + 1]];
            (b - a) * (c - b) < 0.0
        };
        let found: Vec<f64> = (1..sweep.len() - 1).filter(extreme).map(|i| sweep[i]).collect();
        assert!(found.len() > 8, "{}", found.len());
        let last = found[found.len() - 1];
        let truth = case.parameter.nominal.clone();
        let u = measured(&case, &found);
        drop(model);
        let mut case = case;
        for off in [0.75, 1.5] {
            case.parameter.nominal = scaled(&truth, off);
            let band = identify(&case, &found, &u, &within(truth.at(last).unwrap().re, 10.0));
            for outcome in &band.outcomes {
                let missed = nearest(outcome, truth.at(outcome.frequency_hz).unwrap());
                assert!(missed < 1e-6, "{} at {} Hz: {missed:e}", case.name, outcome.frequency_hz);
            }
        }
    }
}
