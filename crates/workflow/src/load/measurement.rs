//! A measurement: where it was taken, what it is, and its values.

use super::dofs::Dofs;
use super::files::{Files, NamedFile};
use super::frf::{Choice, Frf};
use crate::case::{Calibration, Located, MeasurementEntry, RandomWindow, Spot};
use crate::error::{InputError, Place};
use frfit::dof::DofName;
use frfit::model::Sensor;
use frfit::quantity::Quantity;
use frfit_formats::FormatError;
use std::path::PathBuf;

/// A sensor, for tables and figures.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorInfo {
    /// `34+Z` or `row 97`.
    pub label: String,
    /// What was measured, or what is asked for.
    pub quantity: Quantity,
    /// The file with the measurement as the case names it.
    pub file: Option<PathBuf>,
    /// Where the file says that it was measured, if the case says otherwise.
    pub elsewhere: Option<DofName>,
}

/// A measurement, read as far as it was needed.
#[derive(Debug)]
pub(super) struct Measurement {
    pub(super) sensor: Sensor,
    pub(super) info: SensorInfo,
    pub(super) curve: Option<Curve>,
    /// α of its window, 1/s, and who says so; `None` where nobody does: the case does not, and its file was not read.
    pub(super) decay: Option<Decay>,
}

/// How an FRF was windowed.
#[derive(Debug, Clone)]
pub(super) struct Decay {
    /// α, 1/s.
    pub(super) per_s: f64,
    /// Where it is said; where nothing is said that it is zero, the measurement.
    pub(super) place: Place,
}

/// Two numbers of 1/s that are the same but for the digits they are written with.
const SAME_DECAY: f64 = 1e-6;

/// The decay of all measurements' windows: there is one model, and one s = iω + α that it is evaluated at.
pub(super) fn common_decay(measurements: &[Measurement]) -> Result<f64, InputError> {
    let mut all = measurements.iter().filter_map(|measurement| measurement.decay.as_ref());
    let Some(first) = all.next() else { return Ok(0.0) };
    match all.find(|other| !same(first.per_s, other.per_s)) {
        None => Ok(first.per_s),
        Some(other) => {
            let expected = format!("the decay_per_s of all measurements, {} as of the first", first.per_s);
            Err(InputError::at(&other.place, expected, other.per_s.to_string()))
        }
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_DECAY * a.max(b)
}

/// What the case says, or else the file; neither may contradict the other.
fn decay(entry: &MeasurementEntry, curve: Option<&Curve>) -> Result<Option<Decay>, InputError> {
    let of_file = curve.map(|curve| curve.frf.decay_per_s);
    match (&entry.decay_per_s, of_file) {
        (Some(key), Some(Some(of_file))) if !same(key.value, of_file) => {
            let file = entry.file.as_ref().map_or("the file", |file| file.value.as_str());
            let expected = format!("{of_file}, as {file} says, or no such key");
            Err(InputError::at(&key.place, expected, key.value.to_string()))
        }
        // The file has all digits.
        (_, Some(Some(per_s))) => Ok(Some(Decay { per_s, place: entry.place.below("file") })),
        (Some(key), _) => Ok(Some(Decay { per_s: key.value, place: key.place.clone() })),
        (None, Some(None)) => Ok(Some(Decay { per_s: 0.0, place: entry.place.below("decay_per_s") })),
        (None, None) => Ok(None),
    }
}

/// Measured values and where they are from.
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) frf: Frf,
    /// What its values are to be multiplied by, as far as that is known.
    pub(super) scale: f64,
    /// By how much it is late as far as that is known, s.
    pub(super) delay_s: f64,
    /// Over how many records its coherence was averaged, where the case says.
    pub(super) averages: Option<usize>,
    /// The window of random excitation, where that is said.
    pub(super) window: Option<Located<RandomWindow>>,
    /// The length of the records under it, s, where that is said.
    pub(super) record_s: Option<f64>,
    pub(super) file: NamedFile,
}

