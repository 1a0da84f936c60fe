//! What came out when several things were looked for.

use crate::c64;
use crate::identify::{Explained, GoodnessOfFit, NoiseLevel, Status};
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
    /// Its standard deviation, all other unknowns free; `None` where nothing tells the noise. Much larger than the value where the data do not tell it.
    pub std: Option<f64>,
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
    /// `ok`; `not_identifiable` where its standard deviation is above 30 %; `failed` where the search did not converge; `no_root` where it is at its bounds, or nothing was
    /// found at any frequency; `unexplained` where the band is not explained.
    pub status: Status,
}

/// The value of an unknown at a frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueAt {
    /// p.
    pub value: c64,
    /// Standard deviation of its real part.
    pub storage_std: Option<f64>,
    /// Standard deviation of its loss factor; `None` for a real one.
    pub loss_factor_std: Option<f64>,
    /// Correlation of the two.
    pub correlation: Option<f64>,
}

/// One frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct SeveralAt {
    /// The frequency.
    pub frequency_hz: f64,
    /// Nominal values of all unknowns.
    pub nominal: Vec<c64>,
    /// One for each unknown, those that hold for the band too; `None` where nothing was found.
    pub values: Vec<Option<ValueAt>>,
    /// How far what the frequency has of its own can be trusted; of unknowns that all hold for the band, whether it is explained by them.
    pub status: Status,
    /// Other values of all unknowns that the data cannot exclude.
    pub alternatives: Vec<Vec<c64>>,
    /// ε over all sensors, P-40.
    pub error: Option<f64>,
    /// χ² of the sensors at the level of the noise, over their number of real values.
    pub chi_squared: Option<f64>,
    /// Estimated error of the reduced response, relative to the measured one.
    pub reduction_error: Option<f64>,
    /// Receptance at the sensors with the nominal values; empty where it could not be solved.
    pub nominal_response: Vec<c64>,
    /// Receptance with the values that were found.
    pub updated_response: Vec<c64>,
}

/// A direction in the logarithms of the numbers that hold for the band.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// (index of the coordinate, its weight), the weights' squares summing to one, largest first.
    pub weights: Vec<(usize, f64)>,
    /// Standard deviation along it: 0.01 is one per cent; infinite where nothing tells it.
    pub std: f64,
}

/// The misfit along the direction that is told worst, all else at its best.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// How far from the answer along [`SeveralOutcome::directions`]`[0]`, and by how much χ² is larger there.
    pub points: Vec<(f64, f64)>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct SeveralOutcome {
    /// The unknowns that hold for the band.
    pub band: Vec<BandValue>,
    /// One for each frequency.
    pub at: Vec<SeveralAt>,
    /// What the coordinates of [`Self::correlation`] and [`Self::directions`] are: (unknown, name of the number).
    pub coordinates: Vec<(usize, String)>,
    /// Correlation of the numbers that hold for the band.
    pub correlation: Vec<Vec<f64>>,
    /// Combinations of them, the one that is told worst first.
    pub directions: Vec<Direction>,
    /// χ² along the first of them.
    pub profile: Option<Profile>,
    /// How large the noise is.
    pub noise: NoiseLevel,
    /// Whether noise is all that is left.
    pub fit: Option<GoodnessOfFit>,
    /// Whether the search settled.
    pub converged: bool,
    /// Starts that were followed, and how many of them ended at the answer.
    pub starts: usize,
    /// See [`Self::starts`].
    pub agreeing: usize,
    /// Work of size N.
    pub work: Work,
    /// Vectors of the subspace.
    pub subspace_size: usize,
    /// Why there is no subspace; nothing was looked for then.
    pub breakdown: Option<Breakdown>,
}

impl SeveralOutcome {
    /// Whether all that holds for the band is trusted, and the measurements are not contradicted.
    pub fn is_trusted(&self) -> bool {
        let explained = self.fit.is_none_or(|fit| fit.verdict != Explained::No);
        explained && self.band.iter().all(|value| value.status == Status::Ok)
    }
}
