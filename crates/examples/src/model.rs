//! A model with a known answer.

use crate::{Error, Rig};
use frfit::c64;
use frfit::dof::{Axis, DofName};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit_fem::{Assembled, Direction, Dof};
use frfit_linalg::sparse::SymmetricMatrix;

/// A finite element model at its nominal parameter, where it is driven and measured, and the parameter's truth.
#[derive(Debug)]
pub struct Model {
    /// The terms, the unknown factor at its nominal value.
    pub stiffness: DynamicStiffness,
    /// Load and sensors.
    pub experiment: Experiment,
    /// The unknown factor, with its nominal law.
    pub parameter: Parameter,
    /// The law that the measurement is made with.
    pub truth: Law,
    /// First and last frequency.
    pub band_hz: [f64; 2],
    /// Distance of neighbouring frequencies in the example.
    pub step_hz: f64,
    /// Name of each row; `None` where it is neither a displacement nor a rotation.
    pub dofs: Vec<Option<DofName>>,
}

impl Model {
    /// What is driven and measured.
    pub fn rig(&self) -> Rig<'_> {
        let Self { stiffness, experiment, dofs, band_hz, step_hz, .. } = self;
        Rig { stiffness, experiment, dofs, band_hz: *band_hz, step_hz: *step_hz }
    }

    /// The frequencies first + k · step up to the last.
    pub fn frequency_hz(&self) -> Vec<f64> {
        self.rig().frequency_hz()
    }

    /// The nominal model at one frequency, factorised: what [`frfit::identify::identify_at`] takes.
    ///
    /// # Errors
    /// [`Error::Breakdown`] where the nominal system cannot be factorised.
    pub fn nominal_at(&self, frequency_hz: f64) -> Result<FullModel<'_>, Error> {
        self.system(frequency_hz, &self.parameter)
    }

    /// What the sensors would measure: receptances by a direct solve with the true parameter, without noise.
    ///
    /// # Errors
    /// [`Error::Breakdown`] where the true system cannot be solved.
    pub fn measured_at(&self, frequency_hz: f64) -> Result<Vec<c64>, Error> {
        let truth = Parameter { nominal: self.truth.clone(), ..self.parameter.clone() };
        let system = self.system(frequency_hz, &truth)?;
        let mut x = system.load().to_vec();
        system.solve_nominal(&mut x)?;
        Ok(system.observe(&x))
    }

    fn system(&self, frequency_hz: f64, parameter: &Parameter) -> Result<FullModel<'_>, Error> {
        let at = self.stiffness.at(frequency_hz, std::slice::from_ref(parameter))?;
        Ok(FullModel::new(at, &self.experiment)?)
    }
}

/// A term of a model.
pub(crate) fn term(name: &str, role: Role, matrix: &SymmetricMatrix, factor: Law) -> Term {
    Term { name: name.to_owned(), role, matrix: matrix.clone(), factor }
}

/// A real factor.
pub(crate) fn real(value: f64) -> Law {
    Law::Constant(c64::new(value, 0.0))
}

/// The moving dof nearest to a position (m), counted positive along its direction.
pub(crate) fn nearest(structure: &Assembled, position: [f64; 3], direction: Direction) -> Sensor {
    let node = structure.nearest(position);
    let row = node.and_then(|node| structure.row(node, direction));
    // All nodes that move do so in all directions of these structures, and some do.
    Sensor { row: row.unwrap_or(0), sign: 1.0 }
}

/// The names of all rows that have one.
pub(crate) fn names(structure: &Assembled) -> Vec<Option<DofName>> {
    let name =
        |dof: &Dof| Some(DofName { node: dof.node as u64, axis: axis(dof.direction)?, reversed: false });
    structure.dofs.iter().map(name).collect()
}

fn axis(direction: Direction) -> Option<Axis> {
    match direction {
        Direction::X => Some(Axis::X),
        Direction::Y => Some(Axis::Y),
        Direction::Z => Some(Axis::Z),
        Direction::RX => Some(Axis::Rx),
        Direction::RY => Some(Axis::Ry),
        Direction::RZ => Some(Axis::Rz),
        Direction::Twist | Direction::ShearX | Direction::ShearY => None,
    }
}
