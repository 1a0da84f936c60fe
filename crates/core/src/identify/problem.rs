//! What is to be identified, checked: a model, an experiment, unknowns, channels and measured FRFs.

use super::channel::ChannelUnknowns;
use super::choice::{Method, Reduction, Selection};
use super::coarser_mesh::CoarserMesh;
use super::common_noise::with_correlation;
use super::measured::Band;
use super::noise_floor::with_floor;
use super::options::{ModelErrors, Options};
use super::problem_error::{ProblemError, value};
use super::unknown::{Composite, Dependence, Unknown, Variation};
use crate::c64;
use crate::frfs::{Frfs, Noise};
use crate::laws::LawKind;
use crate::material::OutsideTable;
use crate::model::{DynamicStiffness, Experiment, ModelAt, Parameter};
use crate::roots::BoundsError;
use std::fmt;

/// A problem without a fault that could be seen before it is solved.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    pub(super) model: &'a DynamicStiffness,
    pub(super) experiment: &'a Experiment,
    pub(super) unknowns: &'a [Unknown],
    pub(super) channels: &'a [ChannelUnknowns],
    pub(super) frfs: Frfs<'a>,
    pub(super) coarser: Option<&'a CoarserMesh>,
    /// The only unknown as the parameter of a polynomial, where it can be one.
    parameter: Option<Parameter>,
}

/// How a single unknown is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Strategy<'a> {
    /// At each frequency, with all its solutions (B-2, B-4).
    PerFrequency,
    /// As a smooth function of frequency (B-9).
    Smooth,
    /// By the law of least BIC among these (B-7).
    Law(&'a [LawKind]),
}

/// What roundoff leaves of degrees, which are whole numbers, where they cancel.
const NO_DEGREE: f64 = 1e-9;

/// Powers of an unknown beyond these leave no digit.
const MAX_POWER: i32 = 12;

impl<'a> Problem<'a> {
    /// Checks everything that can be checked before the problem is solved.
    ///
    /// `channels` has one entry for each sensor, or none where all of them are calibrated.
    ///
    /// # Errors
    /// [`ProblemError`]: what is wrong, where, what was expected and what was found.
    pub fn new(
        model: &'a DynamicStiffness,
        experiment: &'a Experiment,
        unknowns: &'a [Unknown],
        channels: &'a [ChannelUnknowns],
        frfs: Frfs<'a>,
    ) -> Result<Self, ProblemError> {
        let known =
            channels.len() == experiment.sensors.len() && !channels.iter().any(|channel| channel.any());
        let channels = if known { &[] } else { channels };
        let parameter = if let [only] = unknowns { only.parameter() } else { None };
        let mut problem = Self { model, experiment, unknowns, channels, frfs, coarser: None, parameter };
        check_experiment("", model, experiment)?;
        problem.check_frfs()?;
        problem.check_noise()?;
        problem.check_unknowns()?;
        problem.check_channels()?;
        problem.frfs.noise = with_correlation(Frfs { noise: with_floor(frfs), ..frfs });
        Ok(problem)
    }

    /// With the same structure on a coarser mesh, by which the error of this one is measured.
    ///
    /// # Errors
    /// [`ProblemError`] where it is not the same structure, or something stands in the way of estimating errors of the model: channels of unknown scale or delay.
    pub fn with_coarser_mesh(self, mesh: &'a CoarserMesh) -> Result<Self, ProblemError> {
        let is_unknown = |term| self.unknowns.iter().any(|one| one.dependence.terms().any(|own| own == term));
        check_experiment("coarser mesh: ", &mesh.model, &mesh.experiment)?;
        mesh.validate(self.model, self.experiment, is_unknown, self.frfs.frequency_hz)?;
        if !self.channels.is_empty() {
            return Err(ProblemError::Unsupported {
                what: "a coarser mesh",
                reason: "expected calibrated channels: errors of the model cannot be separated from an unknown scale or delay",
            });
        }
        Ok(Self { coarser: Some(mesh), ..self })
    }

    /// Whether one of its unknowns is a smooth curve.
    pub(super) fn has_smooth(&self) -> bool {
        self.unknowns.iter().any(|one| one.varies == Variation::Smooth)
    }

