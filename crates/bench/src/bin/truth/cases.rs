//! The structures, and by how much their nominals are off.

use crate::files;
use frfit::frequency::linear_hz;
use frfit::material::Law;
use frfit::model::Sensor;
use frfit_bench::Structure;
use frfit_examples::{Model, clamped_plate, rubber_bar_end, sandwich};
use std::error::Error;

/// A structure with its number of frequencies, or the reason why it cannot be made.
pub(crate) type Made = Result<Result<Structure, String>, Box<dyn Error>>;

/// What is tried.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) structure: fn(usize) -> Made,
    /// The nominal factor is (1 + δ) times the true one.
    pub(crate) deltas: &'static [f64],
}

/// Band of the plates: through their first six resonances.
const PLATE_HZ: [f64; 2] = [20.0, 3608.0];

/// The paper's, the other sign, twice as much, and three times off to either side.
const PLATE_DELTAS: &[f64] = &[0.25, -0.25, 0.5, -0.5, 2.0, -2.0 / 3.0];

/// Loss factors of the plates: the paper's, and one that no instrument resolves.
const STEEL: f64 = 1e-3;
const QUIET: f64 = 1e-5;

/// Upper bounds of the loss factor, of metal and of rubber.
const METAL: f64 = 1.0;
const RUBBER: f64 = 3.0;

/// Relative error that counts as right: where stiffnesses contrast, direct solves leave fewer digits.
const RIGHT: f64 = 1e-6;
const RIGHT_SANDWICH: f64 = 1e-5;

pub(crate) const CASES: [Case; 7] = [
    Case { name: "plate, 1083", structure: |n| plate(n, STEEL).map(Ok), deltas: PLATE_DELTAS },
    Case { name: "plate, η = 1e-5", structure: |n| plate(n, QUIET).map(Ok), deltas: &[0.25, -0.25] },
    Case { name: "BCSSTK09", structure: |n| bcsstk09(n, STEEL), deltas: PLATE_DELTAS },
    Case { name: "BCSSTK09, η = 1e-5", structure: |n| bcsstk09(n, QUIET), deltas: &[0.25, -0.25] },
    Case {
        name: "rubber bar, 101",
        structure: |n| Ok(Ok(example(rubber_bar_end(100)?, n, RIGHT, RUBBER))),
        deltas: &[0.5],
    },
    Case {
        name: "sandwich, 5040",
        structure: |n| Ok(Ok(example(sandwich(48, 6, 2)?, n, RIGHT_SANDWICH, RUBBER))),
        deltas: &[0.5],
    },
    Case { name: "sandwich beam, 168", structure: beam, deltas: &[0.3] },
];

fn example(model: Model, frequencies: usize, tolerance: f64, loss_factor: f64) -> Structure {
    let [first, last] = model.band_hz;
    Structure::of(model, linear_hz(first, last, frequencies), tolerance, loss_factor)
}

/// The example's plate with another loss factor and a second sensor, off the lines of symmetry too.
fn plate(frequencies: usize, loss_factor: f64) -> Result<Structure, Box<dyn Error>> {
    let mut model = clamped_plate(20)?;
    let storage = model.truth.at(PLATE_HZ[0])?.re;
    model.truth = Law::complex_modulus(storage, loss_factor);
    model.experiment.sensors.push(Sensor { row: SECOND, sign: 1.0 });
    model.band_hz = PLATE_HZ;
    Ok(example(model, frequencies, RIGHT, METAL))
}

/// Deflection of the fourth node in the fourteenth line of 19, in both plates.
const SECOND: usize = 3 * (13 * 19 + 3);

/// The paper's plate: force on the deflection of node 101, sensors at the centre's neighbour and off the lines of symmetry.
fn bcsstk09(frequencies: usize, loss_factor: f64) -> Made {
    let files = match files::plate()? {
        Ok(files) => files,
        Err(why) => return Ok(Err(why)),
    };
    let truth = Law::complex_modulus(1.0, loss_factor);
    let frequency_hz = linear_hz(PLATE_HZ[0], PLATE_HZ[1], frequencies);
    files.structure(truth, frequency_hz, [300, 537, SECOND], RIGHT, METAL).map(Ok)
}

/// A viscoelastic sandwich beam, D = K_e − ω²M + g(ω) K_v, clamped at one end. Four dofs a node; force on the deflection at 0.3 of the length,
/// sensors at the tip and at mid-length. Three resonances.
fn beam(frequencies: usize) -> Made {
    let files = match files::beam()? {
        Ok(files) => files,
        Err(why) => return Ok(Err(why)),
    };
    let frequency_hz = linear_hz(5.0, 500.0, frequencies);
    let truth = files::zener(&frequency_hz)?;
    files.structure(truth, frequency_hz, [50, 166, 82], RIGHT_SANDWICH, RUBBER).map(Ok)
}
