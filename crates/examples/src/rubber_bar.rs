//! The paper's Section 6: a free–free bar of rubber in longitudinal vibration.

use crate::Error;
use crate::model::{Model, names, nearest, real, term};
use frfit::c64;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role};
use frfit_fem::{Assembled, Bar, Direction};
use std::f64::consts::FRAC_PI_4;

/// Polybutadiene as the paper gives it, P-36.
pub const POLYBUTADIENE: Law = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };

/// Density of polybutadiene in kg/m³.
pub(crate) const DENSITY: f64 = 910.0;

/// Length in m: that of the bar which the paper measured in its Section 7.
const LENGTH: f64 = 0.3048;

/// Diameter in m, of the same bar.
const DIAMETER: f64 = 0.0254;

/// The paper's δ, P-38: the nominal modulus is (1 + δ) times the true one.
const DELTA: f64 = 0.5;

/// The bar with a unit force on every node, measured at x = 3L/4. 20 Hz to 2000 Hz.
///
/// At the ends the response does not separate one modulus from another over most of the band.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn rubber_bar(elements: usize) -> Result<Model, Error> {
    let bar = mesh(elements)?;
    let load = vec![c64::new(1.0, 0.0); bar.dofs.len()];
    let sensors = vec![nearest(&bar, [0.75 * LENGTH, 0.0, 0.0], Direction::X)];
    model(&bar, Experiment { load, sensors })
}

/// The bar with a unit force at the end x = 0, as of a hammer, measured at the end x = L and in the
/// middle. 20 Hz to 2000 Hz.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn rubber_bar_end(elements: usize) -> Result<Model, Error> {
    let bar = mesh(elements)?;
    let at = |x| nearest(&bar, [x, 0.0, 0.0], Direction::X);
    model(&bar, Experiment::driven_at(bar.dofs.len(), at(0.0), vec![at(LENGTH), at(LENGTH / 2.0)]))
}

fn mesh(elements: usize) -> Result<Assembled, Error> {
    let area = FRAC_PI_4 * DIAMETER * DIAMETER;
    Ok(Bar { length: LENGTH, area, elements, ..Bar::default() }.assemble()?)
}

/// D(ω) = E(ω) K − ω² ρ M.
fn model(bar: &Assembled, experiment: Experiment) -> Result<Model, Error> {
    let nominal = POLYBUTADIENE.scaled(1.0 + DELTA);
    let stiffness = DynamicStiffness::new(vec![
        term("rubber", Role::Stiffness, &bar.stiffness[0], nominal),
        term("mass", Role::Mass, &bar.mass[0], real(DENSITY)),
    ])?;
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["rubber"])?,
        stiffness,
        experiment,
        truth: POLYBUTADIENE,
        band_hz: [20.0, 2000.0],
        step_hz: 10.0,
        dofs: names(bar),
    })
}
