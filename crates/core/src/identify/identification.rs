//! What came out of an identification.

use super::band::{BandOutcome, LawsOutcome, SmoothCurve, SmoothOutcome};
use super::band_value::{BandCoordinate, BandValue, Direction, Number, Profile};
use super::causality_breach::CausalityBreach;
use super::channel::Calibration;
use super::goodness_of_fit::{Explained, GoodnessOfFit, SensorFit};
use super::model_errors::{Leverage, ModelErrorsFound};
use super::noise::NoiseLevel;
use super::outcome::{Line, Status};
use crate::laws::{Estimate, LawFit, best};
use crate::response::Work;
use frfit_linalg::solve::Breakdown;

/// What came out of an identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// One for each frequency.
    pub lines: Vec<Line>,
    /// The unknowns that hold for the band: constants, geometric parameters and laws.
    pub constants: Vec<BandValue>,
    /// The laws that were fitted to a single unknown, in the order in which they were asked for.
    pub laws: Vec<LawFit>,
    /// The smooth curve of a single unknown.
    pub curve: Option<SmoothCurve>,
    /// Beside a law or a curve: the value of each frequency alone.
    pub free: Vec<Line>,
    /// What was found of each sensor's channel; empty where all channels are calibrated.
    pub channels: Vec<Calibration>,
    /// One for each sensor; empty where each frequency is identified alone.
    pub sensors: Vec<SensorFit>,
    /// How large the noise is, and from what that is known.
    pub noise: NoiseLevel,
    /// Whether noise is all that the model leaves unexplained; `None` where nothing can show it.
    pub fit: Option<GoodnessOfFit>,
    /// Which combinations of the numbers that hold for the band are identifiable.
    pub identifiability: Identifiability,
    /// The errors of the model for which the values are corrected, and which are carried into their error bars; `None` where a right
    /// model explains the band as well.
    pub model_errors: Option<ModelErrorsFound>,
    /// How far an error of each known factor moves each unknown; empty where that was not computed.
    pub leverage: Vec<Leverage>,
    /// Where a modulus is that of no causal material.
    pub causality_breaches: Vec<CausalityBreach>,
    /// What the search did.
    pub search: SearchReport,
}

/// Which combinations of the numbers that hold for the band are identifiable.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Identifiability {
    /// What the coordinates below are.
    pub coordinates: Vec<BandCoordinate>,
    /// Correlation of the numbers.
    pub correlation: Vec<Vec<f64>>,
    /// Combinations of them, the least identifiable first.
    pub directions: Vec<Direction>,
    /// χ² along the first of them.
    pub profile: Option<Profile>,
}

/// What a search did, and how it ended.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SearchReport {
    /// Work of size N.
    pub work: Work,
    /// Vectors of the reduced model; `None` where the full model answered.
    pub reduced_size: Option<usize>,
    /// Frequencies at which all solutions were searched; at the others those of their neighbours were followed.
    pub explored: usize,
    /// Factors on the nominal values of the unknowns about which was searched, where natural frequencies had shown that they are far off; empty where
    /// they had not.
    pub about: Vec<f64>,
    /// Starts that were followed for several unknowns.
    pub starts: usize,
    /// How many of them ended at the result.
    pub agreeing: usize,
    /// Whether the search converged.
    pub converged: bool,
    /// Why there is no reduced model; nothing was searched then.
    pub breakdown: Option<Breakdown>,
}

impl Identification {
    /// Lines and their noise, where nothing else is known.
    pub(super) fn of_lines(lines: Vec<Line>, noise: NoiseLevel) -> Self {
        Self {
            lines,
            constants: Vec::new(),
            laws: Vec::new(),
            curve: None,
            free: Vec::new(),
            channels: Vec::new(),
            sensors: Vec::new(),
            noise,
            fit: None,
            identifiability: Identifiability::default(),
            model_errors: None,
            leverage: Vec::new(),
            causality_breaches: Vec::new(),
            search: SearchReport::default(),
        }
    }

