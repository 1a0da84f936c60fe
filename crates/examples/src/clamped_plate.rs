//! The paper's Section 8: a square steel plate, clamped all around.

use crate::Error;
use crate::model::{Model, names, nearest, real, term};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role};
use frfit_fem::{Direction, Plate, Support};

/// Side in m and thickness in m: with these the plate rings where that of BCSSTK09 does.
const SIDE: f64 = 0.32;
const THICKNESS: f64 = 0.01;

/// Density of steel in kg/m³.
const DENSITY: f64 = 7800.0;

/// Storage modulus of steel in Pa, and the paper's loss factor.
const STORAGE: f64 = 2.0e11;
const LOSS_FACTOR: f64 = 0.001;

/// The paper's initial error, P-38.
const DELTA: f64 = 0.25;

/// A plate of n × n elements, struck and measured at points off its lines of symmetry. 20 Hz to 3500 Hz.
///
/// Rows: 3 (n − 1)²; n = 20 has 1083 as BCSSTK09 has.
///
/// # Errors
/// [`Error::Mesh`] for fewer than two elements a side or too many.
pub fn clamped_plate(n: usize) -> Result<Model, Error> {
    let plate = Plate {
        sides: [SIDE; 2],
        thickness: THICKNESS,
        elements: [n; 2],
        edges: [Support::Clamped; 4],
        ..Plate::default()
    }
    .assemble()?;
    let [struck, measured] =
        [[0.35, 0.30], [0.60, 0.45]].map(|[x, y]| nearest(&plate, [x * SIDE, y * SIDE, 0.0], Direction::Z));
    let truth = Law::complex_modulus(STORAGE, LOSS_FACTOR);
    let stiffness = DynamicStiffness::new(vec![
        term("plate", Role::Stiffness, &plate.stiffness[0], truth.scaled(1.0 + DELTA)),
        term("mass", Role::Mass, &plate.mass[0], real(DENSITY)),
    ])?;
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["plate"])?,
        stiffness,
        experiment: Experiment::driven_at(plate.dofs.len(), struck, vec![measured]),
        truth,
        band_hz: [20.0, 3500.0],
        step_hz: 12.0,
        dofs: names(&plate),
    })
}
