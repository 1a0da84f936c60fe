//! The hammer test of the example: its records against the exact solution, and its nominal modulus.

use frfit::c64;
use frfit::signal::{Options, Recording, estimate_frf};
use frfit_examples::{hammer_accelerance, hammer_bar, hammer_records, hammer_rod, polyurethane};
use frfit_formats::lvm;
use std::f64::consts::TAU;

fn recordings(impacts: usize, noise: f64) -> Vec<Recording> {
    let file = lvm::read(&hammer_records(impacts, noise).unwrap()).unwrap();
    let recording = |segment: &lvm::Segment| {
        let [force, acceleration] = [0, 1].map(|k| segment.channels[k].values.clone());
        Recording { step_s: 0.3125e-3, force, responses: vec![acceleration] }
    };
    file.segments.iter().map(recording).collect()
}

#[test]
fn records_have_the_exact_frf_as_the_response_has_decayed() {
    let measured = estimate_frf(&recordings(1, 0.0), &Options::default()).unwrap();
    assert_eq!((measured.samples, measured.frequency_hz[0]), (1600, 2.0));
    assert!(measured.impacts[0].residual[0] < 1e-7);
    for (&f, h) in measured.frequency_hz.iter().zip(&measured.frfs[0].response).filter(|(f, _)| **f <= 1550.0)
    {
        let exact = hammer_accelerance(f);
        // What the ends of the record cut off: of the filter's ringing, which falls like 1/t³, and of the response. The filter
        // leaves 6 % of the force at 1550 Hz, and 1.2e-5 of error.
        assert!((h - exact).norm() < 3e-5 * exact.norm(), "{f} Hz: {:e}", (h - exact).norm() / exact.norm());
    }
}

#[test]
fn noise_is_told_by_the_variance() {
    let measured = estimate_frf(&recordings(16, 1e-3), &Options::default()).unwrap();
    assert_eq!(measured.averages(), 16);
    let variance = measured.frfs[0].variance.as_ref().unwrap();
    let lines = measured.frequency_hz.iter().enumerate().filter(|(_, f)| (200.0..1200.0).contains(*f));
    let ratios: Vec<f64> = lines
        .map(|(k, &f)| {
            (measured.frfs[0].response[k] - hammer_accelerance(f)).norm_sqr() / (2.0 * variance[k])
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    // 500 exponentially distributed numbers: 4.5 %; sixteen averages: 1/16 too small a variance.
    assert!((mean - 16.0 / 15.0).abs() < 0.25, "{mean}");
}

/// The nominal modulus is the constant one with the least |ΔH|² over 200 Hz to 300 Hz.
#[test]
fn the_nominal_fits_the_first_mode() {
    let lines: Vec<f64> = (100..=150).map(|k| 2.0 * f64::from(k)).collect();
    let misfit = |modulus: c64| -> f64 {
        let off = |&f: &f64| {
            let mut rod = hammer_rod(f);
            let measured = rod.free_free_end_force(TAU * f, 1.0, 0.0);
            rod.modulus = modulus;
            (rod.free_free_end_force(TAU * f, 1.0, 0.0) - measured).norm_sqr()
        };
        lines.iter().map(off).sum()
    };
    let model = hammer_bar(4).unwrap();
    let nominal = model.parameter.nominal.at(250.0).unwrap();
    // A step of a thousandth in any direction makes it worse.
    for direction in 0..8 {
        let step = c64::from_polar(1e-3 * nominal.norm(), TAU * f64::from(direction) / 8.0);
        assert!(misfit(nominal + step) > misfit(nominal), "{direction}");
    }
}

#[test]
fn the_law_is_passive_and_its_loss_falls_over_the_band() {
    let mut last = f64::INFINITY;
    for f in (1..=31).map(|k| 50.0 * f64::from(k)) {
        let modulus = polyurethane(f);
        assert!(modulus.im > 0.0 && modulus.im / modulus.re < last);
        last = modulus.im / modulus.re;
    }
}
