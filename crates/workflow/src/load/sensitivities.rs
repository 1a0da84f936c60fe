//! What sensitivities take of a case beside its model: frequencies, noise, channels of unknown scale.

use super::band::{MeasuredNoise, band, respond_hz};
use super::dimension::{PartOf, powers_of};
use super::measurement::{Curve, Measurement};
use super::overrides::Overrides;
use crate::case::{Calibration, CaseFile};
use crate::error::{InputError, Place};
use frfit::model::DynamicStiffness;

/// The part of a case that sensitivities are about.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivitiesCase {
    /// Standard deviations √E|δx|² of the receptance, `[frequency][sensor]`, where the files of all measurements give them.
    pub std: Option<Vec<Vec<f64>>>,
    /// The matrices of the case, and what is attached: the terms of the model that each is.
    pub matrices: Vec<(String, Vec<usize>)>,
    /// The dimensions of the case, and the powers to which each multiplies terms.
    pub dimensions: Vec<(String, Vec<(usize, i32)>)>,
    /// Whether a sensor's scale is to be found.
    pub unknown_scale: Vec<bool>,
}

/// The frequencies: those of `[respond]`, or else those of the first measurement's file within the band that is to be identified; and what is known there.
pub(super) fn sensitivities(
    case: &CaseFile,
    overrides: &Overrides,
    (model, of): (&DynamicStiffness, &[PartOf]),
    measurements: &[Measurement],
) -> Result<(SensitivitiesCase, Vec<f64>), InputError> {
    let identified = case.identify.as_ref().and_then(|entry| entry.band_hz.as_ref());
    let (band_hz, place) = match (overrides.band_hz, identified) {
        (None, Some(located)) => (Some(located.value), located.place.clone()),
        (given, _) => (given, Place::option("--band")),
    };
    let curves: Vec<&Curve> = measurements.iter().filter_map(|m| m.curve.as_ref()).collect();
    let has_noise = |curve: &&Curve| {
        curve.frf.std.is_some() || (curve.frf.coherence.is_some() && curve.averages.is_some())
    };
    let known = case.respond.is_none() && curves.len() == measurements.len() && curves.iter().all(has_noise);
    let (mut frequency_hz, mut std) = match known {
        true => {
            let band = band(measurements, model.decay_per_s(), band_hz.unwrap_or([0.0, f64::MAX]), &place)?;
            let std = match band.noise {
                MeasuredNoise::Known(std) => Some(std),
                MeasuredNoise::Relative(_) | MeasuredNoise::Unknown => None,
            };
            (band.frequency_hz, std)
        }
        false => {
            let within = if case.respond.is_some() { overrides.band_hz } else { band_hz };
            (respond_hz(case, &Overrides { band_hz: within, ..overrides.clone() }, measurements)?, None)
        }
    };
    // At rest a structure that nothing holds has no answer, and no mass has a say.
    let moving: Vec<bool> = frequency_hz.iter().map(|&f| f > 0.0).collect();
    let mut keep = moving.iter();
    frequency_hz.retain(|_| *keep.next().unwrap_or(&true));
    if let Some(rows) = &mut std {
        let mut keep = moving.iter();
        rows.retain(|_| *keep.next().unwrap_or(&true));
    }
    if frequency_hz.is_empty() {
        let expected = "a table [respond] with a band above 0 Hz, or a measurement with a file of frequencies above 0 Hz";
        return Err(InputError::at(&Place::file(&case.file), expected, "none"));
    }
    let scale = |entry: &crate::case::MeasurementEntry| entry.scale.as_ref().map(|located| located.value);
    let unknown_scale =
        case.measurements.iter().map(|entry| scale(entry) == Some(Calibration::Unknown)).collect();
    let (matrices, dimensions) = (matrices(model, of), dimensions(case, of));
    Ok((SensitivitiesCase { std, matrices, dimensions, unknown_scale }, frequency_hz))
}

/// What is one matrix of the case is one parameter; what is attached comes after.
fn matrices(model: &DynamicStiffness, of: &[PartOf]) -> Vec<(String, Vec<usize>)> {
    let mut matrices: Vec<(String, Vec<usize>)> = Vec::new();
    for (index, term) in model.terms().iter().enumerate() {
        let name = of.get(index).map_or(&term.name, |part| &part.matrix);
        match matrices.last_mut().filter(|(last, _)| last == name) {
            Some((_, terms)) => terms.push(index),
            None => matrices.push((name.clone(), vec![index])),
        }
    }
    matrices
}

fn dimensions(case: &CaseFile, of: &[PartOf]) -> Vec<(String, Vec<(usize, i32)>)> {
    let dimensions = case.unknowns().filter(|one| one.nominal.is_some());
    dimensions.map(|one| (one.name.value.clone(), powers_of(&one.name.value, of, &one.powers))).collect()
}
