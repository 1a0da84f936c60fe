//! A channel whose calibration is not known, and what was found of it.

use crate::c64;
use crate::frequency::omega_rad_s;

/// What of a channel is to be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ChannelUnknowns {
    /// The factor by which its values have to be multiplied.
    pub scale: bool,
    /// By how much it is late.
    pub delay: bool,
}

impl ChannelUnknowns {
    /// Whether anything is.
    pub fn any(self) -> bool {
        self.scale || self.delay
    }

    /// How many real numbers are.
    pub fn count(self) -> usize {
        usize::from(self.scale) + usize::from(self.delay)
    }
}

/// A number that was found, and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibrated {
    /// Its value; of a scale negative where the channel's sense is reversed.
    pub value: f64,
    /// Its standard deviation; `None` where the noise is unknown.
    pub std: Option<f64>,
}

/// What was found of a channel: its receptance is s e^{iωτ} times what was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Calibration {
    /// s; `None` where it was known, or is not identifiable.
    pub scale: Option<Calibrated>,
    /// τ, s: by how much the channel is late; `None` as above.
    pub delay_s: Option<Calibrated>,
}

impl Calibration {
    /// What it is of what another calibration left.
    pub(super) fn after(self, first: &Channel) -> Self {
        let of_scale = |found: Calibrated| Calibrated {
            value: found.value * first.scale,
            std: found.std.map(|std| std * first.scale.abs()),
        };
        let of_delay = |found: Calibrated| Calibrated { value: found.value + first.delay_s, ..found };
        Self { scale: self.scale.map(of_scale), delay_s: self.delay_s.map(of_delay) }
    }

    /// s e^{iωτ}, with one and zero for a scale and a delay that are not unknown.
    pub fn factor(&self, frequency_hz: f64) -> c64 {
        Channel::of(self).factor(frequency_hz)
    }
}

/// A calibration as a search has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::identify) struct Channel {
    pub(in crate::identify) scale: f64,
    pub(in crate::identify) delay_s: f64,
}

impl Channel {
    pub(in crate::identify) const CALIBRATED: Self = Self { scale: 1.0, delay_s: 0.0 };

    /// One and zero for a scale and a delay that are not unknown.
    pub(in crate::identify) fn of(found: &Calibration) -> Self {
        let value = |found: Option<Calibrated>, none: f64| found.map_or(none, |found| found.value);
        Self { scale: value(found.scale, 1.0), delay_s: value(found.delay_s, 0.0) }
    }

    pub(in crate::identify) fn factor(&self, frequency_hz: f64) -> c64 {
        self.scale * c64::from_polar(1.0, omega_rad_s(frequency_hz) * self.delay_s)
    }

    /// Where u = γ e^{−iωt} x remains beyond this calibration.
    pub(in crate::identify) fn better(&self, gain: f64, late_s: f64) -> Self {
        Self { scale: self.scale / gain, delay_s: self.delay_s + late_s }
    }
}

/// An unknown number of a channel: its scale or its delay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::identify) struct ChannelNumber {
    pub(in crate::identify) channel: usize,
    pub(in crate::identify) is_delay: bool,
}

/// The numbers that are unknown, channel by channel.
pub(in crate::identify) fn numbers_of(unknown: &[ChannelUnknowns]) -> Vec<ChannelNumber> {
    let of = |(channel, unknown): (usize, &ChannelUnknowns)| {
        let all = [(unknown.scale, false), (unknown.delay, true)].into_iter();
        all.filter(|(wanted, _)| *wanted).map(move |(_, is_delay)| ChannelNumber { channel, is_delay })
    };
    unknown.iter().enumerate().flat_map(of).collect()
}
