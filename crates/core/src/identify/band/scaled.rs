//! A band as it is with other calibrations and with what is beside its noise.

use crate::c64;
use crate::frfs::{CommonNoise, Noise};
use crate::identify::channel::Channel;
use crate::identify::measured::Band;
use crate::identify::noise::{beside, levels};

/// What was measured with each channel's calibration, and its standard deviations with it and with what is beside the noise.
pub(super) struct Scaled {
    measured: Vec<Vec<c64>>,
    std: Vec<Vec<f64>>,
}

impl Scaled {
    /// All channels are calibrated where none is given.
    pub(super) fn new(band: &Band<'_>, channels: &[Channel]) -> Self {
        let channel = |m: usize| channels.get(m).copied().unwrap_or(Channel::CALIBRATED);
        let row = |(u, &f): (&Vec<c64>, &f64)| {
            u.iter().enumerate().map(|(m, u)| channel(m).factor(f) * u).collect()
        };
        let measured = band.measured.iter().zip(band.frequency_hz).map(row);
        let scaled = |rows: &[Vec<f64>]| {
            let row = |row: &Vec<f64>| {
                row.iter().enumerate().map(|(m, std)| std * channel(m).scale.abs()).collect()
            };
            rows.iter().map(row).collect()
        };
        let std = match band.noise {
            Noise::Unknown | Noise::Floor(_) => Vec::new(),
            Noise::Relative(std) | Noise::Known(std) => scaled(std),
            Noise::Common(common) => scaled(common.std),
        };
        Self { measured: measured.collect(), std }
    }

    /// The same with what the response has beside a given noise: this part of its level, for real and imaginary part each.
    pub(super) fn with_rest(self, rest: f64, frequency_hz: &[f64]) -> Self {
        if rest == 0.0 {
            return self;
        }
        let levels = levels(&self.measured, frequency_hz);
        Self { std: beside(&self.std, 2f64.sqrt() * rest, &levels), ..self }
    }

    pub(super) fn band<'s>(&'s self, band: &Band<'s>) -> Band<'s> {
        let noise = match band.noise {
            unknown @ (Noise::Unknown | Noise::Floor(_)) => unknown,
            Noise::Relative(_) => Noise::Relative(&self.std),
            Noise::Known(_) => Noise::Known(&self.std),
            Noise::Common(common) => Noise::Common(CommonNoise { std: &self.std, ..common }),
        };
        Band { measured: &self.measured, noise, ..*band }
    }
}
