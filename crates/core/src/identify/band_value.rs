//! What came out of unknowns that hold for the whole band.

use super::outcome::Status;
use super::uncertainty::{KNOWN_RELATIVE_STD, MIN_KNOWN_LOSS_FACTOR};
use crate::material::Law;

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
    pub(super) fn is_unknown_loss_factor(&self) -> bool {
        self.is_loss_factor() && !self.is_known_beside(self.value.abs().max(MIN_KNOWN_LOSS_FACTOR))
    }

    /// Whether noise leaves the unknown known, as far as it depends on this number: a loss factor is compared with one, since it is a share of the storage part.
    pub(super) fn is_identifiable(&self) -> bool {
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
