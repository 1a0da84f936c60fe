//! Sizes of the errors of a model: what is known of them before the data.

use super::kinds::{Damping, Kinds};
use super::mesh::BetweenMeshes;
use crate::identify::options::ErrorSizes;

/// Before the data: natural frequencies are good to a half per cent, loss factors of modes to one (a stiffness that is not there may have any), calibrations too,
/// shapes to two.
pub(super) const FREQUENCY_PRIOR_STD: f64 = 0.005;
pub(super) const MODAL_LOSS_FACTOR_PRIOR_STD: f64 = 0.01;
pub(super) const SHAPE_PRIOR_STD: f64 = 0.02;
pub(super) const CALIBRATION_PRIOR_STD: f64 = 0.01;

/// Natural frequencies and shapes of a model that is about right hardly scatter by more. If they might, errors of single modes would explain a band with any modulus, the better
/// the fewer modes there are.
pub(super) const LARGE_FREQUENCY_STD: f64 = 0.02;
pub(super) const LARGE_SHAPE_STD: f64 = 0.1;

/// A sensor or a load beside its place in the model sees shapes that are this much off, and natural frequencies that are right.
pub(super) const MISPLACED_SHAPE_STD: f64 = 0.3;

/// Shapes that are found to be so far off may be those of a sensor beside its place.
pub(super) const DOUBTFUL_SHAPE_STD: f64 = 0.05;

/// The same of a mass at a sensor over the apparent mass there: accelerometers have some tenths of a per cent of what they are on.
pub(super) const SENSOR_MASS_PRIOR_STD: f64 = 0.005;

/// A shape differs from the model's in about so many independent ways, whatever the number of sensors: a support that gives moves all of them.
const INDEPENDENT_ERRORS_OF_A_SHAPE: f64 = 2.0;

/// What all modes have in common is larger than their scatter: a mesh errs in one sense. Where a coarser mesh shows that error, the rest does so less:
/// shear that the elements lack, a thickness.
const COMMON_RATIO: f64 = 5.0;
const COMMON_RATIO_BESIDE_MESH: f64 = 2.5;

/// The same of loss factors: a support that has another damping than the structure changes all of them in one sense.
const COMMON_LOSS_RATIO: f64 = 2.0;

/// A mesh of beams or plates errs by as much at the top of the band, where its modes scatter hardly at all: an unknown that varies with frequency absorbs it.
const LEAST_OF_MESH_STD: f64 = 0.01;

/// A curve beside other unknowns absorbs what single modes err by too, so that the data do not show its size: elements of a coarse mesh err by other amounts in
/// twisting than in bending.
const LEAST_OF_MODES_STD: f64 = 0.02;

/// The data hardly show more of it either: what is beyond moves the curve.
const MAX_OF_MODES_BESIDE_CURVE: f64 = 0.02;

/// A support that gives alike in all modes is taken for a smaller modulus, and its damping for that of the material. Where it has two per cent of the strain energy and no
/// damping, the loss factor is found two per cent too small.
const LEAST_OF_UNKNOWN_LOSS_STD: f64 = 0.02;

/// A few modes may be far off; all of them are not, by more than this, unless their scatter is larger.
pub(super) const MAX_COMMON_STD: f64 = 0.025;

/// A stiffness that is not in the model and changes ω by δ has 2δ of the strain energy. Where it has no damping, that is how far the loss factor is off.
pub(super) const UNDAMPED_SHARE_RATIO: f64 = 2.0;

/// The share of a given size that is each mode's own, and that each of three common parts has: together they are as large as was said.
const OWN_SHARE_OF_GIVEN_SIZE: f64 = 0.5;

/// What is known of the sizes of errors before the data.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownSizes {
    pub(super) given: ErrorSizes,
    /// What all modes have in common, over what each has of its own.
    common_ratio: f64,
    /// The least of what grows with frequency.
    pub(super) least_of_mesh: f64,
    /// The least of what each mode has of its own; it grows with the square of the frequency.
    pub(super) least_of_modes: f64,
    /// The most of what each mode has of its own.
    pub(super) most_of_modes: f64,
    /// The least of the error that all loss factors of the unknown have in common.
    pub(super) least_of_unknown_loss: f64,
}

impl KnownSizes {
    /// What the user says, whether a coarser mesh shows what the mesh has in common, and whether a curve stands beside other unknowns.
    pub(super) fn new(given: ErrorSizes, mesh: Option<&BetweenMeshes>, is_curve_beside_others: bool) -> Self {
        let common_ratio = match (given.frequency, mesh) {
            (Some(_), _) => 1.0,
            (None, Some(_)) => COMMON_RATIO_BESIDE_MESH,
            (None, None) => COMMON_RATIO,
        };
        let is_unknown = given.frequency.is_none() && mesh.is_none();
        let least = |is_wanted: bool, std: f64| if is_wanted { std } else { 0.0 };
        Self {
            given,
            common_ratio,
            least_of_mesh: least(is_unknown, LEAST_OF_MESH_STD),
            least_of_modes: least(is_unknown && is_curve_beside_others, LEAST_OF_MODES_STD),
            most_of_modes: if is_curve_beside_others { MAX_OF_MODES_BESIDE_CURVE } else { f64::INFINITY },
            least_of_unknown_loss: least(is_unknown, LEAST_OF_UNKNOWN_LOSS_STD),
        }
    }

