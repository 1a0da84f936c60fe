//! What was found of the errors of a model.

use super::mesh::MeshError;
use crate::model::FactorPart;

/// The errors of a model (B-11): relative, as (truth − model)/model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelErrorsFound {
    /// Standard deviation s of the errors of natural frequencies, each its own; zero where only factors are in error.
    pub frequency_std: f64,
    /// Standard deviation s_η of the relative errors of their loss factors.
    pub loss_factor_std: f64,
    /// Standard deviation s_a of the errors of mode shapes at the sensors.
    pub shape_std: f64,
    /// What the response has beside noise and errors, relative to itself (√E|δx|²/|x|): zero where noise and errors explain the band, or the level of the
    /// noise was not given and holds it.
    pub response_std: f64,
    /// One for each mode of the nominal model up to the end of the band, and a little further; none for a rigid body, which has no natural frequency.
    pub modes: Vec<ModeError>,
    /// Of the known matrices.
    pub factors: Vec<FactorError>,
    /// Masses at the sensors that the model does not have, one for each; empty where only factors are in error.
    pub masses: Vec<SensorMass>,
    /// Of the calibrations: of the force, then of each sensor; empty where only factors are in error.
    pub calibrations: Vec<CalibrationError>,
    /// The error of the mesh, estimated with a coarser one; `None` without one, or where fewer than half of the modes of the band are paired.
    pub mesh: Option<MeshError>,
    /// What is taken for known of calibrations and factors, and that the data contradict: no value is `ok` then.
    pub contradicted_assumptions: Vec<ContradictedAssumption>,
    /// Error bars of the real part over those of noise alone, the median of the lines that are `ok`: of a single unknown that has a value of its own at each frequency.
    pub bars_over_noise: Option<f64>,
    /// By how many nats these errors explain the band better than a right model does.
    pub evidence: f64,
}

/// The error of a natural frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeError {
    /// The model's natural frequency at the modulus of the middle of the band.
    pub frequency_hz: f64,
    /// Its relative error.
    pub error: f64,
    /// The standard deviation of that.
    pub std: f64,
    /// The natural frequency of the same mode on the coarser mesh, where there is one and the modes are paired.
    pub coarser_hz: Option<f64>,
}

/// A mass at a sensor that the model does not have, as that of an accelerometer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorMass {
    /// In the unit of the mass matrix.
    pub mass: f64,
    /// The standard deviation of that.
    pub std: f64,
}

/// An error of a calibration: what was measured is 1 + `error` times the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationError {
    /// Relative.
    pub error: f64,
    /// The standard deviation of that.
    pub std: f64,
}

/// Something that is taken for known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Assumption {
    /// How large the responses are: the calibration of the force with that of all sensors.
    Calibration,
    /// A part of a known factor.
    Factor {
        /// The term of the model.
        term: usize,
        /// Which part.
        part: FactorPart,
    },
}

/// Something that is taken for known, and that the data contradict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContradictedAssumption {
    /// What it is.
    pub what: Assumption,
    /// By how much it is off as the data have it: relative, of a loss factor absolute.
    pub error: f64,
    /// The standard deviation with which it was known.
    pub std: f64,
}

impl ContradictedAssumption {
    /// The error in standard deviations.
    pub fn deviations(&self) -> f64 {
        self.error.abs() / self.std
    }
}

/// An error of the factor of a known matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FactorError {
    /// The term of the model.
    pub term: usize,
    /// Which part of the factor.
    pub part: FactorPart,
    /// Its error: relative of the storage part, absolute of the loss factor.
    pub error: f64,
    /// The standard deviation of that.
    pub std: f64,
}

/// How far an error of what is taken for known moves an unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leverage {
    /// What may be in error.
    pub of: LeverageOf,
    /// Number of the unknown.
    pub unknown: usize,
    /// |∂ln p/∂ln f| of the unknown p by the known factor f, with the measurements as they are: the median over the band. Of a mesh, |∂ln p/∂δ| by the
    /// relative error δ of the natural frequencies at the end of the band: the median over its upper quarter.
    pub change: f64,
}

/// What may be in error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeverageOf {
    /// The known factor of this term.
    Factor(usize),
    /// The mesh: natural frequencies that are too high in proportion to ω², as those of elements are that are too large. A modulus alone in its model moves by 2.
    Mesh,
}

impl LeverageOf {
    /// A change above this is worth a word: an unknown that moves by more than the known factor, or by half as much again as a modulus alone with its mesh.
    pub fn large(self) -> f64 {
        match self {
            Self::Factor(_) => 1.0,
            Self::Mesh => 3.0,
        }
    }
}
