//! A plate that was measured, and two meshes of it.

use crate::model::{names, nearest, real, term};
use crate::{Error, SeveralModel};
use frfit::identify::{Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit_fem::{Direction, Plate, Support};

/// Sides in m, the first from the clamped edge to the free one, and thickness in m.
const SIDES: [f64; 2] = [0.30, 0.20];
const THICKNESS: f64 = 0.003;

/// Density in kg/m³ of glass-filled nylon, known.
const DENSITY: f64 = 1350.0;

/// Its true modulus.
const TRUTH: Law = Law::Fractional { e0: 6.5e9, e1: 1.1e8, alpha: 0.25 };

/// Storage modulus (Pa) and loss factor of the data sheet.
const NOMINAL: [f64; 2] = [8.0e9, 0.02];

/// A plate clamped along one edge, of n × n elements, n a multiple of six.
///
/// Struck near a free corner, measured at three points off its lines of symmetry, with 1 % noise. 20 Hz to 600 Hz.
/// Rows: 3 n (n + 1).
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn two_meshes(n: usize) -> Result<SeveralModel, Error> {
    let plate = Plate {
        sides: SIDES,
        thickness: THICKNESS,
        elements: [n; 2],
        edges: [Support::Clamped, Support::Free, Support::Free, Support::Free],
        ..Plate::default()
    }
    .assemble()?;
    // Nodes of all these meshes.
    let at = |[x, y]: [f64; 2]| nearest(&plate, [x * SIDES[0], y * SIDES[1], 0.0], Direction::Z);
    let nominal = Law::complex_modulus(NOMINAL[0], NOMINAL[1]);
    let stiffness = DynamicStiffness::new(vec![
        term("plate", Role::Stiffness, &plate.stiffness[0], nominal),
        term("mass", Role::Mass, &plate.mass[0], real(DENSITY)),
    ])?;
    let modulus = Unknown { varies: Variation::PerFrequency, ..Unknown::factor_of(&stiffness, &["plate"])? };
    let sensors = [[1.0, 0.0], [2.0 / 3.0, 1.0], [0.5, 1.0 / 6.0]].map(at).to_vec();
    Ok(SeveralModel {
        stiffness,
        experiment: Experiment::driven_at(plate.dofs.len(), at([5.0 / 6.0, 1.0 / 6.0]), sensors),
        unknowns: vec![modulus],
        truth: vec![TRUTH],
        noise: 0.01,
        band_hz: [20.0, 600.0],
        step_hz: 4.0,
        dofs: names(&plate),
    })
}
