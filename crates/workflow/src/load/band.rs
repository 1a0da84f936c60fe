//! The frequencies of a band, and what was measured there, as receptance.

use super::corrections::{Corrections, corrected};
use super::measurement::{Curve, Measurement};
use super::overrides::Overrides;
use crate::case::{CaseFile, RespondEntry, checked_band};
use crate::error::{InputError, Place};
use frfit::c64;
use frfit::frequency::{linear_hz, omega_rad_s};
use frfit::signal::{relative_variance, variances};
use frfit_formats::FormatError;

/// How far two measurements' frequencies may differ and be the same: well above the rounding of 12 digits, well below
/// any resolution of an analyser.
const SAME_FREQUENCY: f64 = 1e-9;

/// Frequencies of a band that was not measured: a training looks at some of them, and at both ends.
const UNMEASURED_FREQUENCIES: usize = 200;

/// Standard deviations √E|δx|² of the measured receptances, `[frequency][sensor]`, as far as files and case give them.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasuredNoise {
    /// Not for all sensors.
    Unknown,
    /// From the coherence of all of them as of a single average: the number of averages is not known of all.
    Relative(Vec<Vec<f64>>),
    /// Of all of them: given, or from the coherence and the number of averages.
    Known(Vec<Vec<f64>>),
}

/// Measured values over a band.
#[derive(Debug)]
pub(super) struct Band {
    pub(super) frequency_hz: Vec<f64>,
    /// How many lines of the first measurement in the band another one has not.
    pub(super) not_common: usize,
    /// `[frequency][sensor]`, receptance.
    pub(super) measured: Vec<Vec<c64>>,
    pub(super) noise: MeasuredNoise,
    /// What was found in the measured values.
    pub(super) corrections: Corrections,
}

/// The frequencies of a curve inside a band, both ends included.
pub(super) fn frequencies(curve: &Curve, band_hz: [f64; 2], place: &Place) -> Result<Vec<f64>, InputError> {
    let all = &curve.frf.frequency_hz;
    let [low, high] = band_hz;
    // 1000 Hz as 20 + 999 · 0.980980980981 is rounded, and in the band to 1000 Hz.
    let wide = low * (1.0 - SAME_FREQUENCY)..=high * (1.0 + SAME_FREQUENCY);
    let inside: Vec<f64> = all.iter().copied().filter(|f| wide.contains(f)).collect();
    if inside.is_empty() {
        let range = match all.as_slice() {
            [first, .., last] => format!("{first} to {last} Hz in {} steps", all.len() - 1),
            [only] => format!("{only} Hz only"),
            [] => "none".into(),
        };
        let expected = format!("a band with frequencies of {} ({range})", curve.file.path.display());
        return Err(InputError::at(place, expected, format!("[{low}, {high}]")));
    }
    Ok(inside)
}

/// The frequencies of a response.
pub(super) fn respond_hz(
    case: &CaseFile,
    overrides: &Overrides,
    measurements: &[Measurement],
) -> Result<Vec<f64>, InputError> {
    let option = Place::option("--band");
    if let Some(band_hz) = overrides.band_hz {
        checked_band(band_hz, &option)?;
    }
    if let Some(respond) = &case.respond {
        let [low, high] = overrides.band_hz.unwrap_or(respond.band_hz.value);
        return Ok(linear_hz(low, high, respond.points));
    }
    match measurements.first().and_then(|first| first.curve.as_ref()) {
        Some(curve) => frequencies(curve, overrides.band_hz.unwrap_or([0.0, f64::MAX]), &option),
        None => Ok(Vec::new()),
    }
}

/// A band without a measurement, for what needs its frequencies alone: those of a response in it, or equally spaced ones. All receptances are one.
pub(super) fn unmeasured(respond: Option<&RespondEntry>, [low, high]: [f64; 2], sensors: usize) -> Band {
    let asked = respond.map(|respond| {
        let [first, last] = respond.band_hz.value;
        linear_hz(first, last, respond.points)
    });
    let mut frequency_hz: Vec<f64> =
        asked.unwrap_or_default().into_iter().filter(|f| (low..=high).contains(f)).collect();
    if frequency_hz.is_empty() {
        frequency_hz = linear_hz(low, high, UNMEASURED_FREQUENCIES);
    }
    let measured = vec![vec![c64::new(1.0, 0.0); sensors]; frequency_hz.len()];
    Band {
        frequency_hz,
        not_common: 0,
        measured,
        noise: MeasuredNoise::Unknown,
        corrections: Corrections::default(),
    }
}