    /// With shapes of a size that is given.
    pub(super) fn with_shape(self, shape: f64) -> Self {
        Self { given: ErrorSizes { shape: Some(shape), ..self.given }, ..self }
    }

    /// Where errors are so much smaller than usual.
    pub(super) fn smaller(self, part: f64) -> Self {
        Self {
            least_of_mesh: part * self.least_of_mesh,
            least_of_modes: part * self.least_of_modes,
            least_of_unknown_loss: part * self.least_of_unknown_loss,
            ..self
        }
    }
}

/// Kinds of trends that the δ_i have in common.
pub(super) const TRENDS: usize = 3;

/// Sizes of the errors: standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    /// Of δ_i, each its own.
    pub(super) frequency: f64,
    /// Of ε_i.
    pub(super) loss_factor: f64,
    /// Of e, by which all natural frequencies are off alike.
    pub(super) scale: f64,
    /// Of what else all δ_i have in common: what grows with ω_i, with its square, and what falls with 1/ω_i².
    pub(super) trends: [f64; TRENDS],
    /// Of what all ε_i have in common.
    pub(super) common_loss: f64,
    /// Of a_mi.
    pub(super) shape: f64,
    /// Of g_m.
    pub(super) calibration: f64,
    /// Of κ_m, over the apparent mass there.
    pub(super) mass: f64,
    /// Of bends of ln|E| and of the phase, over the usual ones.
    pub(super) bend: [f64; 2],
}

impl Sizes {
    /// Before the data.
    pub(super) fn prior(known: KnownSizes) -> Self {
        let KnownSizes { given, .. } = known;
        let frequency = given.frequency.map_or(FREQUENCY_PRIOR_STD, |size| OWN_SHARE_OF_GIVEN_SIZE * size);
        let (shape, loss_factor) = (given.shape.unwrap_or(SHAPE_PRIOR_STD), MODAL_LOSS_FACTOR_PRIOR_STD);
        let calibration = given.calibration.unwrap_or(CALIBRATION_PRIOR_STD);
        let (mass, bend) = (SENSOR_MASS_PRIOR_STD, [1.0; 2]);
        let (scale, trends, common_loss) = (0.0, [0.0; TRENDS], 0.0);
        Self { frequency, loss_factor, scale, trends, common_loss, shape, calibration, mass, bend }
            .with_common(known)
    }

    /// With the sizes that belong to the errors of natural frequencies.
    pub(super) fn with_common(self, known: KnownSizes) -> Self {
        let common = (known.common_ratio * self.frequency).min(MAX_COMMON_STD.max(self.frequency));
        let of_own = COMMON_LOSS_RATIO * self.loss_factor;
        let common_loss = of_own.max(UNDAMPED_SHARE_RATIO * common);
        Self { scale: common, trends: [common; TRENDS], common_loss, ..self }
    }

    /// −2 ln of how probable they are, up to a constant: large ones are not.
    pub(super) fn improbability(&self) -> f64 {
        (self.frequency / LARGE_FREQUENCY_STD).powi(2) + (self.shape / LARGE_SHAPE_STD).powi(2)
    }

    /// The root mean square of the sizes of trends.
    pub(super) fn usual_trend(&self) -> f64 {
        let squares: f64 = self.trends.iter().map(|size| size * size).sum();
        (squares / TRENDS as f64).sqrt()
    }

    /// For what θ is then: errors of one shape at several sensors and at the load are no independent ones, and as a prior count as so many.
    pub(super) fn with_dependent_shapes(self, sensors: usize) -> Self {
        let dependent = ((1 + sensors) as f64 / INDEPENDENT_ERRORS_OF_A_SHAPE).max(1.0);
        Self { shape: dependent.sqrt() * self.shape, ..self }
    }

    /// The same where errors of other kinds are searched too. Own errors of damping that are new have the size that is usual.
    pub(super) fn with_kinds(self, kinds: Kinds, known: KnownSizes) -> Self {
        let is_new = kinds.damping == Damping::Own && self.loss_factor == 0.0;
        let loss_factor = if is_new { MODAL_LOSS_FACTOR_PRIOR_STD } else { self.loss_factor };
        Self { loss_factor, ..self }.of_kinds(kinds, known)
    }

    /// Without damping errors of single modes where those are not searched.
    pub(super) fn of_kinds(self, kinds: Kinds, known: KnownSizes) -> Self {
        match kinds.damping {
            Damping::Own => self,
            _ => Self { loss_factor: 0.0, ..self }.with_common(known),
        }
    }
}
