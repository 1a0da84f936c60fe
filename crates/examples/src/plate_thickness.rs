//! A plate whose thickness is not the one that was drawn: a geometric parameter.

use crate::model::{names, nearest, real, term};
use crate::{Error, SeveralModel};
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit::roots::Bounds;
use frfit_fem::{Direction, Plate, Support};

/// Sides in m, the first from the clamped edge to the free one.
const SIDES: [f64; 2] = [0.40, 0.25];

/// Storage modulus (Pa), loss factor and density (kg/m³) of aluminium, known.
const STORAGE: f64 = 7.0e10;
const LOSS_FACTOR: f64 = 0.004;
const DENSITY: f64 = 2700.0;

/// Thickness in m as drawn, and as rolled: 10 % less.
const DRAWN: f64 = 0.004;
const ROLLED: f64 = 0.0036;

/// A plate clamped along one edge, of n × n elements, made for a thickness of 1 m, so that h³ and h in metres make bending stiffness and mass of it.
///
/// Struck near a free corner, measured at three points off its lines of symmetry, with 1 % noise. 10 Hz to 600 Hz.
/// Rows: 3 n (n + 1).
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn plate_thickness(n: usize) -> Result<SeveralModel, Error> {
    let plate = Plate {
        sides: SIDES,
        thickness: 1.0,
        elements: [n; 2],
        edges: [Support::Clamped, Support::Free, Support::Free, Support::Free],
        ..Plate::default()
    }
    .assemble()?;
    let at = |[x, y]: [f64; 2]| nearest(&plate, [x * SIDES[0], y * SIDES[1], 0.0], Direction::Z);
    let stiffness = DynamicStiffness::new(vec![
        term("bending", Role::Stiffness, &plate.stiffness[0], Law::complex_modulus(STORAGE, LOSS_FACTOR)),
        term("mass", Role::Mass, &plate.mass[0], real(DENSITY)),
    ])?;
    let thickness = Unknown {
        name: "thickness".into(),
        dependence: Dependence::Powers(vec![(0, 3), (1, 1)]),
        nominal: real(DRAWN),
        varies: Variation::Constant,
        real: true,
        bounds: Bounds { storage: Some([0.003, 0.005]), loss_factor: None },
    };
    let sensors = [[1.0, 0.0], [0.6, 1.0], [0.4, 0.2]].map(at).to_vec();
    Ok(SeveralModel {
        stiffness,
        experiment: Experiment::driven_at(plate.dofs.len(), at([0.9, 0.1]), sensors),
        unknowns: vec![thickness],
        truth: vec![real(ROLLED)],
        noise: 0.01,
        band_hz: [10.0, 600.0],
        step_hz: 5.0,
        dofs: names(&plate),
    })
}
