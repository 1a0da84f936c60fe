//! Resonances in what a fit leaves.

use super::rational_fit::{Fit, Fitted, Measured};
use crate::c64;
use crate::frequency::{laplace_per_s, omega_rad_s};
use crate::median::median;

/// Half-widths that are tried: from the spacing of the lines on, each larger than the one before by this factor, up to this part of the band. Wider
/// resonances are in the stabilisation diagram.
const HALF_WIDTH_STEP: f64 = 2.0;
const MAX_HALF_WIDTH: f64 = 0.005;

/// Frequencies that are tried, in half-widths.
const FREQUENCY_STEP: f64 = 0.5;

/// Lines that are compared with a trial pole: up to so many half-widths from it.
const REACH: f64 = 10.0;

/// A mode stands out: it explains more than the median of the neighbouring trials on either side, by this factor. Of noise the largest of ten thousand trials explains
/// some thirteen times the median, also where neighbouring lines have it in common.
const MIN_PROMINENCE: f64 = 30.0;
const NEIGHBOURS: usize = 200;

/// Nearer to a pole that is there, in half-widths of the wider of both, the residual belongs to that pole: its damping may depend on the amplitude.
const MIN_DISTANCE: f64 = 3.0;

/// Poles that are found at once at most: a search over all poles costs the cube of their number.
const MAX_POLES: usize = 10;

/// Poles where the residual has a resonance that explains more than the price of a pole, the largest first.
///
/// At each trial pole s the residue a_m of each sensor minimises Σ w²|rest − a_m/(iω − s)|² over the lines nearby.
///
/// # Limits
/// A second mode within three half-widths of one that is there is not found.
pub(super) fn resonances_left(measured: &Measured<'_>, fit: &Fit, fitted: &Fitted, price: f64) -> Vec<c64> {
    let lines = measured.frequency_hz;
    let band_hz = lines[lines.len() - 1] - lines[0];
    let mut found = Vec::new();
    let mut half_width_hz = band_hz / (lines.len() - 1).max(1) as f64;
    while half_width_hz > 0.0 && half_width_hz < MAX_HALF_WIDTH * band_hz {
        let step_hz = FREQUENCY_STEP * half_width_hz;
        let pole =
            |i: usize| c64::new(-omega_rad_s(half_width_hz), omega_rad_s(lines[0] + step_hz * i as f64));
        let poles: Vec<c64> = (1..(band_hz / step_hz) as usize).map(pole).collect();
        let gains: Vec<f64> = poles.iter().map(|&pole| gain(measured, fitted, pole)).collect();
        let stands_out = |at: usize| {
            let near = &gains[at.saturating_sub(NEIGHBOURS)..(at + NEIGHBOURS).min(gains.len())];
            gains[at] > price
                && median(near.to_vec()).is_some_and(|median| gains[at] > MIN_PROMINENCE * median)
        };
        found.extend((0..poles.len()).filter(|&at| stands_out(at)).map(|at| (gains[at], poles[at])));
        half_width_hz *= HALF_WIDTH_STEP;
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut poles: Vec<c64> = Vec::new();
    for (_, pole) in found {
        let is_apart =
            |other: &c64| (pole.im - other.im).abs() > MIN_DISTANCE * pole.re.abs().max(other.re.abs());
        if poles.len() < MAX_POLES && fit.poles.iter().chain(&poles).all(is_apart) {
            poles.push(pole);
        }
    }
    poles
}

/// By how much one more resonance lowers the misfit nearby.
fn gain(measured: &Measured<'_>, fitted: &Fitted, pole: c64) -> f64 {
    let lines = measured.frequency_hz;
    let reach = REACH * pole.re.abs();
    let from = lines.partition_point(|&f| omega_rad_s(f) < pole.im - reach);
    let to = lines.partition_point(|&f| omega_rad_s(f) <= pole.im + reach);
    let resonances: Vec<c64> =
        lines[from..to].iter().map(|&f| (laplace_per_s(f, measured.decay_per_s) - pole).inv()).collect();
    let of_sensor = |m: usize| {
        let (mut overlap, mut length) = (c64::default(), 0.0);
        for (k, resonance) in (from..to).zip(&resonances) {
            let weight = measured.weights[k][m].powi(2);
            overlap += weight * resonance.conj() * (measured.responses[k][m] - fitted.responses[m][k]);
            length += weight * resonance.norm_sqr();
        }
        if length > 0.0 { overlap.norm_sqr() / length } else { 0.0 }
    };
    (0..measured.sensors()).map(of_sensor).sum()
}
