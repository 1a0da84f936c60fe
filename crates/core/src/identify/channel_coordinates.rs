//! Channels of unknown scale or delay, as coordinates of the search: sensor m shows z_m = x_m e^{−iωτ_m}/s_m.
//!
//! Residuals are z_m − u_m over the standard deviations of u_m as it was measured, so that no scale gains by being small.

use super::channel::{Calibrated, Calibration, Channel, ChannelNumber, ChannelUnknowns, numbers_of};
use crate::c64;
use std::ops::Range;

/// The scales and delays that are unknown, as coordinates after those of the unknowns: s = ±e^θ and τ = θ/ω at the top of the band.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::identify) struct ChannelCoordinates {
    free: Vec<ChannelNumber>,
    /// The first coordinate.
    first: usize,
    /// ±1 of each channel.
    senses: Vec<f64>,
    top_rad_s: f64,
}

impl ChannelCoordinates {
    /// Coordinates of some channels from the `first` on.
    pub(in crate::identify) fn new(channels: &[ChannelUnknowns], first: usize, omegas: &[f64]) -> Self {
        let top_rad_s = omegas.last().copied().filter(|&omega| omega > 0.0).unwrap_or(1.0);
        Self { free: numbers_of(channels), first, senses: vec![1.0; channels.len()], top_rad_s }
    }

    /// How many there are.
    pub(in crate::identify) fn count(&self) -> usize {
        self.free.len()
    }

    /// The same after another number of coordinates.
    pub(in crate::identify) fn after(self, first: usize) -> Self {
        Self { first, ..self }
    }

    /// The numbers that are unknown.
    pub(in crate::identify) fn numbers(&self) -> &[ChannelNumber] {
        &self.free
    }

    /// The channels whose scale is unknown.
    pub(in crate::identify) fn of_unknown_scale(&self) -> Vec<usize> {
        self.free.iter().filter(|number| !number.is_delay).map(|number| number.channel).collect()
    }

    /// Where they stand in θ.
    pub(in crate::identify) fn range(&self) -> Range<usize> {
        self.first..self.first + self.free.len()
    }

    /// Each coordinate and the number that it stands for.
    fn each(&self) -> impl Iterator<Item = (usize, &ChannelNumber)> {
        (self.first..).zip(&self.free)
    }

    /// The channels at θ.
    pub(in crate::identify) fn at(&self, theta: &[f64]) -> Vec<Channel> {
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
    pub(in crate::identify) fn top_rad_s(&self) -> f64 {
        self.top_rad_s
    }

    /// Lets θ begin at some channels.
    pub(in crate::identify) fn begin_at(&mut self, channels: &[Channel], theta: &mut [f64]) {
        self.senses = channels.iter().map(|channel| channel.scale.signum()).collect();
        for (c, number) in self.each() {
            let channel = channels[number.channel];
            theta[c] = match number.is_delay {
                true => channel.delay_s * self.top_rad_s,
                false => channel.scale.abs().ln(),
            };
        }
    }

    /// Slopes of what sensor m shows by the coordinates, where that is z: −z for ln s, −iω/ω_top z for a delay.
    pub(in crate::identify) fn slopes(
        &self,
        z: c64,
        m: usize,
        omega_rad_s: f64,
    ) -> impl Iterator<Item = c64> {
        self.free.iter().map(move |number| match (number.channel == m, number.is_delay) {
            (false, _) => c64::default(),
            (true, false) => -z,
            (true, true) => c64::new(0.0, -omega_rad_s / self.top_rad_s) * z,
        })
    }

    /// Slopes of the residuals by the coordinates where the channels show z, column after column.
    pub(in crate::identify) fn columns(&self, z: &[c64], omega_rad_s: f64, sigma: &[f64]) -> Vec<f64> {
        let rows: Vec<Vec<c64>> =
            (0..z.len()).map(|m| self.slopes(z[m] / sigma[m], m, omega_rad_s).collect()).collect();
        let column = |number: usize| rows.iter().flat_map(move |row| [row[number].re, row[number].im]);
        (0..self.free.len()).flat_map(column).collect()
    }

    /// What was found of each channel, with the standard deviation of each coordinate.
    pub(in crate::identify) fn found(
        &self,
        theta: &[f64],
        std: impl Fn(usize) -> Option<f64>,
    ) -> Vec<Calibration> {
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

    /// What each sensor shows of a response: e^{−iωτ_m}/s_m; nothing where all are calibrated.
    pub(in crate::identify) fn shares(&self, theta: &[f64], frequency_hz: f64) -> Vec<c64> {
        self.at(theta).iter().map(|channel| channel.factor(frequency_hz).inv()).collect()
    }

    /// What the channels show of a response and its slopes.
    pub(in crate::identify) fn shown(
        &self,
        theta: &[f64],
        frequency_hz: f64,
        (mut x, mut slopes): (Vec<c64>, Vec<Vec<c64>>),
    ) -> (Vec<c64>, Vec<Vec<c64>>) {
        for (m, share) in self.shares(theta, frequency_hz).into_iter().enumerate() {
            x[m] *= share;
            slopes.iter_mut().for_each(|slope| slope[m] *= share);
        }
        (x, slopes)
    }

    /// Values of the channels as receptances.
    pub(in crate::identify) fn calibrated(
        &self,
        theta: &[f64],
        frequency_hz: f64,
        values: &[c64],
    ) -> Vec<c64> {
        let channels = self.at(theta);
        let factor = |m: usize| channels.get(m).map_or(c64::ONE, |channel| channel.factor(frequency_hz));
        values.iter().enumerate().map(|(m, value)| factor(m) * value).collect()
    }

    /// σ of these receptances.
    pub(in crate::identify) fn calibrated_sigma(&self, theta: &[f64], sigma: &[f64]) -> Vec<f64> {
        let channels = self.at(theta);
        let scale = |m: usize| channels.get(m).map_or(1.0, |channel| channel.scale.abs());
        sigma.iter().enumerate().map(|(m, sigma)| scale(m) * sigma).collect()
    }
}