/// All measurements at the frequencies of the band that all of them have; `decay_per_s` is that of their window.
///
/// # Errors
/// No frequency of the first in the band; none that all have; one at which the quantity cannot be converted.
pub(super) fn band(
    measurements: &[Measurement],
    decay_per_s: f64,
    band_hz: [f64; 2],
    place: &Place,
) -> Result<Band, InputError> {
    let Some(first) = measurements.first().and_then(|first| first.curve.as_ref()) else {
        let (frequency_hz, measured, noise) = (Vec::new(), Vec::new(), MeasuredNoise::Unknown);
        return Ok(Band {
            frequency_hz,
            not_common: 0,
            measured,
            noise,
            corrections: Corrections::default(),
        });
    };
    let of_first = frequencies(first, band_hz, place)?;
    let curves = || measurements.iter().filter_map(|measurement| measurement.curve.as_ref());
    // The rows of a frequency in all curves, where all have it.
    let rows_of =
        |&f: &f64| Some((f, curves().map(|curve| row_of(curve, f).ok()).collect::<Option<Vec<_>>>()?));
    let (frequency_hz, rows): (Vec<f64>, Vec<Vec<usize>>) = of_first.iter().filter_map(rows_of).unzip();
    if frequency_hz.is_empty() {
        return Err(none_common(curves(), first, &of_first));
    }
    let not_common = of_first.len() - frequency_hz.len();
    let corrected = corrected(&curves().collect::<Vec<_>>(), decay_per_s, band_hz)?;
    let mut measured: Vec<Vec<c64>> = vec![Vec::new(); frequency_hz.len()];
    // `[sensor][frequency]`, of the receptance.
    let (mut known, mut relative) = (Vec::new(), Vec::new());
    for measurement in measurements {
        let Some(curve) = &measurement.curve else { continue };
        let frf = &curve.frf;
        let sensor = known.len();
        let rows = || rows.iter().map(|rows| rows[sensor]);
        let quantity = measurement.info.quantity;
        for ((row, &f), values) in rows().zip(&frequency_hz).zip(&mut measured) {
            // A late channel has the phase e^{-iωτ}; what a window makes of its delay, e^{-ατ}, is part of the scale.
            let channel = c64::from_polar(curve.scale.abs(), omega_rad_s(f) * curve.delay_s);
            let response =
                curve.scale.signum() * channel * (frf.response[row] - corrected.removed(f, sensor).0);
            let receptance = response / quantity.over_receptance_windowed(f, decay_per_s);
            if !receptance.is_finite() {
                let expected = format!("a band in which {quantity} can be converted to receptance");
                return Err(InputError::at(place, expected, format!("{f} Hz in it")));
            }
            values.push(receptance);
        }
        let receptance_std = |std: &Vec<f64>| -> Vec<f64> {
            let over_receptance = |f: f64| quantity.over_receptance_windowed(f, decay_per_s).norm();
            let rows = rows().zip(&frequency_hz);
            let of_line = |(row, &f): (usize, &f64)| {
                std[row].hypot(corrected.removed(f, sensor).1) * curve.scale.abs() / over_receptance(f)
            };
            rows.map(of_line).collect()
        };
        let relative_std = |coherence: &Vec<f64>| {
            let each = frf.response.iter().zip(coherence);
            each.map(|(&h, &gamma)| std_of(relative_variance(h, within(gamma)))).collect::<Vec<f64>>()
        };
        relative.push(frf.coherence.as_ref().map(relative_std).as_ref().map(receptance_std));
        known.push(raw_std(curve).as_ref().map(receptance_std));
    }
    let by_frequency = |columns: Vec<Option<Vec<f64>>>| -> Option<Vec<Vec<f64>>> {
        let columns: Vec<Vec<f64>> = columns.into_iter().collect::<Option<_>>()?;
        Some((0..frequency_hz.len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect())
    };
    let noise = match (by_frequency(known), by_frequency(relative)) {
        (Some(std), _) => MeasuredNoise::Known(std),
        (None, Some(std)) => MeasuredNoise::Relative(std),
        (None, None) => MeasuredNoise::Unknown,
    };
    Ok(Band { frequency_hz, not_common, measured, noise, corrections: corrected.corrections })
}

/// √E|δH|² of the complex values of a curve: given, or by its coherence and averages.
pub(super) fn raw_std(curve: &Curve) -> Option<Vec<f64>> {
    curve.frf.std.clone().or_else(|| by_averages(curve))
}

/// √E|δH|² of the complex values of a curve from their coherence and the number of averages, B-6 for both parts together.
fn by_averages(curve: &Curve) -> Option<Vec<f64>> {
    let coherence: Vec<f64> = curve.frf.coherence.as_ref()?.iter().copied().map(within).collect();
    let variances = variances(&curve.frf.response, &coherence, curve.averages?);
    Some(variances.into_iter().map(std_of).collect())
}

/// No coherence is exactly one, nor does zero say more than that nothing was measured.
fn within(coherence: f64) -> f64 {
    coherence.clamp(1e-9, 1.0 - 1e-9)
}

fn std_of(variance: f64) -> f64 {
    (2.0 * variance).sqrt()
}

/// The measurements have no frequency in common: the first that lacks one, and the nearest that it has.
fn none_common<'c>(curves: impl Iterator<Item = &'c Curve>, first: &Curve, of_first: &[f64]) -> InputError {
    let mut lacking = curves.flat_map(|curve| of_first.iter().map(move |&f| (curve, f, row_of(curve, f))));
    let (curve, f, nearest) = lacking
        .find_map(|(curve, f, row)| Some((curve, f, row.err()?)))
        .expect("a frequency that is not common is lacking somewhere");
    let expected =
        format!("frequencies that all measurements have, such as {f} Hz of {}", first.file.path.display());
    let found = nearest.map_or("none".into(), |nearest| format!("{nearest} Hz as the nearest"));
    curve.file.refuse(FormatError::whole(expected, found))
}

/// Where a curve has a frequency, or the nearest that it has.
pub(super) fn row_of(curve: &Curve, frequency_hz: f64) -> Result<usize, Option<f64>> {
    let all = &curve.frf.frequency_hz;
    let above = all.partition_point(|&f| f < frequency_hz);
    let nearest = (above.saturating_sub(1)..all.len().min(above + 1))
        .min_by(|&a, &b| (all[a] - frequency_hz).abs().total_cmp(&(all[b] - frequency_hz).abs()));
    match nearest {
        Some(row) if (all[row] - frequency_hz).abs() <= SAME_FREQUENCY * frequency_hz => Ok(row),
        _ => Err(nearest.map(|row| all[row])),
    }
}
