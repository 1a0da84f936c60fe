//! What can be wrong with an impact.

use super::Channel;
use std::fmt;

/// Why an impact is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// A channel without samples, or with the same value all the time.
    Missing {
        /// Which.
        channel: Channel,
    },
    /// The force never stands out of its own noise.
    Silent,
    /// The record would reach beyond its recording or into the next impact.
    Incomplete {
        /// Samples that are there.
        samples: usize,
        /// Samples that a record has.
        of: usize,
    },
    /// A few samples far above all others.
    Spike {
        /// Where.
        channel: Channel,
        /// How many.
        samples: usize,
        /// How high, in the channel's SI unit.
        height: f64,
    },
    /// The range of the converter was exceeded: a flat top between steep flanks.
    Clipped {
        /// Where.
        channel: Channel,
        /// How many samples stand at the limit.
        samples: usize,
        /// The limit, in the channel's SI unit.
        level: f64,
    },
    /// The hammer touched again within the record.
    DoubleImpact {
        /// How much later, in s.
        after_s: f64,
        /// The smaller of both contacts' largest forces over the larger.
        share: f64,
    },
    /// The mean moves within the record.
    Drift {
        /// Where.
        channel: Channel,
        /// By how much, of the channel's largest value.
        share: f64,
    },
}

impl Fault {
    /// One word: `missing`, `silent`, `incomplete`, `spike`, `clipped`, `double_impact`, `drift`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Missing { .. } => "missing",
            Self::Silent => "silent",
            Self::Incomplete { .. } => "incomplete",
            Self::Spike { .. } => "spike",
            Self::Clipped { .. } => "clipped",
            Self::DoubleImpact { .. } => "double_impact",
            Self::Drift { .. } => "drift",
        }
    }

    /// The channel at fault, where it is one.
    pub fn channel(&self) -> Option<Channel> {
        match *self {
            Self::Missing { channel }
            | Self::Spike { channel, .. }
            | Self::Clipped { channel, .. }
            | Self::Drift { channel, .. } => Some(channel),
            Self::Silent | Self::DoubleImpact { .. } => Some(Channel::Force),
            Self::Incomplete { .. } => None,
        }
    }

    /// The fault in words, with the name of its channel.
    pub fn describe(&self, channel: &str) -> String {
        match self {
            Self::Missing { .. } => format!("{channel} is missing or does not move"),
            Self::Silent => format!("{channel} shows no impact, only noise"),
            Self::Incomplete { samples, of } => format!("record incomplete, {samples} of {of} samples"),
            Self::Spike { samples, height, .. } => {
                format!("spike of {samples} samples in {channel}, up to {height:.4}")
            }
            Self::Clipped { samples, level, .. } => {
                format!("{channel} clipped, {samples} samples at {level:.4}")
            }
            Self::DoubleImpact { after_s, share } => {
                format!("double impact, {:.1} % again after {:.2} ms", 100.0 * share, 1e3 * after_s)
            }
            Self::Drift { share, .. } => {
                format!("{channel} drifts by {:.1} % of its largest value", 100.0 * share)
            }
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe(&self.channel().map_or(String::new(), |channel| channel.to_string())))
    }
}
