//! The sandwich of which neither the skins nor the core are known: two complex moduli at every frequency.

use crate::sandwich::{self, upwards};
use crate::{Error, Model, SeveralModel};
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::roots::Bounds;

/// True modulus of the skins in Pa and its loss factor: softer and more damped than the nominal aluminium, as glued or perforated sheet is.
const STORAGE: f64 = 6.2e10;
const LOSS_FACTOR: f64 = 0.01;

/// Bounds on storage modulus in Pa and loss factor: of skins, and of the core.
const SKINS: [[f64; 2]; 2] = [[1e10, 2e11], [0.0, 0.2]];
const CORE: [[f64; 2]; 2] = [[1e5, 1e8], [0.0, 3.0]];

/// The cantilever of [`crate::sandwich()`] with a third sensor, on the edge that is not driven, and with other skins than its model has.
///
/// # Errors
/// [`Error::Mesh`] for no element in a direction or too many.
pub fn two_materials(nx: usize, ny: usize, core: usize) -> Result<SeveralModel, Error> {
    let beam = sandwich::mesh(nx, ny, core)?;
    let Model { stiffness, mut experiment, truth, band_hz, step_hz, dofs, .. } = sandwich::model(&beam)?;
    experiment.sensors.push(upwards(&beam, 0.7, 1.0));
    let unknown = |term: usize, [storage, loss_factor]: [[f64; 2]; 2]| Unknown {
        name: stiffness.terms()[term].name.clone(),
        dependence: Dependence::Factor(vec![term]),
        nominal: stiffness.terms()[term].factor.clone(),
        varies: Variation::PerFrequency,
        real: false,
        bounds: Bounds { storage: Some(storage), loss_factor: Some(loss_factor) },
    };
    let unknowns = vec![unknown(0, SKINS), unknown(1, CORE)];
    let truth = vec![Law::complex_modulus(STORAGE, LOSS_FACTOR), truth];
    Ok(SeveralModel { stiffness, experiment, unknowns, truth, noise: 0.0, band_hz, step_hz, dofs })
}
