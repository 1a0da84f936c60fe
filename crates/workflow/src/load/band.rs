//! The frequencies of a band, and what was measured there, as receptance.

use super::measurement::{Curve, Measurement};
use crate::error::{InputError, Place};
use frfit::c64;
use frfit_formats::FormatError;

/// How far two measurements' frequencies may differ and be the same: well above the rounding of 12 digits, well below
/// any resolution of an analyser.
const SAME_FREQUENCY: f64 = 1e-9;

/// Measured values over a band.
#[derive(Debug, Default)]
pub(super) struct Band {
    pub(super) frequency_hz: Vec<f64>,
    /// `[frequency][sensor]`, receptance.
    pub(super) measured: Vec<Vec<c64>>,
    /// `[sensor][frequency]`, of the receptance.
    pub(super) std: Vec<Option<Vec<f64>>>,
    /// `[sensor][frequency]`.
    pub(super) coherence: Vec<Option<Vec<f64>>>,
}

/// The frequencies of a curve inside a band, both ends included.
pub(super) fn frequencies(curve: &Curve, band_hz: [f64; 2], place: &Place) -> Result<Vec<f64>, InputError> {
    let all = &curve.frf.frequency_hz;
    let [low, high] = band_hz;
    let inside: Vec<f64> = all.iter().copied().filter(|f| (low..=high).contains(f)).collect();
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

/// All measurements at the frequencies that the first has in the band.
pub(super) fn band(
    measurements: &[Measurement],
    band_hz: [f64; 2],
    place: &Place,
) -> Result<Band, InputError> {
    let Some(first) = measurements.first().and_then(|first| first.curve.as_ref()) else {
        return Ok(Band::default());
    };
    let frequency_hz = frequencies(first, band_hz, place)?;
    let mut band = Band { measured: vec![Vec::new(); frequency_hz.len()], ..Band::default() };
    for measurement in measurements {
        let Some(curve) = &measurement.curve else { continue };
        let frf = &curve.frf;
        let rows = frequency_hz.iter().map(|&f| row_of(curve, f, first)).collect::<Result<Vec<_>, _>>()?;
        let picked = |column: &Vec<f64>| rows.iter().map(|&row| column[row]).collect::<Vec<_>>();
        let quantity = measurement.info.quantity;
        for ((&row, &f), values) in rows.iter().zip(&frequency_hz).zip(&mut band.measured) {
            let receptance = quantity.to_receptance(f, frf.response[row]);
            if !receptance.is_finite() {
                let expected = format!("a band in which {quantity} can be converted to receptance");
                return Err(InputError::at(place, expected, format!("{f} Hz in it")));
            }
            values.push(receptance);
        }
        let std = frf.std.as_ref().map(picked).map(|std| {
            let per_receptance = frequency_hz.iter().map(|&f| quantity.over_receptance(f).norm());
            std.into_iter().zip(per_receptance).map(|(std, factor)| std / factor).collect()
        });
        band.std.push(std);
        band.coherence.push(frf.coherence.as_ref().map(picked));
    }
    Ok(Band { frequency_hz, ..band })
}

/// Where a curve has a frequency.
fn row_of(curve: &Curve, frequency_hz: f64, first: &Curve) -> Result<usize, InputError> {
    let all = &curve.frf.frequency_hz;
    let above = all.partition_point(|&f| f < frequency_hz);
    let nearest = (above.saturating_sub(1)..all.len().min(above + 1))
        .min_by(|&a, &b| (all[a] - frequency_hz).abs().total_cmp(&(all[b] - frequency_hz).abs()));
    match nearest {
        Some(row) if (all[row] - frequency_hz).abs() <= SAME_FREQUENCY * frequency_hz => Ok(row),
        _ => {
            let expected =
                format!("{frequency_hz} Hz among its frequencies, as in {}", first.file.path.display());
            let found = nearest.map_or("none".into(), |row| format!("{} Hz as the nearest", all[row]));
            Err(curve.file.refuse(FormatError::whole(expected, found)))
        }
    }
}
