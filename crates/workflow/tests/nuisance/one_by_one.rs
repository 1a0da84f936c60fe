//! Sensors that were measured one after the other, on a structure that warms up: each has its own natural frequencies.

use super::planted::{TRUTH, folder, receptance, run, table};
use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::{Line, Status};
use frfit_workflow::job::IdentifyJob;
use std::f64::consts::TAU;
use tempfile::TempDir;

const SHARE: f64 = 0.003;

/// The second sensor was measured with springs that are stiffer by this factor: the same response at a higher frequency.
fn measured(frequency_hz: &[f64], stiffer: f64) -> TempDir {
    let at: Vec<f64> = frequency_hz.iter().map(|f| f / stiffer.sqrt()).collect();
    let first: Vec<c64> = receptance(&[], &[5], frequency_hz).into_iter().map(|row| row[0]).collect();
    let second: Vec<c64> = receptance(&[], &[7], &at).into_iter().map(|row| row[0] / stiffer).collect();
    // Noise of the standard deviation that is given, with a phase from Knuth's generator.
    let mut state = 1_u64;
    let mut noisy = |value: c64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        value * (1.0 + c64::from_polar(SHARE, (state >> 11) as f64 / (1_u64 << 53) as f64 * TAU))
    };
    let mut noisy = |values: Vec<c64>| values.into_iter().map(&mut noisy).collect::<Vec<c64>>();
    let tables = [noisy(first), noisy(second)].map(|values| table(frequency_hz, &values, Some(SHARE)));
    let one = |m: usize| {
        format!("[[measurement]]\nfile = \"{m}.csv\"\nrow = {}\nquantity = \"receptance\"\n", 6 + 2 * m)
    };
    let identify = "[identify]\nmatrix = \"springs\"\nband_hz = [10.0, 120.0]\n\
                    bounds = { storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }\n";
    folder(&tables, &format!("{}{}{identify}", one(0), one(1)))
}

/// How many error bars the storage of an `ok` line is off at most.
fn farthest(job: &IdentifyJob) -> f64 {
    let off = |line: &Line| {
        let std = line.uncertainty()?.storage_std;
        (line.status == Status::Ok).then(|| (line.storage().unwrap() - TRUTH.re).abs() / std)
    };
    job.run.found.lines.iter().filter_map(off).fold(0.0, f64::max)
}

#[test]
fn natural_frequencies_of_each_sensor_are_found_and_are_in_the_error_bars() {
    let frequency_hz = linear_hz(10.3, 119.7, 330);
    let warm = run(&measured(&frequency_hz, 1.01)).unwrap();
    let shifts = warm.case.corrections().unwrap().shifts.unwrap();
    // Half of 1 % is the difference of both sensors.
    assert!(shifts.nats > 10.0 && (1e-3..1e-2).contains(&shifts.relative_std), "{shifts:?}");
    assert!(warm.summary["frequency_shifts"]["text"].as_str().unwrap().contains("sensor to sensor"));
    assert!(warm.run.count(Status::Ok) > 100 && farthest(&warm) < 4.0, "{}", farthest(&warm));
    let at_once = run(&measured(&frequency_hz, 1.0)).unwrap();
    assert_eq!(at_once.case.corrections().unwrap().shifts, None);
    assert!(at_once.summary["frequency_shifts"].is_null());
}
