//! What was recorded.

use super::Channel;
use std::fmt;

/// Channels sampled at the same, equally spaced instants, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Sampling interval in s.
    pub step_s: f64,
    /// The force in N; empty where the channel is missing.
    pub force: Vec<f64>,
    /// Displacement (m), velocity (m/s) or acceleration (m/s²) of each sensor; one that is missing is empty.
    pub responses: Vec<Vec<f64>>,
}

/// What is wrong with a recording, so that no FRF can be made.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum RecordingError {
    /// A sampling interval that is not a positive number, or not that of the first recording.
    Step(f64),
    /// Not as many sensors as the first recording has.
    Sensors(usize),
    /// A sample that is not finite.
    NotFinite(Channel),
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(step_s) => {
                write!(f, "expected the sampling interval of the first recording, found {step_s} s")
            }
            Self::Sensors(count) => {
                write!(f, "expected as many sensors as the first recording has, found {count}")
            }
            Self::NotFinite(channel) => {
                write!(f, "expected finite samples, found others in channel {channel}")
            }
        }
    }
}

impl std::error::Error for RecordingError {}

/// How far sampling intervals may differ and be the same: a file's six digits of them.
const STEP_MATCH_RTOL: f64 = 1e-6;

impl Recording {
    /// The samples of a channel.
    ///
    /// # Panics
    /// Where there is no such sensor.
    pub fn channel(&self, channel: Channel) -> &[f64] {
        match channel {
            Channel::Force => &self.force,
            Channel::Response(k) => &self.responses[k],
        }
    }

    /// The force, then every sensor.
    pub(super) fn channels(&self) -> impl Iterator<Item = Channel> + use<> {
        std::iter::once(Channel::Force).chain((0..self.responses.len()).map(Channel::Response))
    }

    /// Samples that all channels which are there have.
    pub(super) fn len(&self) -> usize {
        let there = self.channels().map(|channel| self.channel(channel).len()).filter(|&n| n > 0);
        there.min().unwrap_or(0)
    }
}

pub(super) fn check(recordings: &[Recording]) -> Result<(), (usize, RecordingError)> {
    let Some(first) = recordings.first() else { return Ok(()) };
    for (k, recording) in recordings.iter().enumerate() {
        let step_s = recording.step_s;
        // Written so that NaN fails too.
        if !(step_s > 0.0 && (step_s - first.step_s).abs() <= STEP_MATCH_RTOL * first.step_s) {
            return Err((k, RecordingError::Step(step_s)));
        }
        if recording.responses.len() != first.responses.len() {
            return Err((k, RecordingError::Sensors(recording.responses.len())));
        }
        let broken = |channel: &Channel| recording.channel(*channel).iter().any(|x| !x.is_finite());
        if let Some(channel) = recording.channels().find(broken) {
            return Err((k, RecordingError::NotFinite(channel)));
        }
    }
    Ok(())
}
