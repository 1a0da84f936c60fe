//! The outcome of an identification of several unknowns.

use crate::identify::channel::Calibration;
use crate::identify::goodness_of_fit::{GoodnessOfFit, SensorFit};
use crate::identify::model_errors::{Leverage, ModelErrorsFound};
use crate::identify::noise::NoiseLevel;
use crate::identify::outcome::{Line, Status};
use crate::identify::uncertainty::{KNOWN_RELATIVE_STD, MIN_KNOWN_LOSS_FACTOR};
use crate::material::Law;
use crate::response::Work;
use frfit_linalg::solve::Breakdown;

/// A number that holds for the whole band.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// As a law calls it (`storage`, `loss_factor`, `e0`); `value` of a real constant.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard deviation, all other unknowns free; `None` where the noise is not known. Much larger than the value where that is not identifiable.
    pub std: Option<f64>,
}

impl Number {
    /// Whether it is a loss factor, beside the storage part of the same constant.
    fn is_loss_factor(&self) -> bool {
        self.name == "loss_factor"
    }

    /// Whether it is a loss factor that noise leaves unknown.
    pub(in crate::identify) fn is_unknown_loss_factor(&self) -> bool {
        self.is_loss_factor() && !self.is_known_beside(self.value.abs().max(MIN_KNOWN_LOSS_FACTOR))
    }

    /// Whether noise leaves the unknown known, as far as it depends on this number: a loss factor is compared with one, since it is a share of the storage part.
    pub(in crate::identify) fn is_identifiable(&self) -> bool {
        self.is_known_beside(self.value.abs().max(if self.is_loss_factor() { 1.0 } else { 0.0 }))
    }

    fn is_known_beside(&self, size: f64) -> bool {
        self.std.is_some_and(|std| std <= KNOWN_RELATIVE_STD * size)
    }
}

/// An unknown that holds for the whole band.
#[derive(Debug, Clone, PartialEq)]
pub struct BandValue {
    /// Which of the unknowns.
    pub unknowns: usize,
    /// Its numbers.
    pub numbers: Vec<Number>,
    /// It as a law.
    pub law: Law,
    /// Whether it is at one of its bounds, beyond which the misfit is less.
    pub at_bound: bool,
    /// `ok`; `not_identifiable` where its standard deviation is above 30 %, that of a loss factor above 0.3; `failed` where the search did not converge; `no_root` where it is at its bounds, or nothing was
    /// found at any frequency; `unexplained` where the band is not explained.
    pub status: Status,
}

/// What a number that holds for the band belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberOf {
    /// An unknown, by its index.
    Unknown(usize),
    /// The channel of a sensor, by its index.
    Channel(usize),
}

/// A number that holds for the band, as a coordinate of the directions below.
#[derive(Debug, Clone, PartialEq)]
pub struct BandCoordinate {
    /// What it belongs to.
    pub of: NumberOf,
    /// Name of the number: `value`, `storage`, `loss_factor`, or that of a law; of a channel `scale` or `delay_s`.
    pub number: String,
}

/// A direction in the logarithms of the numbers that hold for the band; of a delay in radians at the top of the band.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// (index of the coordinate, its weight), the weights' squares summing to one, largest first.
    pub weights: Vec<(usize, f64)>,
    /// Standard deviation along it: 0.01 is one per cent; infinite where it is not identifiable.
    pub std: f64,
}

/// The misfit along the least identifiable direction, all else at its best.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// How far from the answer along the least identifiable direction, and by how much χ² is larger there: by 1 a standard deviation away where the bars hold noise alone, by more where they
    /// hold errors of the model too.
    pub points: Vec<(f64, f64)>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct SeveralOutcome {
    /// The unknowns that hold for the band.
    pub(in crate::identify) band: Vec<BandValue>,
    /// One for each frequency.
    pub(in crate::identify) lines: Vec<Line>,
    /// What the coordinates of [`Self::correlation`] and [`Self::directions`] are.
    pub(in crate::identify) coordinates: Vec<BandCoordinate>,
    /// Correlation of the numbers that hold for the band.
    pub(in crate::identify) correlation: Vec<Vec<f64>>,
    /// Combinations of them, the least identifiable first.
    pub(in crate::identify) directions: Vec<Direction>,
    /// One for each sensor; empty where all channels are calibrated.
    pub(in crate::identify) channels: Vec<Calibration>,
    /// χ² along the first of them.
    pub(in crate::identify) profile: Option<Profile>,
    /// How large the noise is.
    pub(in crate::identify) noise: NoiseLevel,
    /// Whether noise is all that is left.
    pub(in crate::identify) fit: Option<GoodnessOfFit>,
    /// One for each sensor.
    pub(in crate::identify) sensors: Vec<SensorFit>,
    /// The errors of the model that were corrected for.
    pub(in crate::identify) model_errors: Option<ModelErrorsFound>,
    pub(in crate::identify) leverage: Vec<Leverage>,
    /// Whether the search settled.
    pub(in crate::identify) converged: bool,
    /// Factors on the nominal values about which was searched, where they are far off; else empty.
    pub(in crate::identify) about: Vec<f64>,
    /// Starts that were followed, and how many of them ended at the answer.
    pub(in crate::identify) starts: usize,
    /// See [`Self::starts`].
    pub(in crate::identify) agreeing: usize,
    /// Work of size N.
    pub(in crate::identify) work: Work,
    /// Vectors of the subspace.
    pub(in crate::identify) subspace_size: usize,
    /// Why there is no subspace; nothing was searched then.
    pub(in crate::identify) breakdown: Option<Breakdown>,
}

impl SeveralOutcome {
    /// The same where a model with large errors explains the band far better: nothing is ok.
    pub(super) fn of_other_model(mut self) -> Self {
        self.fit = self.fit.map(|fit| fit.of_model(true));
        let statuses = self.lines.iter_mut().map(|line| &mut line.status);
        let statuses = statuses.chain(self.band.iter_mut().map(|value| &mut value.status));
        statuses.filter(|status| **status == Status::Ok).for_each(|status| *status = Status::Unexplained);
        self
    }
}