    /// The same problem with other unknowns.
    pub(super) fn with_unknowns<'b>(&self, unknowns: &'b [Unknown]) -> Problem<'b>
    where
        'a: 'b,
    {
        Problem { unknowns, parameter: None, ..*self }
    }

    /// The model.
    pub fn model(&self) -> &'a DynamicStiffness {
        self.model
    }

    /// Load and sensors.
    pub fn experiment(&self) -> &'a Experiment {
        self.experiment
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &'a [Unknown] {
        self.unknowns
    }

    /// What is unknown of each sensor's channel; empty where all of them are calibrated.
    pub fn channels(&self) -> &'a [ChannelUnknowns] {
        self.channels
    }

    /// The measurement.
    pub fn frfs(&self) -> Frfs<'a> {
        self.frfs
    }

    /// Real numbers that are measured, and real numbers that are unknown.
    pub fn counts(&self) -> [usize; 2] {
        let (frequencies, sensors) = (self.frfs.frequency_hz.len(), self.experiment.sensors.len());
        let per_frequency: usize = self.unknowns.iter().map(Unknown::per_frequency).sum();
        let for_band: usize = self.unknowns.iter().map(Unknown::for_band).sum();
        let channels: usize = self.channels.iter().map(|channel| channel.count()).sum();
        [2 * sensors * frequencies, per_frequency * frequencies + for_band + channels]
    }

    /// How the only unknown is found, and it as the parameter of a polynomial; `None` where all unknowns are found in one least squares
    /// (B-8): several, a constant, or one with a negative power.
    pub(super) fn single(&self) -> Option<(Strategy<'a>, &Parameter)> {
        let [only] = self.unknowns else { return None };
        let strategy = match &only.varies {
            Variation::PerFrequency => Strategy::PerFrequency,
            Variation::Smooth => Strategy::Smooth,
            Variation::Law(kinds) => Strategy::Law(kinds),
            Variation::Constant => return None,
        };
        Some((strategy, self.parameter.as_ref()?))
    }

    /// The band as the strategies of a single unknown take it: of the j-th, and it as the parameter of a polynomial.
    pub(crate) fn band<'b>(&self, j: usize, parameter: &'b Parameter) -> Band<'b>
    where
        'a: 'b,
    {
        let Self { model, experiment, frfs, coarser, .. } = *self;
        let Frfs { frequency_hz, receptance: measured, noise } = frfs;
        Band {
            model,
            experiment,
            unknown: &self.unknowns[j],
            parameter,
            frequency_hz,
            measured,
            noise,
            coarser,
        }
    }

    /// The model as a function of the j-th unknown, to first order, with all others at their nominal values.
    pub(crate) fn about(&self, j: usize, frequency_hz: &[f64]) -> Result<Vec<ModelAt<'a>>, OutsideTable> {
        let composite = Composite { model: self.model, unknowns: self.unknowns };
        frequency_hz.iter().map(|&f| composite.about_one(f, &composite.nominal(f)?, j)).collect()
    }

    /// The model at these values of all unknowns.
    pub(crate) fn at(&self, frequency_hz: f64, values: &[c64]) -> Result<ModelAt<'a>, OutsideTable> {
        Composite { model: self.model, unknowns: self.unknowns }.at(frequency_hz, values)
    }

    /// Checks the options, alone and with this problem.
    pub(super) fn check_options(&self, options: &Options) -> Result<(), ProblemError> {
        options.validate()?;
        let per_frequency = self.single().is_some_and(|(strategy, _)| strategy == Strategy::PerFrequency);
        let paper = options.method != Method::Rational || options.selection != Selection::Joint;
        if paper && (!per_frequency || !self.channels.is_empty()) {
            return Err(ProblemError::Unsupported {
                what: "method and selection",
                reason: "expected \"rational\" and \"joint\": the others find one factor at each frequency from calibrated channels",
            });
        }
        if self.coarser.is_some() {
            let needs = |reason| Err(ProblemError::Unsupported { what: "a coarser mesh", reason });
            if options.model_errors == ModelErrors::None {
                return needs("expected errors of the model to be estimated, found model_error = \"none\"");
            }
            if paper || options.reduction == Reduction::Full {
                return needs(
                    "expected method \"rational\", selection \"joint\" and a reduced model, on which errors of the model are estimated",
                );
            }
        }
        Ok(())
    }

    fn check_frfs(&self) -> Result<(), ProblemError> {
        let Frfs { frequency_hz, receptance, .. } = self.frfs;
        if frequency_hz.is_empty() {
            let what = "frequencies".into();
            return Err(ProblemError::Count { what, expected: "at least one".into(), found: 0 });
        }
        for (i, &f) in frequency_hz.iter().enumerate() {
            if !(f.is_finite() && f >= 0.0) {
                return Err(value(format!("frequency {i}"), "a finite number of Hz that is not negative", f));
            }
            if i > 0 && f <= frequency_hz[i - 1] {
                let found = format!("{f} after {}", frequency_hz[i - 1]);
                return Err(value(format!("frequency {i}"), "ascending frequencies", found));
            }
        }
        self.check_rows("FRF", receptance)?;
        for (i, row) in receptance.iter().enumerate() {
            if let Some(m) = row.iter().position(|u| !u.is_finite()) {
                let what = format!("FRF of sensor {m} at {} Hz", frequency_hz[i]);
                return Err(value(what, "a finite number", row[m]));
            }
        }
        Ok(())
    }

    /// One row for each frequency, with one entry for each sensor.
    fn check_rows<T>(&self, what: &str, rows: &[Vec<T>]) -> Result<(), ProblemError> {
        let (frequencies, sensors) = (self.frfs.frequency_hz.len(), self.experiment.sensors.len());
        if rows.len() != frequencies {
            let expected = format!("{frequencies} rows, one for each frequency");
            return Err(ProblemError::Count { what: what.into(), expected, found: rows.len() });
        }
        match rows.iter().position(|row| row.len() != sensors) {
            None => Ok(()),
            Some(i) => Err(ProblemError::Count {
                what: format!("{what} at {} Hz", self.frfs.frequency_hz[i]),
                expected: format!("{sensors} values, one for each sensor"),
                found: rows[i].len(),
            }),
        }
    }

    fn check_noise(&self) -> Result<(), ProblemError> {
        let (Noise::Known(std) | Noise::Relative(std)) = self.frfs.noise else { return Ok(()) };
        self.check_rows("standard deviation", std)?;
        for (row, f) in std.iter().zip(self.frfs.frequency_hz) {
            // An infinite one is a value that counts for nothing.
            if let Some(m) = row.iter().position(|std| std.is_nan() || *std < 0.0) {
                let what = format!("standard deviation of sensor {m} at {f} Hz");
                return Err(value(what, "a number that is not negative", row[m]));
            }
        }
        Ok(())
    }

    fn check_unknowns(&self) -> Result<(), ProblemError> {
        if self.unknowns.is_empty() {
            let what = "unknowns".into();
            return Err(ProblemError::Count { what, expected: "at least one".into(), found: 0 });
        }
        for (j, one) in self.unknowns.iter().enumerate() {
            self.check_unknown(j, one)?;
        }
        let [measured, unknown] = self.counts();
        if self.single().is_none() && measured < unknown {
            return Err(ProblemError::Undetermined { measured, unknown });
        }
        Ok(())
    }

    fn check_unknown(&self, j: usize, one: &Unknown) -> Result<(), ProblemError> {
        let wrong = |expected: &str, found: &dyn fmt::Display| ProblemError::Unknown {
            name: one.name.clone(),
            expected: expected.into(),
            found: found.to_string(),
        };
        let terms: Vec<usize> = one.dependence.terms().collect();
        if terms.is_empty() {
            return Err(wrong("at least one matrix that it enters", &"none"));
        }
        for (k, &term) in terms.iter().enumerate() {
            if term >= self.model.terms().len() {
                return Err(wrong("matrices of the model", &format_args!("matrix {term}")));
            }
            if terms[..k].contains(&term) {
                return Err(wrong(
                    "each matrix once",
                    &format_args!("{:?} twice", self.model.terms()[term].name),
                ));
            }
        }
        if let Dependence::Powers(powers) = &one.dependence
            && let Some((_, power)) = powers.iter().find(|(_, d)| *d == 0 || d.abs() > MAX_POWER)
        {
            return Err(wrong("powers from -12 to 12 that are not zero", power));
        }
        for other in &self.unknowns[..j] {
            if other.name == one.name {
                return Err(wrong("a name of its own", &"another unknown of this name"));
            }
            if let (Dependence::Factor(mine), Dependence::Factor(theirs)) =
                (&one.dependence, &other.dependence)
                && let Some(term) = mine.iter().find(|term| theirs.contains(term))
            {
                let found = format!(
                    "{:?}, which is the factor of {:?} too",
                    other.name,
                    self.model.terms()[*term].name
                );
                return Err(wrong("a factor of its own", &found));
            }
        }
        if let Err(BoundsError { name, found: [low, high], .. }) = one.bounds.validate() {
            let expected = format!("bounds.{name} as {}", BoundsError::EXPECTED);
            return Err(wrong(&expected, &format_args!("[{low}, {high}]")));
        }
        match &one.varies {
            Variation::Law(kinds) if kinds.is_empty() => return Err(wrong("at least one law", &"none")),
            Variation::Law(kinds) if kinds.len() > 1 && self.unknowns.len() > 1 => {
                return Err(wrong("one law beside other unknowns", &kinds.len()));
            }
            Variation::Law(_) if one.real => return Err(wrong("a complex law", &"a real unknown")),
            // The data cannot show which of the two varies from line to line.
            Variation::PerFrequency if self.has_smooth() => {
                return Err(wrong(
                    "smooth, constant or a law beside a smooth factor",
                    &"a value at each frequency",
                ));
            }
            Variation::Smooth if matches!(one.dependence, Dependence::Powers(_)) => {
                return Err(wrong("a smooth factor", &"powers"));
            }
            _ => {}
        }
        for &f in self.frfs.frequency_hz {
            let nominal = one.nominal.at(f)?;
            if !nominal.is_finite() {
                return Err(wrong("a finite nominal value", &format_args!("{nominal} at {f} Hz")));
            }
        }
        Ok(())
    }

    fn check_channels(&self) -> Result<(), ProblemError> {
        let (channels, sensors) = (self.channels.len(), self.experiment.sensors.len());
        if channels != 0 && channels != sensors {
            let expected = format!("{sensors}, one for each sensor, or none");
            return Err(ProblemError::Count { what: "channels".into(), expected, found: channels });
        }
        let unsupported = |reason| {
            let what = "a channel of unknown scale or delay";
            Err(ProblemError::Unsupported { what, reason })
        };
        if channels == 0 {
            return Ok(());
        }
        if matches!(self.unknowns, [one] if one.varies == Variation::Smooth) {
            return unsupported("expected a law or a value at each frequency, found a smooth factor");
        }
        let all_vary = self.unknowns.iter().all(|one| one.per_frequency() > 0);
        if all_vary && self.channels.iter().all(|channel| channel.any()) {
            return unsupported(
                "a free value at each frequency explains every scale: expected one calibrated channel, or a law",
            );
        }
        if self.channels.iter().all(|channel| channel.scale) && self.has_common_scale() {
            return unsupported(
                "the unknowns scale the whole model, and with it every response: expected one channel of known scale, or one known factor",
            );
        }
        Ok(())
    }

    /// Whether some powers of the unknowns multiply every term of the model alike: Σ_j d_tj α_j = 1 for each term t, with d_tj the degree of unknown j in it.
    fn has_common_scale(&self) -> bool {
        let degree = |term: usize, one: &Unknown| match &one.dependence {
            Dependence::Factor(terms) => f64::from(u8::from(terms.contains(&term))),
            Dependence::Powers(powers) => {
                powers.iter().find(|(other, _)| *other == term).map_or(0.0, |(_, d)| f64::from(*d))
            }
        };
        let row = |term| self.unknowns.iter().map(|one| degree(term, one)).chain([1.0]).collect();
        let mut rows: Vec<Vec<f64>> = (0..self.model.terms().len()).map(row).collect();
        // Gauss's elimination: a row that ends as 0 = 1 has no solution.
        for j in 0..self.unknowns.len() {
            let Some(k) = (0..rows.len()).max_by(|&a, &b| rows[a][j].abs().total_cmp(&rows[b][j].abs()))
            else {
                break;
            };
            if rows[k][j].abs() <= NO_DEGREE {
                continue;
            }
            let pivot = rows.swap_remove(k);
            for row in &mut rows {
                let by = row[j] / pivot[j];
                row.iter_mut().zip(&pivot).for_each(|(value, own)| *value -= by * own);
            }
        }
        rows.iter().all(|row| row.last().is_none_or(|rest| rest.abs() <= NO_DEGREE))
    }
}

