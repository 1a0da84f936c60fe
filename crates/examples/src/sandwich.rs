//! A cantilever sandwich: aluminium skins on a core of rubber, in bricks.

use crate::Error;
use crate::model::{Model, names, nearest, real, term};
use crate::rubber_bar;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor};
use frfit_fem::brick::{Face, Layer};
use frfit_fem::{Assembled, Brick, Direction};

/// Length, width, thickness of a skin and of the core, in m.
const LENGTH: f64 = 0.24;
const WIDTH: f64 = 0.03;
const SKIN: f64 = 0.0015;
const CORE: f64 = 0.002;

/// Storage modulus (Pa), loss factor and density (kg/m³) of aluminium.
const STORAGE: f64 = 7.0e10;
const LOSS_FACTOR: f64 = 0.001;
const DENSITY: f64 = 2700.0;

/// Poisson's ratio of the core. Rubber is nearer to 1/2, where bricks without a pressure of their own lock.
const CORE_POISSON: f64 = 0.45;

/// The nominal core is (1 + δ) times the true one.
const DELTA: f64 = 0.5;

/// A cantilever of two skins, one element thick, and a core, `core` elements thick: nx × ny elements in plan.
///
/// Clamped at x = 0, driven on one long edge, so that it bends and twists; measured at the far corner of the tip and on
/// the driven edge at mid-length, upwards on the upper skin. 20 Hz to 1000 Hz.
/// Rows: 3 nx (ny + 1) (core + 3).
///
/// # Errors
/// [`Error::Mesh`] for no element in a direction or too many.
pub fn sandwich(nx: usize, ny: usize, core: usize) -> Result<Model, Error> {
    model(&mesh(nx, ny, core)?)
}

/// The bricks: materials are skins and core.
pub(crate) fn mesh(nx: usize, ny: usize, core: usize) -> Result<Assembled, Error> {
    let skin = Layer { thickness: SKIN, material: 0, ..Layer::default() };
    let rubber = Layer { thickness: CORE, elements: core, poisson: CORE_POISSON, material: 1 };
    let beam = Brick {
        length: LENGTH,
        width: WIDTH,
        elements: [nx, ny],
        layers: vec![skin, rubber, skin],
        clamped: vec![Face::XMin],
        ..Brick::default()
    };
    Ok(beam.assemble()?)
}

/// Upwards on the upper skin, at parts of length and width.
pub(crate) fn upwards(beam: &Assembled, x: f64, y: f64) -> Sensor {
    nearest(beam, [x * LENGTH, y * WIDTH, 2.0 * SKIN + CORE], Direction::Z)
}

pub(crate) fn model(beam: &Assembled) -> Result<Model, Error> {
    let at = |x: f64, y: f64| upwards(beam, x, y);
    let truth = rubber_bar::POLYBUTADIENE;
    let stiffness = DynamicStiffness::new(vec![
        term("skins", Role::Stiffness, &beam.stiffness[0], Law::complex_modulus(STORAGE, LOSS_FACTOR)),
        term("core", Role::Stiffness, &beam.stiffness[1], truth.scaled(1.0 + DELTA)),
        term("skins-mass", Role::Mass, &beam.mass[0], real(DENSITY)),
        term("core-mass", Role::Mass, &beam.mass[1], real(rubber_bar::DENSITY)),
    ])?;
    Ok(Model {
        parameter: Parameter::factor_of(&stiffness, &["core"])?,
        stiffness,
        experiment: Experiment::driven_at(beam.dofs.len(), at(0.3, 0.0), vec![at(1.0, 1.0), at(0.5, 0.0)]),
        truth,
        band_hz: [20.0, 1000.0],
        step_hz: 10.0,
        dofs: names(beam),
    })
}
