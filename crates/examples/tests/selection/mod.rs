//! The joint choice among all exact moduli of a band, B-4, on models whose modulus is known.

mod band;

use crate::tier::of_tier;

use band::{Band, Setup, band};
use frfit::dof::Axis;
use frfit::frequency::linear_hz;
use frfit::material::Law;
use frfit::model::Sensor;
use frfit::select::{SelectOptions, choose};
use frfit_examples::{Model, clamped_plate, rubber_bar_end, sandwich};

/// What became of the frequencies of a band.
#[derive(Debug, PartialEq, Eq)]
struct Count {
    /// Frequencies at which the true node is there.
    present: usize,
    /// Right, no alternative.
    right: usize,
    /// Right, but ambiguous.
    ambiguous: usize,
    /// Wrong without a warning.
    wrong: usize,
}

/// A node is right within 1e-6, or four standard deviations.
fn count(band: &Band, sensors: usize, sigma_known: bool) -> Count {
    let choices = choose(
        &band.frequency_hz,
        &band.nodes,
        &SelectOptions::default().with_sensors(sensors).with_sigma_known(sigma_known),
    );
    let mut count = Count { present: 0, right: 0, ambiguous: 0, wrong: 0 };
    for ((choice, nodes), truth) in choices.iter().zip(&band.nodes).zip(&band.truth) {
        let is_right = |index: usize| {
            let node = nodes[index];
            let scatter = if sigma_known { 4.0 * node.std } else { 0.0 };
            (node.factor - truth).norm() <= 1e-6 * truth.norm() + scatter
        };
        count.present += usize::from((0..nodes.len()).any(is_right));
        match choice.chosen {
            Some(index) if !is_right(index) => count.wrong += usize::from(choice.rivals.is_empty()),
            Some(_) if choice.rivals.is_empty() => count.right += 1,
            Some(_) => count.ambiguous += 1,
            None => {}
        }
    }
    count
}

/// The same candidates where only the sensor that gave them is there.
fn one_sensor(mut band: Band) -> Band {
    band.nodes.iter_mut().flatten().for_each(|node| node.misfit = 0.0);
    band
}

fn all(count: usize) -> Count {
    Count { present: count, right: count, ambiguous: 0, wrong: 0 }
}

/// Several moduli at each frequency, or the test shows nothing.
fn is_hard(band: &Band) -> bool {
    band.nodes.iter().map(Vec::len).sum::<usize>() > 2 * band.nodes.len()
}

const BAR: Setup = Setup { sensors: 2, noise: 0.0, order: 60, storage: [0.2, 5.0], loss_factor: [0.0, 3.0] };
const PLATE: Setup =
    Setup { sensors: 2, noise: 0.0, order: 40, storage: [0.2, 5.0], loss_factor: [0.0, 1.0] };

/// A clamped plate with another loss factor, nominally (1 + δ) times as stiff, with a second sensor.
fn plate(loss_factor: f64, delta: f64) -> Model {
    let mut model = clamped_plate(5).unwrap();
    model.truth = Law::complex_modulus(2.0e11, loss_factor);
    model.parameter.nominal = Law::complex_modulus((1.0 + delta) * 2.0e11, loss_factor);
    // Deflection of a node a third of the way through the numbering.
    let third = model.dofs.len() / 3;
    let row = (third..model.dofs.len())
        .find(|&row| model.dofs[row].is_some_and(|name| name.axis == Axis::Z))
        .unwrap();
    model.experiment.sensors.push(Sensor { row, sign: 1.0 });
    model
}

#[test]
fn a_bar_of_rubber_driven_at_one_end_and_measured_at_the_other() {
    let band = band(&rubber_bar_end(24).unwrap(), linear_hz(20.0, 2000.0, 300), &BAR);
    assert!(is_hard(&band));
    assert_eq!(count(&band, 2, false), all(300));
    assert_eq!(count(&one_sensor(band), 1, false), all(300));
}

#[test]
fn a_plate_through_its_resonances() {
    for (loss_factor, delta) in [(1e-3, 0.25), (1e-3, -0.5), (1e-5, -0.25)].into_iter().skip(of_tier(1, 0)) {
        let band = band(&plate(loss_factor, delta), linear_hz(100.0, 4000.0, 100), &PLATE);
        assert!(is_hard(&band));
        assert_eq!(count(&band, 2, false), all(100), "{loss_factor} {delta}");
        assert_eq!(count(&one_sensor(band), 1, false), all(100), "{loss_factor} {delta}");
    }
}

#[test]
fn a_core_of_rubber_in_a_sandwich() {
    let band = band(&sandwich(4, 1, 1).unwrap(), linear_hz(20.0, 1000.0, 50), &BAR);
    assert_eq!(count(&band, 2, false), all(50));
    assert_eq!(count(&one_sensor(band), 1, false), all(50));
}

#[test]
fn noise_of_one_percent_on_two_sensors() {
    let noisy = |setup| Setup { noise: 0.01, ..setup };
    let bar = band(&rubber_bar_end(24).unwrap(), linear_hz(20.0, 2000.0, of_tier(80, 150)), &noisy(BAR));
    // Lightly damped: noise pushes a third of the loss factors below zero, out of bounds.
    let plate = band(&plate(1e-3, 0.25), linear_hz(100.0, 4000.0, 100), &noisy(PLATE));
    for band in [bar, plate] {
        let count = count(&band, 2, true);
        assert_eq!(count.wrong, 0, "{count:?}");
        assert!(count.right as f64 >= 0.96 * count.present as f64 && count.present > 50, "{count:?}");
    }
}