    /// The same where a model with large errors explains the band far better: nothing is ok.
    pub(super) fn of_other_model(mut self) -> Self {
        self.fit = self.fit.map(|fit| fit.of_model(true));
        let statuses = self.lines.iter_mut().map(|line| &mut line.status);
        let statuses = statuses.chain(self.constants.iter_mut().map(|value| &mut value.status));
        statuses.filter(|status| **status == Status::Ok).for_each(|status| *status = Status::Unexplained);
        self
    }

    /// How many lines have this status.
    pub fn count(&self, status: Status) -> usize {
        self.lines.iter().filter(|line| line.status == status).count()
    }

    /// Whether all that holds for the band is trusted, and the measurements are not contradicted.
    pub fn is_trusted(&self) -> bool {
        let explained = self.fit.is_none_or(|fit| fit.verdict != Explained::No);
        explained && self.constants.iter().all(|value| value.status == Status::Ok)
    }

    /// Why there is no answer: each reason once, and for how many lines it is. With several unknowns what breaks down is the search, and every line has its reason.
    pub fn breakdowns(&self) -> Vec<(&Breakdown, usize)> {
        let mut reasons: Vec<(&Breakdown, usize)> = Vec::new();
        for breakdown in self.lines.iter().filter_map(|line| line.breakdown.as_ref()) {
            match reasons.iter_mut().find(|(known, _)| *known == breakdown) {
                Some((_, count)) => *count += 1,
                None => reasons.push((breakdown, 1)),
            }
        }
        reasons
    }

    /// The largest estimated error of the reduced model's response over all values, relative to the measured one; `None` where
    /// the full model answered.
    pub fn reduction_error(&self) -> Option<f64> {
        self.lines.iter().filter_map(|line| line.reduction_error).reduce(f64::max)
    }
}

impl From<BandOutcome> for Identification {
    fn from(band: BandOutcome) -> Self {
        let BandOutcome {
            lines,
            work,
            subspace_size,
            explored,
            noise,
            fit,
            sensors,
            model_errors,
            leverage,
            about,
            ..
        } = band;
        let search = SearchReport {
            work,
            reduced_size: subspace_size,
            explored,
            about: about.into_iter().collect(),
            converged: true,
            ..SearchReport::default()
        };
        let model_errors = model_errors.map(|errors| errors.found());
        Self { sensors, fit, model_errors, leverage, search, ..Self::of_lines(lines, noise) }
    }
}

impl From<SmoothOutcome> for Identification {
    fn from(smooth: SmoothOutcome) -> Self {
        Self { curve: smooth.curve, free: smooth.free.lines, ..smooth.band.into() }
    }
}

impl From<LawsOutcome> for Identification {
    fn from(laws: LawsOutcome) -> Self {
        let LawsOutcome { free, fits, lines, channels, fit, work, subspace_size } = laws;
        // The noise and the sensors of the band, as each frequency alone shows them.
        let per_frequency = free.lines.clone();
        let constants = best(&fits).map(|law| of_law(law, &lines, fit)).into_iter().collect();
        let band = BandOutcome { lines, work, subspace_size, fit, ..free };
        Self { constants, laws: fits, free: per_frequency, channels, ..band.into() }
    }
}

/// The law of a single unknown as what holds for the band. Its parameters may be known only together: where the modulus that they make is known, so is the unknown.
fn of_law(fit: &LawFit, lines: &[Line], band: Option<GoodnessOfFit>) -> BandValue {
    let number = |one: &Estimate| Number { name: one.name.clone(), value: one.value, std: one.std };
    let numbers: Vec<Number> = fit.parameters.iter().map(number).collect();
    let is_known =
        numbers.iter().all(Number::is_identifiable) || lines.iter().any(|line| line.status == Status::Ok);
    let status = Status::of([(!is_known, Status::NotIdentifiable), (!fit.converged, Status::Failed)]);
    BandValue { unknowns: 0, numbers, law: fit.law.clone(), at_bound: false, status: status.within(band) }
}
