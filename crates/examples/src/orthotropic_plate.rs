//! A plate of spruce that hangs free: four constants of an orthotropic material, from the records of five impacts.

use crate::hammer_test::{HammerTest, Recorded};
use crate::model::{names, nearest, real, term};
use crate::{Error, SeveralModel};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use frfit::subspace::{Point, Subspace, TrainOptions};
use frfit_fem::{Direction, OrthotropicPlate, inset_lines};
use std::ops::Range;

/// Length along the grain, width across it, in m, and thickness in m.
const SIDES: [f64; 2] = [0.58, 0.217];
const THICKNESS: f64 = 0.005;

/// Density in kg/m³: 0.2498 kg over the volume.
const DENSITY: f64 = 397.0;

/// Where the plate is hit, and measured at the opposite corner: from both edges, in m.
const INSET: f64 = 0.02;

/// One of the four constants.
struct Constant {
    name: &'static str,
    /// Nominal and true value in Pa, each with its loss factor.
    nominal: [f64; 2],
    truth: [f64; 2],
    /// Bounds of the value in Pa.
    bounds: [f64; 2],
}

/// In the order of the plate's matrices.
const CONSTANTS: [Constant; 4] = [
    Constant { name: "D11", nominal: [1.3e10, 0.015], truth: [1.12e10, 0.010], bounds: [8e9, 2e10] },
    Constant { name: "D22", nominal: [1.15e9, 0.015], truth: [9.6e8, 0.022], bounds: [6e8, 1.8e9] },
    Constant { name: "D12", nominal: [3.0e8, 0.015], truth: [3.6e8, 0.014], bounds: [1e8, 8e8] },
    Constant { name: "D66", nominal: [8.4e8, 0.015], truth: [7.0e8, 0.020], bounds: [4e8, 1.3e9] },
];

/// Bounds of all loss factors.
const LOSS_FACTORS: [f64; 2] = [0.0, 0.05];

/// Elements along and across the grain of the plate that is struck.
const STRUCK: [usize; 2] = [20, 10];

/// Acceleration of free fall in m/s², exact by definition: the accelerometer gives g.
const GRAVITY: f64 = 9.80665;

/// 1280 Hz for 3.2 s: in the record the response decays by a thousand.
const TEST: HammerTest = HammerTest {
    step_s: 1.0 / 1280.0,
    samples: 4096,
    periods: 2,
    hit_s: 0.1,
    contact_s: 1.2e-3,
    peak_n: 5.0,
};

/// Noise of the hammer's channel over that of the accelerometer's, each as a share of its largest value.
const HAMMER_NOISE: f64 = 0.1;

/// A free rectangular plate of so many elements along and across the grain, at least three in each direction.
///
/// The outer ones reach from the edges to where the plate is hit and measured, the inner ones are equal.
///
/// Struck near a corner, measured near the opposite one. 30 Hz to 450 Hz.
/// Rows: four a node, of which the twist has no name.
///
/// # Errors
/// [`Error::Mesh`] for too few elements or too many.
pub fn orthotropic_plate(elements: [usize; 2]) -> Result<SeveralModel, Error> {
    let lines = [0, 1].map(|axis| lines(SIDES[axis], elements[axis]));
    let plate = OrthotropicPlate { lines, thickness: THICKNESS, ..OrthotropicPlate::default() }.assemble()?;
    let at = |position: [f64; 2]| nearest(&plate, [position[0], position[1], 0.0], Direction::Z);
    let law = |[value, loss_factor]: [f64; 2]| Law::complex_modulus(value, loss_factor);
    let constants = CONSTANTS.iter().zip(&plate.stiffness);
    let bending = constants.map(|(of, matrix)| term(of.name, Role::Stiffness, matrix, law(of.nominal)));
    let mass = term("mass", Role::Mass, &plate.mass[0], real(DENSITY));
    let stiffness = DynamicStiffness::new(bending.chain([mass]).collect())?;
    let unknown = |(index, of): (usize, &Constant)| Unknown {
        name: of.name.to_owned(),
        dependence: Dependence::Factor(vec![index]),
        nominal: law(of.nominal),
        varies: Variation::Constant,
        real: false,
        bounds: Bounds { storage: Some(of.bounds), loss_factor: Some(LOSS_FACTORS) },
    };
    let opposite = at(SIDES.map(|side| side - INSET));
    Ok(SeveralModel {
        unknowns: CONSTANTS.iter().enumerate().map(unknown).collect(),
        stiffness,
        experiment: Experiment::driven_at(plate.dofs.len(), at([INSET; 2]), vec![opposite]),
        truth: CONSTANTS.iter().map(|of| law(of.truth)).collect(),
        noise: 0.0,
        band_hz: [30.0, 450.0],
        step_hz: 1.0 / (TEST.samples as f64 * TEST.step_s),
        dofs: names(&plate),
    })
}

/// 0, the inset, equal steps, the inset before the end, the end; empty where there are fewer than three elements or too many, which the mesh refuses.
fn lines(side: f64, elements: usize) -> Vec<f64> {
    const COUNTS: Range<usize> = 1..frfit_fem::Error::MAX_NODES;
    let Some(inner) = elements.checked_sub(2).filter(|inner| COUNTS.contains(inner)) else {
        return Vec::new();
    };
    inset_lines(side, INSET, inner)
}

/// Records of force (N) and acceleration (g) of some impacts, one a segment, computed on a finer mesh than that of the model.
///
/// Noise is the standard deviation of what is added to every sample of the acceleration, as a share of its largest value; that of the force is a
/// tenth of it.
///
/// # Errors
/// [`Error::Breakdown`] where the plate cannot be solved; [`Error::Format`] where a number cannot be written, as with noise that is not finite.
pub fn plate_records(impacts: usize, noise: f64) -> Result<Vec<u8>, Error> {
    let plate = orthotropic_plate(STRUCK)?;
    // The true constants do not vary with frequency.
    let truth = plate.true_stiffness(plate.band_hz[0])?;
    let nyquist_hz = 0.5 / TEST.step_s;
    // 4 Hz apart: the error of the response is estimated at each.
    const TRAINED: usize = 160;
    let points = (1..=TRAINED).map(|k| nyquist_hz * k as f64 / TRAINED as f64);
    let points = points.map(|f| Ok(Point { at: truth.at(f, &[])?, correction: c64::default() }));
    let points = points.collect::<Result<Vec<_>, Error>>()?;
    let mut reduced = Subspace::new(&plate.experiment, &truth.at(nyquist_hz, &[])?)?;
    // A thousandth of the noise.
    reduced.train(&points, &TrainOptions::default().with_tolerance(1e-6), &sequential)?;
    let projection = reduced.projection();
    // At rest a free plate has no stiffness: the lowest line stands for it.
    let lowest_hz = 1.0 / (TEST.periods as f64 * TEST.samples as f64 * TEST.step_s);
    let accelerance = |f: f64| {
        let f = f.max(lowest_hz);
        let receptance = projection.respond(&truth.at(f, &[])?)?;
        Ok(Quantity::Accelerance.from_receptance(f, receptance[0]))
    };
    let [force, acceleration] = TEST.signals(accelerance)?;
    let in_g: Vec<f64> = acceleration.into_iter().map(|a| a / GRAVITY).collect();
    TEST.records(
        impacts,
        &[
            Recorded { name: "Force", unit: "N", clean: &force, noise: HAMMER_NOISE * noise },
            Recorded { name: "Acceleration", unit: "g", clean: &in_g, noise },
        ],
    )
}
