//! An impact, with what was found of it.

use super::{Channel, Fault};
use std::ops::Range;

/// An impact that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// Which recording it is in, from 0.
    pub recording: usize,
    /// The first sample of the recording at or above the trigger.
    pub onset: usize,
    /// The last one of the contact.
    pub last: usize,
    /// The samples of the recording that are its record.
    pub range: Range<usize>,
    /// The largest force in N, spikes aside, above what it is where nothing happens.
    pub peak_n: f64,
    /// What is wrong with it.
    pub faults: Vec<Fault>,
    /// Whether it is averaged all the same.
    pub kept_anyway: bool,
    /// The rest of each response over the last tenth of the record: rms about the mean, over its largest value.
    pub residual: Vec<f64>,
    /// The same before the impact, where the record has enough of that: noise.
    pub noise: Option<Vec<f64>>,
}

/// A response has decayed where less than this is left: with a residual q, the FRF at a resonance is wrong by about q.
const DECAYED_RESIDUAL: f64 = 0.01;

/// Samples before the trigger that already belong to the contact.
pub(super) const FOOT_SAMPLES: usize = 4;

impl Impact {
    /// Whether it is averaged.
    pub fn is_kept(&self) -> bool {
        self.faults.is_empty() || self.kept_anyway
    }

    /// How long the force was at or above the trigger, in s.
    pub fn contact_s(&self, step_s: f64) -> f64 {
        if self.peak_n > 0.0 { (self.last + 1 - self.onset) as f64 * step_s } else { 0.0 }
    }

    /// The rest of a response at the end of the record, where that is neither little nor noise.
    ///
    /// The rest wraps around: the transform takes the record for one period of a periodic response.
    pub fn undecayed(&self, response: usize) -> Option<f64> {
        let noise = self.noise.as_ref().and_then(|noise| noise.get(response)).copied().unwrap_or(0.0);
        self.residual.get(response).copied().filter(|&rest| rest > DECAYED_RESIDUAL && rest > 3.0 * noise)
    }

    /// Samples of the record before the contact.
    pub(super) fn before(&self) -> usize {
        self.onset.saturating_sub(self.range.start + FOOT_SAMPLES)
    }

    /// The contact in samples of the record.
    pub(super) fn pulse_in_record(&self) -> Range<usize> {
        self.onset.saturating_sub(self.range.start)..(self.last + 1).saturating_sub(self.range.start)
    }
}

impl Impact {
    /// A recording without an impact.
    pub(super) fn none(recording: usize, len: usize, force: &[f64]) -> Self {
        let fault = match force.iter().any(|x| *x != force[0]) {
            true => Fault::Silent,
            false => Fault::Missing { channel: Channel::Force },
        };
        Self { faults: vec![fault], ..Self::at(recording, 0, 0, 0.0, 0..len) }
    }

    pub(super) fn at(recording: usize, onset: usize, last: usize, peak_n: f64, range: Range<usize>) -> Self {
        Self {
            recording,
            onset,
            last,
            range,
            peak_n,
            faults: Vec::new(),
            kept_anyway: false,
            residual: Vec::new(),
            noise: None,
        }
    }
}
