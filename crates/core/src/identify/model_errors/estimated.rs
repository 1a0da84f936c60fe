//! The errors of a model as a search has them, with their covariance.

use super::curve::Curves;
use super::factor_prior::FactorPrior;
use super::fitting::Place;
use super::found::{
    CalibrationError, ContradictedAssumption, FactorError, ModeError, ModelErrorsFound, SensorMass,
};
use super::kinds::Kinds;
use super::mesh::{BetweenMeshes, MeshError};
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::identify::channel::Calibration;
use crate::identify::channel_coordinates::ChannelCoordinates;
use crate::subspace::{self, ModalErrors, Modes};
use std::f64::consts::TAU;

/// Modes up to this far above the band are reported.
const LISTED_ABOVE_BAND: f64 = 1.2;

/// The errors of a model, and how well they are known.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct Estimated {
    pub(in crate::identify) modes: Modes,
    pub(in crate::identify) errors: ModalErrors,
    /// Of θ, e, ε of the loss factors of unknowns, δ and ε of modes (own and common together), ν and Δη, κ, g, then a of the load and of each sensor: n × n.
    pub(in crate::identify) covariance: Vec<f64>,
    pub(in crate::identify) sizes: [f64; 3],
    /// χ² at σ times `level`, and how many numbers it has.
    pub(in crate::identify) chi_squared: f64,
    pub(in crate::identify) numbers: usize,
    pub(in crate::identify) level: f64,
    /// What the response has beside noise and errors, relative to itself: a standard deviation of real and imaginary part each.
    pub(in crate::identify) rest: f64,
    /// By how many nats errors of the model explain the band better than a right model does.
    pub(in crate::identify) evidence: f64,
    /// Errors that are in the covariance.
    pub(super) kinds: Kinds,
    pub(super) highest_rad_s: f64,
    pub(super) curves: Curves,
    pub(super) factors: Vec<FactorPrior>,
    pub(super) mesh: Option<BetweenMeshes>,
    pub(super) mesh_error: Option<MeshError>,
    /// What is taken for known of calibrations and factors, and that the data contradict.
    pub(in crate::identify) contradicted_assumptions: Vec<ContradictedAssumption>,
    /// Error bars over those of noise alone, once they are known.
    pub(in crate::identify) bars_over_noise: Option<f64>,
    /// θ, then the errors as the search has them.
    pub(super) place: Place,
}

impl Estimated {
    /// What is reported to users.
    pub(in crate::identify) fn found(&self) -> ModelErrorsFound {
        let (n, first) = (self.count(), self.first_of_modes());
        let covariance = |a: usize, b: usize| self.covariance[(first + a) * n + first + b];
        let mode = |(i, omega): (usize, &f64)| {
            let own = self.modes.frequency_errors(i).map(|error| first + error);
            let all: Vec<usize> = own.chain(self.of_scale()).collect();
            let variance: f64 =
                all.iter().flat_map(|&a| all.iter().map(move |&b| self.covariance[a * n + b])).sum();
            let own: f64 = self.modes.frequency_errors(i).map(|error| self.errors.stiffness[error]).sum();
            ModeError {
                frequency_hz: omega / TAU,
                error: own + self.errors.scale,
                std: variance.max(0.0).sqrt(),
                coarser_hz: self
                    .mesh
                    .as_ref()
                    .and_then(|mesh| mesh.partner_rad_s[i])
                    .map(|omega| omega / TAU),
            }
        };
        let of_factors = self.modes.of_error.len();
        let std = |c: usize| covariance(c, c).max(0.0).sqrt();
        let factor = |(t, one): (usize, &subspace::FactorError)| {
            let [error, slope] = one.relative();
            FactorError { term: one.term, part: one.part, error, std: slope * std(of_factors + t) }
        };
        let first_mass = of_factors + self.factors.len();
        let mass = |(m, (error, apparent)): (usize, (&f64, &f64))| SensorMass {
            mass: error * apparent,
            std: std(first_mass + m) * apparent,
        };
        let first_gain = first_mass + self.errors.masses.len();
        let calibration = |(m, &error): (usize, &f64)| CalibrationError { error, std: std(first_gain + m) };
        let is_listed = |omega: &f64| *omega > 0.0 && *omega <= LISTED_ABOVE_BAND * self.highest_rad_s;
        let [frequency_std, loss_factor_std, shape_std] = self.sizes;
        let errors_of_known =
            self.errors.factors.iter().enumerate().filter(|(t, _)| self.factors[*t].is_known);
        ModelErrorsFound {
            frequency_std,
            loss_factor_std,
            shape_std,
            response_std: 2f64.sqrt() * self.rest,
            modes: self
                .modes
                .omega_rad_s
                .iter()
                .enumerate()
                .filter(|(_, omega)| is_listed(omega))
                .map(mode)
                .collect(),
            factors: errors_of_known.map(factor).collect(),
            calibrations: self.errors.gains.iter().enumerate().map(calibration).collect(),
            mesh: self.mesh_error,
            contradicted_assumptions: self.contradicted_assumptions.clone(),
            bars_over_noise: self.bars_over_noise,
            masses: self.errors.masses.iter().zip(&self.modes.apparent_mass).enumerate().map(mass).collect(),
            evidence: self.evidence,
        }
    }

