//! From the hammer to the frequency response function: force and response over time in, FRF with its uncertainty out.
//!
//! ```text
//! recordings → hits → faults → windows → spectra → estimate
//! ```
//!
//! [`estimate_frf`] finds the hits of all recordings, cuts a record of equal length for each, names what is wrong with it, and averages
//! over those with which nothing is. Every hit is told of in [`Measured::hits`], with what spoke against it.
//!
//! The transform is periodic: an FRF from it is that of the structure only where the response has decayed within the record.
//! What is left of it at the end is [`Hit::residual`].

mod baseline;
mod channel;
mod cut;
mod estimate;
mod examine;
mod fault;
mod hit;
mod options;
mod pulse;
mod recording;
mod spectra;
mod unit;
mod window;

pub use channel::Channel;
pub use estimate::{Estimator, Frf, UnknownEstimator, variance};
pub use fault::Fault;
pub use hit::Hit;
pub use options::{Options, OptionsError};
pub use recording::{Recording, RecordingError};
pub use unit::{Kind, Sensitivity, SensitivityError, Unit, UnknownUnit};
pub use window::{Windows, added_decay, added_loss_factor};

use spectra::Spectra;
use std::fmt;

/// What a hammer test gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Every hit that was found, in the order of time; those with [`Hit::is_kept`] make up the FRF.
    pub hits: Vec<Hit>,
    /// Sampling interval.
    pub step_s: f64,
    /// Samples of the record of a hit, the length of the transform.
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
    /// How many hits are averaged.
    pub fn averages(&self) -> usize {
        self.hits.iter().filter(|hit| hit.is_kept()).count()
    }
}

/// Why there is no FRF.
#[derive(Debug, Clone, PartialEq)]
pub enum SignalError {
    /// No option can be like this.
    Options(OptionsError),
    /// Recording k (from 0) does not fit.
    Recording(usize, RecordingError),
    /// No hit is fit to be averaged: every one that was found, with its faults; none where the force never stands out of its noise.
    NoHit(Vec<Hit>),
    /// A hit that is to be kept whatever is wrong with it, by its number from 1, and how many there are.
    NoSuchHit(usize, usize),
}

impl fmt::Display for SignalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Options(error) => write!(f, "{error}"),
            Self::Recording(k, error) => write!(f, "recording {}: {error}", k + 1),
            Self::NoHit(hits) if hits.is_empty() => write!(f, "expected a hit, found no recording"),
            Self::NoHit(hits) => {
                write!(f, "expected a hit without fault, found none among {}", hits.len())?;
                for (k, hit) in hits.iter().enumerate() {
                    let faults: Vec<String> = hit.faults.iter().map(Fault::to_string).collect();
                    write!(f, "; hit {}: {}", k + 1, faults.join(", "))?;
                }
                Ok(())
            }
            Self::NoSuchHit(number, count) => write!(f, "expected a hit from 1 to {count}, found {number}"),
        }
    }
}

impl std::error::Error for SignalError {}

/// Hits, FRF and uncertainty from recordings of one hammer and the same sensors.
///
/// Several recordings are taken as triggered captures, one hit and one record each; a single one may hold many hits and is cut.
///
/// # Errors
/// [`SignalError`].
///
/// # Limits
/// One force. All hits count alike. The force has to be quiet most of the time: a shaker's records have no hits.
pub fn estimate_frf(recordings: &[Recording], options: &Options) -> Result<Measured, SignalError> {
    options.validate().map_err(SignalError::Options)?;
    recording::check(recordings).map_err(|(k, error)| SignalError::Recording(k, error))?;
    let Some(first) = recordings.first() else { return Err(SignalError::NoHit(Vec::new())) };
    let cut::Cut { mut hits, samples } = cut::hits(recordings, options);
    for hit in &mut hits {
        examine::examine(hit, &recordings[hit.recording], samples, options);
    }
    if let Some(&number) = options.keep.iter().find(|&&number| !(1..=hits.len()).contains(&number)) {
        return Err(SignalError::NoSuchHit(number, hits.len()));
    }
    for &number in &options.keep {
        let hit = &mut hits[number - 1];
        let is_there = |fault: &Fault| !matches!(fault, Fault::Missing { .. } | Fault::Silent);
        hit.kept_anyway = hit.range.len() == samples && hit.faults.iter().all(is_there);
    }
    let kept: Vec<&Hit> = hits.iter().filter(|hit| hit.is_kept()).collect();
    if kept.is_empty() {
        return Err(SignalError::NoHit(hits));
    }
    let mut spectra = Spectra::new(samples, first.responses.len());
    for hit in &kept {
        spectra.add(&window::records(&recordings[hit.recording], hit, &options.windows));
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
        hits,
    })
}
