//! From the hammer to the frequency response function: force and response over time in, FRF with its uncertainty out.
//!
//! ```text
//! recordings → impacts → faults → windows → spectra → estimate
//! ```
//!
//! [`estimate_frf`] finds the impacts of all recordings, cuts a record of equal length for each, names what is wrong with it, and averages
//! over those with which nothing is. Every impact is listed in [`Measured::impacts`], with what spoke against it.
//!
//! The transform is periodic: an FRF from it is that of the structure only where the response has decayed within the record.
//! Its rest at the end is [`Impact::residual`].

mod baseline;
mod channel;
mod cut;
mod estimate;
mod examine;
mod fault;
mod impact;
mod options;
mod pulse;
mod recording;
mod spectra;
mod unit;
mod variance;
mod window;

pub use channel::Channel;
pub use estimate::{Estimator, Frf, UnknownEstimator};
pub use fault::Fault;
pub use impact::Impact;
pub use options::{Options, OptionsError};
pub use recording::{Recording, RecordingError};
pub use unit::{Kind, Sensitivity, SensitivityError, Unit, UnknownUnit};
pub use variance::{relative_variance, variances};
pub use window::{Windows, added_decay, added_loss_factor, decaying_within};

use spectra::Spectra;
use std::fmt;

/// What a hammer test gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Every impact that was found, in the order of time; those with [`Impact::is_kept`] make up the FRF.
    pub impacts: Vec<Impact>,
    /// Sampling interval.
    pub step_s: f64,
    /// Samples of the record of an impact, the length of the transform.
    pub samples: usize,
    /// k/T for k from 1 to below the Nyquist frequency, T the length of a record.
    pub frequency_hz: Vec<f64>,
    /// √(Σ|F|²/n) of the force's transform at each frequency, N·s.
    pub force: Vec<f64>,
    /// One a response channel.
    pub frfs: Vec<Frf>,
    /// Decay rate β in 1/s that an exponential window has added ([`added_decay`]): that of the model to compare with.
    pub added_decay_per_s: Option<f64>,
}

impl Measured {
    /// How many impacts are averaged.
    pub fn averages(&self) -> usize {
        self.impacts.iter().filter(|impact| impact.is_kept()).count()
    }
}

/// Why there is no FRF.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SignalError {
    /// No option can be like this.
    Options(OptionsError),
    /// Recording k (from 0) does not fit.
    Recording(usize, RecordingError),
    /// No impact is fit to be averaged: every one that was found, with its faults; none where the force never stands out of its noise.
    NoImpact(Vec<Impact>),
    /// An impact that is to be kept whatever is wrong with it, by its number from 1, and how many there are.
    NoSuchImpact(usize, usize),
}

impl fmt::Display for SignalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Options(error) => write!(f, "{error}"),
            Self::Recording(k, error) => write!(f, "recording {}: {error}", k + 1),
            Self::NoImpact(impacts) if impacts.is_empty() => {
                write!(f, "expected an impact, found no recording")
            }
            Self::NoImpact(impacts) => {
                write!(f, "expected an impact without fault, found none among {}", impacts.len())?;
                for (k, impact) in impacts.iter().enumerate() {
                    let faults: Vec<String> = impact.faults.iter().map(Fault::to_string).collect();
                    write!(f, "; impact {}: {}", k + 1, faults.join(", "))?;
                }
                Ok(())
            }
            Self::NoSuchImpact(number, count) => {
                write!(f, "expected an impact from 1 to {count}, found {number}")
            }
        }
    }
}

impl std::error::Error for SignalError {}

/// Impacts, FRF and uncertainty from recordings of one hammer and the same sensors.
///
/// Several recordings are taken as triggered captures, one impact and one record each; a single one may hold many impacts and is cut.
///
/// # Errors
/// [`SignalError`].
///
/// # Limits
/// One force. All impacts count alike. The force has to be quiet most of the time: a shaker's records have no impacts.
pub fn estimate_frf(recordings: &[Recording], options: &Options) -> Result<Measured, SignalError> {
    options.validate().map_err(SignalError::Options)?;
    recording::check(recordings).map_err(|(k, error)| SignalError::Recording(k, error))?;
    let Some(first) = recordings.first() else { return Err(SignalError::NoImpact(Vec::new())) };
    let cut::Cut { mut impacts, samples } = cut::impacts(recordings, options);
    for impact in &mut impacts {
        examine::examine(impact, &recordings[impact.recording], samples, options);
    }
    if let Some(&number) = options.keep.iter().find(|&&number| !(1..=impacts.len()).contains(&number)) {
        return Err(SignalError::NoSuchImpact(number, impacts.len()));
    }
    for &number in &options.keep {
        let impact = &mut impacts[number - 1];
        let is_there = |fault: &Fault| !matches!(fault, Fault::Missing { .. } | Fault::Silent);
        impact.kept_anyway = impact.range.len() == samples && impact.faults.iter().all(is_there);
    }
    let kept: Vec<&Impact> = impacts.iter().filter(|impact| impact.is_kept()).collect();
    if kept.is_empty() {
        return Err(SignalError::NoImpact(impacts));
    }
    let mut spectra = Spectra::new(samples, first.responses.len());
    for impact in &kept {
        spectra.add(&window::records(&recordings[impact.recording], impact, &options.windows));
    }
    let averages = kept.len();
    let (lines, frequency_hz): (Vec<usize>, Vec<f64>) =
        spectra.lines().map(|k| (k, k as f64 / (samples as f64 * first.step_s))).unzip();
    let frf = |response| estimate::frf(&spectra, response, &lines, averages, options.estimator);
    Ok(Measured {
        step_s: first.step_s,
        samples,
        force: lines.iter().map(|&k| (spectra.force[k] / averages as f64).sqrt() * first.step_s).collect(),
        frfs: (0..first.responses.len()).map(frf).collect(),
        frequency_hz,
        added_decay_per_s: options.windows.exponential_s.map(added_decay),
        impacts,
    })
}