    pub(in crate::identify) fn theta(&self) -> &[f64] {
        &self.place[..self.curves.count()]
    }

    /// Whether the model has errors in this estimate. Otherwise it is a fit of curves alone.
    pub(in crate::identify) fn has_errors(&self) -> bool {
        !self.modes.omega_rad_s.is_empty() || !self.factors.is_empty()
    }

    /// Variances of the real and the imaginary part of an unknown at a line, and their covariance.
    pub(in crate::identify) fn covariance_at(
        &self,
        unknown: usize,
        line: usize,
        frequency_hz: f64,
    ) -> Option<[f64; 3]> {
        let slopes = self.slopes(unknown, line, frequency_hz)?;
        Some(covariance(&self.block(0..slopes.len()), &slopes))
    }

    /// ∂p/∂θ of an unknown at a line.
    pub(super) fn slopes(&self, unknown: usize, line: usize, frequency_hz: f64) -> Option<Vec<c64>> {
        self.curves.slopes(self.theta(), unknown, line, omega_rad_s(frequency_hz))
    }

    /// The covariance of some coordinates, column after column.
    pub(in crate::identify) fn covariance_of(&self, coordinates: &[usize]) -> Vec<f64> {
        let n = self.count();
        let column = |&a: &usize| coordinates.iter().map(move |b| self.covariance[a * n + b]);
        coordinates.iter().flat_map(column).collect()
    }

    fn block(&self, range: std::ops::Range<usize>) -> Vec<f64> {
        self.covariance_of(&range.collect::<Vec<_>>())
    }

    /// Where this rest was in the standard deviations already.
    pub(in crate::identify) fn beside(self, rest: f64) -> Self {
        Self { rest: self.rest.hypot(rest), ..self }
    }

    /// Scales and delays of channels, as coordinates.
    pub(in crate::identify) fn channels(&self) -> &ChannelCoordinates {
        self.curves.channels()
    }

    /// Scales and delays of channels, with their standard deviations.
    pub(in crate::identify) fn calibrations(&self) -> Vec<Calibration> {
        let n = self.count();
        let std = |c: usize| Some(self.covariance[c * n + c].max(0.0).sqrt());
        self.channels().found(self.theta(), std)
    }

    /// The coordinates of an unknown.
    pub(in crate::identify) fn range(&self, unknown: usize) -> std::ops::Range<usize> {
        self.curves.range(unknown)
    }

    /// The errors, as coordinates.
    pub(in crate::identify) fn error_range(&self) -> std::ops::Range<usize> {
        self.curves.count()..self.count()
    }

    /// ∂ Re p/∂θ of an unknown at a line.
    pub(in crate::identify) fn real_slopes(
        &self,
        unknown: usize,
        line: usize,
        frequency_hz: f64,
    ) -> Option<Vec<f64>> {
        Some(self.slopes(unknown, line, frequency_hz)?.iter().map(|slope| slope.re).collect())
    }

    /// All unknowns at a line.
    pub(in crate::identify) fn values(&self, line: usize, frequency_hz: f64) -> Option<Vec<c64>> {
        Some(self.curves.values(self.theta(), line, omega_rad_s(frequency_hz))?.0)
    }

    /// The covariance of the unknowns' θ, row after row.
    pub(in crate::identify) fn of_theta(&self) -> Vec<Vec<f64>> {
        let n = self.curves.of_unknowns();
        self.block(0..n).chunks_exact(n.max(1)).map(<[f64]>::to_vec).collect()
    }

    /// The covariance of channels and errors.
    pub(in crate::identify) fn of_channels_and_errors(&self) -> Vec<f64> {
        self.block(self.curves.of_unknowns()..self.count())
    }

    /// The coordinate of e, the scale of all stiffness, where there are modes.
    pub(in crate::identify) fn of_scale(&self) -> Option<usize> {
        (!self.modes.omega_rad_s.is_empty()).then(|| self.curves.count())
    }

    /// Coordinates of what all modes have in common: e, and ε of the loss factors of unknowns where these are in error.
    pub(in crate::identify) fn in_common(&self) -> usize {
        usize::from(self.of_scale().is_some()) + usize::from(!self.errors.of_loss.is_empty())
    }

    /// The first coordinate of the errors of single modes.
    pub(super) fn first_of_modes(&self) -> usize {
        self.curves.count() + self.in_common()
    }

    /// Coordinates: θ, and the errors.
    pub(in crate::identify) fn count(&self) -> usize {
        let ModalErrors { stiffness, masses, gains, load, shape, factors, .. } = &self.errors;
        let of_shapes: usize = shape.iter().map(Vec::len).sum();
        let of_sensors = masses.len() + gains.len();
        self.first_of_modes() + stiffness.len() + factors.len() + of_sensors + load.len() + of_shapes
    }
}

/// Variances of the real and the imaginary part of Σ g_n ξ_n, and their covariance.
pub(in crate::identify) fn covariance(covariance: &[f64], g: &[c64]) -> [f64; 3] {
    let n = g.len();
    let mut sum = [0.0; 3];
    for (column, g_column) in covariance.chunks_exact(n.max(1)).zip(g) {
        let times: c64 = column.iter().zip(g).map(|(c, g)| *c * g).sum();
        sum[0] += times.re * g_column.re;
        sum[1] += times.im * g_column.im;
        sum[2] += times.re * g_column.im;
    }
    sum
}
