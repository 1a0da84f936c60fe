//! A cantilever whose density is unknown: a real parameter of the mass.

use crate::Error;
use crate::cantilever::{LENGTH, cantilever};
use crate::model::{Model, names, nearest, real, term};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role};
use frfit_fem::Direction;

/// Storage modulus of aluminium in Pa, and a loss factor with the damping of its clamp in it.
const STORAGE: f64 = 7.0e10;
const LOSS_FACTOR: f64 = 0.005;

/// True density in kg/m³, and how much too heavy the nominal one is.
const DENSITY: f64 = 2700.0;
const DELTA: f64 = 0.15;

/// A cantilever beam, struck near the middle, measured at its tip; the factor of the mass matrix is unknown.
/// 10 Hz to 1000 Hz.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn density(elements: usize) -> Result<Model, Error> {
    let beam = cantilever(elements)?;
    let [struck, measured] = [0.4, 1.0].map(|x| nearest(&beam, [x * LENGTH, 0.0, 0.0], Direction::Z));
    let truth = real(DENSITY);
    let stiffness = DynamicStiffness::new(vec![
        term("beam", Role::Stiffness, &beam.stiffness[0], Law::complex_modulus(STORAGE, LOSS_FACTOR)),
        term("mass", Role::Mass, &beam.mass[0], truth.scaled(1.0 + DELTA)),
    ])?;
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["mass"])?,
        stiffness,
        experiment: Experiment::driven_at(beam.dofs.len(), struck, vec![measured]),
        truth,
        band_hz: [10.0, 1000.0],
        step_hz: 5.0,
        dofs: names(&beam),
    })
}