/// Reads a measurement. With `values` its file is needed; without, it is opened only for what the case leaves open.
pub(super) fn measurement(
    entry: &MeasurementEntry,
    driven_at: Option<&Located<DofName>>,
    values: bool,
    dofs: &Dofs,
    files: &mut Files,
) -> Result<Measurement, InputError> {
    // First: a name that the model does not have is no FRF of the file either.
    let named = entry.spot.as_ref().map(|spot| dofs.find(spot)).transpose()?;
    let curve = match &entry.file {
        Some(name) if values || entry.spot.is_none() || entry.quantity.is_none() => {
            Some(curve(entry, name, driven_at, files)?)
        }
        None if values => return Err(InputError::at(&entry.place, "the key \"file\"", "none")),
        _ => None,
    };
    let (sensor, label) = match (named, &curve) {
        (Some(named), _) => named,
        (None, Some(Curve { frf: Frf { measured_at: Some(name), .. }, file, .. })) => {
            // The name is in the file; the key that leads there is the place to put it right.
            dofs.find(&Spot::Dof(Located { value: *name, place: file.named_by.clone() }))?
        }
        (None, _) => {
            let expected = "the key \"dof\" or \"row\", because no file says where it was measured";
            return Err(InputError::at(&entry.place, expected, "none"));
        }
    };
    let quantity = match (entry.quantity, &curve) {
        (Some(quantity), _) => quantity,
        (None, Some(Curve { frf: Frf { quantity: Some(quantity), .. }, .. })) => *quantity,
        (None, Some(_)) => {
            let expected =
                "the key \"quantity\" (receptance, mobility or accelerance), because the file does not say";
            return Err(InputError::at(&entry.place, expected, "none"));
        }
        // Nothing was measured here: the default of a computed response.
        (None, None) => Quantity::default(),
    };
    let file = entry.file.as_ref().map(|name| PathBuf::from(&name.value));
    let decay = decay(entry, curve.as_ref())?;
    let elsewhere = curve.as_ref().and_then(|curve| elsewhere(entry, &curve.frf));
    Ok(Measurement { sensor, info: SensorInfo { label, quantity, file, elsewhere }, curve, decay })
}

/// Where a file says that it was measured, if that is neither where the case says nor, with the ends exchanged, where it was driven.
fn elsewhere(entry: &MeasurementEntry, frf: &Frf) -> Option<DofName> {
    let Some(Spot::Dof(Located { value: asked, .. })) = &entry.spot else { return None };
    frf.measured_at.filter(|at| at != asked && frf.driven_at != Some(*asked))
}

fn curve(
    entry: &MeasurementEntry,
    name: &Located<String>,
    driven_at: Option<&Located<DofName>>,
    files: &mut Files,
) -> Result<Curve, InputError> {
    let file = files.read(name)?;
    let measured_at = match &entry.spot {
        Some(Spot::Dof(name)) => Some(name.value),
        _ => None,
    };
    let driven = driven_at.map(|name| name.value);
    let choice = Choice {
        record: entry.record.as_ref().map(|record| record.value),
        measured_at,
        driven_at: driven,
        columns: entry.columns.as_ref().map(|columns| columns.value.clone()),
    };
    let frf = file.frf(&choice).map_err(|error| file.refuse(error))?;
    // The same node and axis in the opposite sense: every value would have the wrong sign.
    if let (Some(load), Some(there)) = (driven, frf.driven_at)
        && there == (DofName { reversed: !load.reversed, ..load })
    {
        let expected = format!("an FRF driven at {load}, as [load] says");
        return Err(file.refuse(FormatError::whole(expected, there.to_string())));
    }
    let averages = entry.averages.as_ref().and_then(|averages| usize::try_from(averages.value).ok());
    let known = |entry: &Option<Located<Calibration>>, otherwise: f64| match entry
        .as_ref()
        .map(|entry| entry.value)
    {
        Some(Calibration::Known(number)) => number,
        Some(Calibration::Unknown) | None => otherwise,
    };
    let (scale, delay_s) = (known(&entry.scale, 1.0), known(&entry.delay_s, 0.0));
    let (window, record_s) = (entry.window.clone(), entry.record_s);
    Ok(Curve { frf, scale, delay_s, averages, window, record_s, file: file.closed() })
}

/// An element of the measurements' sequence.
pub(super) fn measurement_argument(m: usize) -> String {
    format!("measurements[{m}]")
}
