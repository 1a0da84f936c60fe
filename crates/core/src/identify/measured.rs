//! What was measured on what: a band with one unknown.

use super::coarser_mesh::CoarserMesh;
use super::unknown::Unknown;
use crate::c64;
use crate::frfs::Noise;
use crate::model::{DynamicStiffness, Experiment, Parameter};

/// What was measured on what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Band<'a> {
    /// The model.
    pub model: &'a DynamicStiffness,
    /// Load and sensors.
    pub experiment: &'a Experiment,
    /// What is unknown, with its bounds.
    pub unknown: &'a Unknown,
    /// It as the parameter of a polynomial.
    pub parameter: &'a Parameter,
    /// Frequencies, ascending.
    pub frequency_hz: &'a [f64],
    /// Receptance, `[frequency][sensor]`.
    pub measured: &'a [Vec<c64>],
    /// How well each was measured.
    pub noise: Noise<'a>,
    /// The same structure on a coarser mesh.
    pub coarser: Option<&'a CoarserMesh>,
}