/// Refuses a load or sensors that a model cannot have; `of` stands before what is wrong.
fn check_experiment(of: &str, model: &DynamicStiffness, experiment: &Experiment) -> Result<(), ProblemError> {
    let dim = model.dim();
    let decay_per_s = model.decay_per_s();
    if !(decay_per_s.is_finite() && decay_per_s >= 0.0) {
        let expected = "a finite number of 1/s that is not negative: that of a window e^(-decay t)";
        return Err(value(format!("{of}decay_per_s of the model"), expected, decay_per_s));
    }
    let Experiment { load, sensors } = experiment;
    if load.len() != dim {
        let expected = format!("{dim} entries, as the model has degrees of freedom");
        return Err(ProblemError::Count { what: format!("{of}load"), expected, found: load.len() });
    }
    if let Some(row) = load.iter().position(|force| !force.is_finite()) {
        return Err(value(format!("{of}load at row {row}"), "a finite number", load[row]));
    }
    if load.iter().all(|force| force.norm() == 0.0) {
        return Err(value(format!("{of}load"), "at least one entry that is not zero", "none"));
    }
    if sensors.is_empty() {
        return Err(ProblemError::Count {
            what: format!("{of}sensors"),
            expected: "at least one".into(),
            found: 0,
        });
    }
    match sensors.iter().enumerate().find(|(_, sensor)| sensor.row >= dim || !sensor.sign.is_finite()) {
        None => Ok(()),
        Some((m, sensor)) if sensor.row >= dim => {
            Err(value(format!("{of}row of sensor {m}"), "a row of the model", sensor.row))
        }
        Some((m, sensor)) => Err(value(format!("{of}sign of sensor {m}"), "1 or -1", sensor.sign)),
    }
}
