//! A beam with a component on it: neither the component's mass nor the beam's modulus are known.

use crate::cantilever::{LENGTH, cantilever};
use crate::model::{names, nearest, real, term};
use crate::{Error, SeveralModel};
use frfit::identify::{Dependence, Unknown, Variation};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role};
use frfit::roots::Bounds;
use frfit_fem::Direction;
use frfit_linalg::sparse::Triplets;

/// Density of aluminium in kg/m³, known: the beam was weighed.
const DENSITY: f64 = 2700.0;

/// Storage modulus in Pa and loss factor, as a handbook has them and as they are.
const HANDBOOK: [f64; 2] = [7.3e10, 0.001];
const REAL: [f64; 2] = [6.9e10, 0.003];

/// Mass of the component in kg, as its data sheet has it and as it is with screws and cable. The beam has 0.243 kg.
const DATA_SHEET: f64 = 0.04;
const MOUNTED: f64 = 0.065;

/// A cantilever with a point mass at seven tenths of its length, struck at three tenths, measured at the tip and in the middle, with 1 % noise. 10 Hz to 1000 Hz.
/// Rows: 2 elements.
///
/// # Errors
/// [`Error::Mesh`] for no element or too many.
pub fn added_mass(elements: usize) -> Result<SeveralModel, Error> {
    let beam = cantilever(elements)?;
    let at = |x: f64| nearest(&beam, [x * LENGTH, 0.0, 0.0], Direction::Z);
    let dim = beam.dofs.len();
    let place = at(0.7).row;
    // A point: no rotary inertia.
    let mut component = Triplets::new(dim);
    component.add(place, place, 1.0);
    let [handbook, modulus] = [HANDBOOK, REAL].map(|[e, loss_factor]| Law::complex_modulus(e, loss_factor));
    let stiffness = DynamicStiffness::new(vec![
        term("beam", Role::Stiffness, &beam.stiffness[0], handbook.clone()),
        term("mass", Role::Mass, &beam.mass[0], real(DENSITY)),
        term("component", Role::Mass, &component.assemble(), real(DATA_SHEET)),
    ])?;
    let component = Unknown {
        name: "component".into(),
        dependence: Dependence::Factor(vec![2]),
        nominal: real(DATA_SHEET),
        varies: Variation::Constant,
        real: true,
        bounds: Bounds { storage: Some([0.01, 0.2]), loss_factor: None },
    };
    let beam_modulus = Unknown {
        name: "beam".into(),
        dependence: Dependence::Factor(vec![0]),
        nominal: handbook,
        varies: Variation::Constant,
        real: false,
        bounds: Bounds { storage: Some([5e10, 9e10]), loss_factor: Some([0.0, 0.1]) },
    };
    Ok(SeveralModel {
        stiffness,
        experiment: Experiment::driven_at(dim, at(0.3), vec![at(1.0), at(0.5)]),
        unknowns: vec![component, beam_modulus],
        truth: vec![real(MOUNTED), modulus],
        noise: 0.01,
        band_hz: [10.0, 1000.0],
        step_hz: 5.0,
        dofs: names(&beam),
    })
}
