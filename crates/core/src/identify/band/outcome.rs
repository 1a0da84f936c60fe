//! What came out of a band with one unknown.

use super::fit::{excess_of_neighbours, goodness};
use crate::identify::goodness_of_fit::{GoodnessOfFit, SensorFit, is_unexplained_stretch};
use crate::identify::measured::Band;
use crate::identify::model_errors::{AveragedModel, Estimated, Leverage};
use crate::identify::noise::{NoiseLevel, freedom};
use crate::identify::outcome::{Line, Status};
use crate::response::Work;

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct BandOutcome {
    /// One for each frequency.
    pub lines: Vec<Line>,
    /// Work of size N.
    pub work: Work,
    /// Vectors of the subspace; `None` where the full model answered.
    pub subspace_size: Option<usize>,
    /// Frequencies at which all solutions were searched; at the others those of their neighbours were followed.
    pub explored: usize,
    /// How large the noise is, and the source of that. Unknown where each frequency is answered alone.
    pub noise: NoiseLevel,
    /// Whether noise is all that the answers leave unexplained; `None` where that cannot be tested.
    pub fit: Option<GoodnessOfFit>,
    /// One for each sensor; empty where each frequency is answered alone.
    pub sensors: Vec<SensorFit>,
    /// Errors of the model that were corrected for; `None` where none were found.
    pub model_errors: Option<Estimated>,
    /// Errors of a right model that are too small to be seen, and are in its bars.
    pub small_errors: Option<AveragedModel>,
    /// How far errors of known factors move the unknown.
    pub leverage: Vec<Leverage>,
    /// Whether a model with large errors explains the band far better: it is another one.
    pub other_model: bool,
    /// The factor on the nominal value about which was searched, where natural frequencies had shown it to be far off.
    pub about: Option<f64>,
}

impl BandOutcome {
    /// Lines, and what it took to find them: nothing is known of the band as a whole.
    pub(super) fn of_lines(
        lines: Vec<Line>,
        work: Work,
        subspace_size: Option<usize>,
        explored: usize,
    ) -> Self {
        Self {
            lines,
            work,
            subspace_size,
            explored,
            noise: NoiseLevel::UNKNOWN,
            fit: None,
            sensors: Vec::new(),
            model_errors: None,
            small_errors: None,
            leverage: Vec::new(),
            other_model: false,
            about: None,
        }
    }

    /// How many frequencies have an answer.
    pub(super) fn answered(&self) -> usize {
        self.lines.iter().filter(|line| line.on_path).count()
    }

    /// With bars and statuses that the fit of the band and of each stretch allows.
    pub(super) fn judged_by_fit(mut self) -> Self {
        let rest = self.rest();
        self.fit = self.fit.map(|fit| fit.of_model(self.other_model).beside(rest));
        if let Some(fit) = &self.fit {
            let of_neighbours = excess_of_neighbours(&self.lines, fit);
            for (line, excess) in self.lines.iter_mut().zip(of_neighbours) {
                line.lengthen_bars(excess.sqrt().max(fit.excess()));
                if line.status == Status::Ok && is_unexplained_stretch(excess, &self.noise) {
                    line.status = Status::Unexplained;
                }
            }
        }
        for line in &mut self.lines {
            line.status = match line.status {
                Status::Ok if self.other_model => Status::Unexplained,
                status => status.within(self.fit),
            };
        }
        self
    }

    /// With the fit of answers where so many numbers were fitted to the whole band too.
    pub(super) fn with_fitted(mut self, fitted: usize, band: &Band<'_>) -> Self {
        let counted = self.sensors.iter().filter(|sensor| !sensor.left_out).count();
        let each = freedom(counted, band.unknown.real);
        self.fit = goodness(&self.lines, each, fitted, &self.noise, band);
        self
    }

    /// Errors that are in the bars.
    pub(super) fn errors_in_bars(&self) -> Option<&Estimated> {
        let small = self.small_errors.as_ref().map(|small| &small.estimated);
        self.model_errors.as_ref().or(small)
    }

    /// What the response has beside noise and errors of the model, relative to itself.
    pub(super) fn rest(&self) -> f64 {
        self.model_errors.as_ref().map_or(0.0, |errors| errors.rest)
    }

    /// The sensors that are left out.
    pub(super) fn left_out(&self) -> Vec<usize> {
        (0..self.sensors.len()).filter(|&m| self.sensors[m].left_out).collect()
    }
}
