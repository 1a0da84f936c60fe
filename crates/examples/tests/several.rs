//! What the READMEs of the examples with several unknowns promise, from the files as they are written.

use crate::common;
use crate::tier::of_tier;

use common::Folder;
use frfit::for_each::sequential;
use frfit::identify::{Context, Explained, Frfs, Identification, Noise, Options, Problem, Status, identify};
use frfit::material::{Law, loss_factor};
use frfit::model::{Experiment, Sensor};
use frfit_examples::{SeveralModel, added_mass, joint_stiffness, plate_thickness, two_materials};
use frfit_formats::csv;

/// Within so many standard deviations a number is right: beyond are 3 of 1000, and the noise of a file is the same each time. Coverage itself is tested over seeds
/// (`crates/core/tests/several.rs`).
const DEVIATIONS: f64 = 3.0;

/// Of exact data: far below any reading of a modulus, far above what 13 digits of a measurement leave.
const RIGHT: f64 = 1e-5;

fn identified(name: &str, model: &SeveralModel) -> Identification {
    identified_from(name, model, 1)
}

/// From every so manieth line of the files.
fn identified_from(name: &str, model: &SeveralModel, step: usize) -> Identification {
    let folder = Folder::new(name);
    let (frequency_hz, measured) = folder.measured();
    let std = (model.noise > 0.0).then(|| {
        // As the case reads it: files give √E|δH|² of what was measured, the method takes that of receptances.
        let of_sensor = |m: usize| -> Vec<f64> {
            let table = csv::read_frf(folder.bytes(&format!("frf-{}.csv", m + 1))).unwrap();
            let relative = table.std.unwrap().into_iter().zip(table.response).map(|(s, u)| s / u.norm());
            relative.zip(&measured).map(|(relative, x)| relative * x[m].norm()).collect()
        };
        let sensors: Vec<Vec<f64>> = (0..model.experiment.sensors.len()).map(of_sensor).collect();
        (0..frequency_hz.len()).map(|k| sensors.iter().map(|s| s[k]).collect()).collect::<Vec<Vec<f64>>>()
    });
    let frequency_hz: Vec<f64> = frequency_hz.into_iter().step_by(step).collect();
    let measured: Vec<_> = measured.into_iter().step_by(step).collect();
    let std: Option<Vec<_>> = std.map(|std| std.into_iter().step_by(step).collect());
    let frfs = Frfs {
        frequency_hz: &frequency_hz,
        receptance: &measured,
        noise: std.as_deref().map_or(Noise::Unknown, Noise::Known),
    };
    let problem = Problem::new(&model.stiffness, &model.experiment, &model.unknowns, &[], frfs).unwrap();
    let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
    identify(&problem, &Options::default(), context).unwrap()
}

/// Every number of the unknowns that hold for the band, with its standard deviation, its truth, and the relative bar that the README promises.
fn constants_are_within_their_bars(name: &str, model: &SeveralModel, bars: &[f64]) {
    let found = identified(name, model);
    assert!(found.is_trusted() && found.search.converged, "{name}");
    assert!(found.lines.iter().all(|at| at.status == Status::Ok), "{name}");
    assert_eq!(found.fit.unwrap().verdict, Explained::Yes, "{name}");
    let mut promised = bars.iter();
    for value in &found.constants {
        let truth = model.truth[value.unknowns].at(100.0).unwrap();
        let exact = [truth.re, loss_factor(truth)];
        assert_eq!(value.numbers.len(), if model.unknowns[value.unknowns].real { 1 } else { 2 }, "{name}");
        for (number, exact) in value.numbers.iter().zip(exact) {
            let (std, bar) = (number.std.unwrap(), promised.next().unwrap());
            let off = (number.value - exact).abs();
            assert!(off <= DEVIATIONS * std, "{name}, {}: {number:?} for {exact}", number.name);
            // A bar that is too long covers anything.
            assert!(2.0 * std < bar * exact, "{name}, {}: {number:?}", number.name);
        }
    }
    assert!(promised.next().is_none(), "{name}");
}

#[test]
fn the_thickness_of_a_plate() {
    constants_are_within_their_bars("plate-thickness", &plate_thickness(10).unwrap(), &[3e-5]);
}

#[test]
fn stiffness_and_damping_of_a_joint() {
    constants_are_within_their_bars("joint-stiffness", &joint_stiffness(20).unwrap(), &[1e-3, 2e-2]);
}

#[test]
fn the_mass_of_a_component_and_the_modulus_below_it() {
    constants_are_within_their_bars("added-mass", &added_mass(40).unwrap(), &[5e-4, 1e-4, 2e-2]);
}

#[test]
fn two_moduli_at_every_frequency() {
    let model = two_materials(30, 1, 1).unwrap();
    let found = identified_from("two-materials", &model, of_tier(3, 1));
    assert!(
        found.search.work.factorisations <= 4 && found.search.work.solves < 200,
        "{:?}",
        found.search.work
    );
    for at in &found.lines {
        assert_eq!(at.status, Status::Ok, "{} Hz", at.frequency_hz);
        for (value, truth) in at.values.iter().zip(&model.truth) {
            let truth = truth.at(at.frequency_hz).unwrap();
            let off = (value.value.unwrap() - truth).norm() / truth.norm();
            assert!(off < RIGHT, "{} Hz: off by {off:e}", at.frequency_hz);
        }
    }
}

#[test]
fn models_scale() {
    let rows = |model: SeveralModel| (model.dofs.len(), model.stiffness.dim());
    assert_eq!(rows(plate_thickness(4).unwrap()), (60, 60));
    assert_eq!(rows(joint_stiffness(3).unwrap()), (13, 13));
    assert_eq!(rows(added_mass(5).unwrap()), (10, 10));
    assert_eq!(rows(two_materials(4, 2, 3).unwrap()), (216, 216));
    for broken in [plate_thickness(0), joint_stiffness(0), added_mass(0), two_materials(0, 1, 1)] {
        assert!(broken.is_err());
    }
    assert!(joint_stiffness(usize::MAX).is_err());
}

/// A joint as stiff as a weld makes one beam of the two, one that holds nothing lets the second go.
#[test]
fn a_stiff_joint_is_none_and_a_loose_one_holds_nothing() {
    let mut model = joint_stiffness(6).unwrap();
    let tip = Sensor { row: model.dofs.len() - 2, sign: 1.0 };
    model.experiment = Experiment::driven_at(model.dofs.len(), tip, vec![tip]);
    // L³/3EI of one beam of 0.7 m, 30 mm × 8 mm, steel.
    let statically = 0.7_f64.powi(3) / (3.0 * 2.1e11 * 0.03 * 0.008_f64.powi(3) / 12.0);
    let mut at = |stiffness: f64| {
        model.truth = vec![Law::complex_modulus(stiffness, 0.0)];
        model.exact(&[0.1]).unwrap()[0][0].norm()
    };
    // 0.1 Hz over the first resonance of 13 Hz, squared, is 6e-5; the loss factor of 1e-3 enters squared.
    let welded = at(1e12);
    assert!((welded / statically - 1.0).abs() < 1e-4, "{welded} for {statically}");
    // Nothing but inertia is left of the second beam.
    assert!(at(1e-6) > 10.0 * statically);
}
