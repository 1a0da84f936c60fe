//! Channels of unknown scale or delay, as coordinates of the search: sensor m shows z_m = x_m e^{−iωτ_m}/s_m.
//!
//! Residuals are z_m − u_m over the deviations of u_m as it was measured, so that no scale gains by being small.

use super::outcome::{BandCoordinate, NumberOf};
use super::reduced_band::Responded;
use crate::c64;
use crate::identify::band::{Calibrated, Calibration, Channel, ChannelNumber, ChannelUnknowns, numbers_of};

/// The scales and delays that are unknown, as coordinates after those of the unknowns: s = ±e^θ and τ = θ/ω at the top of the band.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ChannelCoordinates {
    free: Vec<ChannelNumber>,
    /// The first coordinate.
    first: usize,
    /// ±1 of each channel.
    senses: Vec<f64>,
    top_rad_s: f64,
}

impl ChannelCoordinates {
    /// Coordinates of some channels from the `first` on.
    pub(super) fn new(channels: &[ChannelUnknowns], first: usize, omegas: &[f64]) -> Self {
        let top_rad_s = omegas.last().copied().filter(|&omega| omega > 0.0).unwrap_or(1.0);
        Self { free: numbers_of(channels), first, senses: vec![1.0; channels.len()], top_rad_s }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.free.len()
    }

    /// What the numbers are called.
    pub(super) fn names(&self) -> impl Iterator<Item = BandCoordinate> {
        let name = |number: &ChannelNumber| if number.is_delay { "delay_s" } else { "scale" };
        self.free.iter().map(move |number| BandCoordinate {
            of: NumberOf::Channel(number.channel),
            number: name(number).to_owned(),
        })
    }

    /// Each coordinate and the number that it stands for.
    fn each(&self) -> impl Iterator<Item = (usize, &ChannelNumber)> {
        (self.first..).zip(&self.free)
    }

    /// The channels at θ.
    pub(super) fn at(&self, theta: &[f64]) -> Vec<Channel> {
        let known = |&sense: &f64| Channel { scale: sense, delay_s: 0.0 };
        let mut channels: Vec<Channel> = self.senses.iter().map(known).collect();
        for (c, number) in self.each() {
            let channel = &mut channels[number.channel];
            match number.is_delay {
                true => channel.delay_s = theta[c] / self.top_rad_s,
                false => channel.scale *= theta[c].exp(),
            }
        }
        channels
    }

    /// ω at the top of the band.
    pub(super) fn top_rad_s(&self) -> f64 {
        self.top_rad_s
    }

    /// Lets θ begin at some channels.
    pub(super) fn begin_at(&mut self, channels: &[Channel], theta: &mut [f64]) {
        self.senses = channels.iter().map(|channel| channel.scale.signum()).collect();
        for (c, number) in self.each() {
            let channel = channels[number.channel];
            theta[c] = match number.is_delay {
                true => channel.delay_s * self.top_rad_s,
                false => channel.scale.abs().ln(),
            };
        }
    }

    /// Slopes of the residuals by the coordinates where the channels show z: −z for ln s, −iω/ω_top z for a delay.
    pub(super) fn columns(&self, z: &[c64], omega_rad_s: f64, sigma: &[f64]) -> Vec<f64> {
        let mut columns = Vec::with_capacity(2 * z.len() * self.free.len());
        for number in &self.free {
            let m = number.channel;
            let by = if number.is_delay { c64::new(0.0, omega_rad_s / self.top_rad_s) } else { c64::ONE };
            let slope = -by * z[m] / sigma[m];
            let of = |k: usize| if k == m { slope } else { c64::default() };
            columns.extend((0..z.len()).map(of).flat_map(|v| [v.re, v.im]));
        }
        columns
    }

    /// What was found of each channel, with the standard deviation of each coordinate.
    pub(super) fn found(&self, theta: &[f64], std: impl Fn(usize) -> Option<f64>) -> Vec<Calibration> {
        let channels = self.at(theta);
        let mut found = vec![Calibration::default(); channels.len()];
        for (c, number) in self.each() {
            let channel = channels[number.channel];
            let own = &mut found[number.channel];
            match number.is_delay {
                true => {
                    let std = std(c).map(|std| std / self.top_rad_s);
                    own.delay_s = Some(Calibrated { value: channel.delay_s, std });
                }
                false => {
                    let std = std(c).map(|std| std * channel.scale.abs());
                    own.scale = Some(Calibrated { value: channel.scale, std });
                }
            }
        }
        found
    }

    /// What the channels show of a response and its slopes.
    pub(super) fn shown(
        &self,
        theta: &[f64],
        frequency_hz: f64,
        (mut x, mut slopes): Responded,
    ) -> Responded {
        for (m, channel) in self.at(theta).iter().enumerate() {
            let factor = channel.factor(frequency_hz);
            x[m] /= factor;
            slopes.iter_mut().for_each(|slope| slope[m] /= factor);
        }
        (x, slopes)
    }

    /// Values of the channels as receptances.
    pub(super) fn calibrated(&self, theta: &[f64], frequency_hz: f64, values: &[c64]) -> Vec<c64> {
        let channels = self.at(theta);
        let factor = |m: usize| channels.get(m).map_or(c64::ONE, |channel| channel.factor(frequency_hz));
        values.iter().enumerate().map(|(m, value)| factor(m) * value).collect()
    }

    /// σ of these receptances.
    pub(super) fn calibrated_sigma(&self, theta: &[f64], sigma: &[f64]) -> Vec<f64> {
        let channels = self.at(theta);
        let scale = |m: usize| channels.get(m).map_or(1.0, |channel| channel.scale.abs());
        sigma.iter().enumerate().map(|(m, sigma)| scale(m) * sigma).collect()
    }
}
