//! From a case file to everything that a computation needs: all files read, everything checked, nothing computed.

mod arrays;
mod attached;
mod band;
mod coarser;
mod dimension;
mod dofs;
mod factor;
mod files;
mod force;
mod frf;
mod identify;
mod labels;
mod lines;
mod matrix;
mod measurement;
mod model;
mod options;
mod sensitivities;
mod uff;
mod unknowns;

pub use arrays::{ArraysError, MeasuredFrf, Wanted, WantedUnknown, case_of_arrays, response_of_arrays};
pub use band::MeasuredNoise;
pub use files::InputFile;
pub(crate) use frf::decay_line;
pub use frf::{Choice, Frf, read_frf};
pub use identify::{Check, IdentifyCase};
pub(crate) use labels::{Member, load_one, matrices_of, one_order};
pub(crate) use matrix::{asymmetry, complex};
pub use matrix::{check_symmetric, symmetric_matrix};
pub use measurement::SensorInfo;
pub use sensitivities::SensitivitiesCase;
pub(crate) use uff::STD_LABEL;

use crate::case::{self, CaseFile, LoadEntry, Spot, checked_band};
use crate::error::{InputError, Place};
use crate::reads::Reads;
use crate::terminal::one_line;
use crate::units::UnitSystem;
use dimension::PartOf;
use dofs::Dofs;
use files::Files;
use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::CoarserMesh;
use frfit::model::{DynamicStiffness, Experiment, Term};
use frfit_formats::{CoordinateMatrix, read_matrices, take_matrix};
use measurement::{Measurement, common_decay, measurement};
use model::Terms;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// A case read from its file, everything checked, nothing computed.
#[derive(Debug)]
pub struct Case {
    /// Its title, or the name of its file, in one line.
    pub title: String,
    /// Units of the model as the case has it.
    pub units: UnitSystem,
    /// D(ω), which acts on metres ([`crate::units`]), at the complex frequency that the measurements' window makes of ω; shared, because a program may ask one model more than once.
    pub model: Arc<DynamicStiffness>,
    /// Load and sensors.
    pub experiment: Experiment,
    /// The same structure on a coarser mesh, where the case names one and the purpose is to identify.
    pub coarser_mesh: Option<CoarserMesh>,
    /// The sensors' labels, quantities and files, in the order of the measurements.
    pub sensors: Vec<SensorInfo>,
    /// The names of rows (from 0), as `34+Z`; empty without `[dofs]` where the matrices' files name none either.
    pub row_names: BTreeMap<usize, String>,
    /// Every file that was read, the case file first.
    pub inputs: Vec<InputFile>,
    /// Where they are, so that nothing is written over them.
    pub reads: Reads,
    /// What to identify; `None` where the purpose is another.
    pub identify: Option<IdentifyCase>,
    /// What sensitivities need; `None` where the purpose is another.
    pub sensitivities: Option<SensitivitiesCase>,
    /// The frequencies of a response or of sensitivities: those of `[respond]`, or else those that were measured.
    pub respond_hz: Vec<f64>,
}

impl Case {
    /// `34+Z` where `[dofs]` or a matrix' file names the row (from 0), `row 97` (from 1) elsewhere.
    pub fn row_name(&self, row: usize) -> String {
        self.row_names.get(&row).cloned().unwrap_or_else(|| format!("row {}", row + 1))
    }

    /// What a sensor's receptance is multiplied by to be in the quantity that it measures, under the measurements' window.
    pub(crate) fn over_receptance(&self, sensor: &SensorInfo, frequency_hz: f64) -> c64 {
        sensor.quantity.over_receptance_windowed(frequency_hz, self.model.decay_per_s())
    }
}

/// What the command line says in place of the case file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overrides {
    /// In place of `identify.method`.
    pub method: Option<String>,
    /// In place of `identify.order`.
    pub order: Option<usize>,
    /// In place of `identify.band_hz` or `respond.band_hz`.
    pub band_hz: Option<[f64; 2]>,
    /// In place of `identify.selection`.
    pub selection: Option<String>,
    /// In place of `identify.reduction`.
    pub reduction: Option<String>,
}

/// What a case is loaded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// `[identify]` and the files of all measurements are needed.
    Identify,
    /// Neither is: a measurement's file is opened only for what the case leaves open (where it was measured, what was
    /// measured, and without `[respond]` the frequencies of the first).
    Respond,
    /// Neither is: as for a response, but without `[respond]` all files that there are, for what they say about noise, within `identify.band_hz`.
    Sensitivities,
}

/// Reads a case and every file it names.
///
/// # Errors
/// The first thing that the user has to put right.
pub fn load(case_file: &Path, overrides: &Overrides, purpose: Purpose) -> Result<Case, InputError> {
    let (mut files, bytes) = Files::of_case(case_file)?;
    let case = case::parse(case_file, &bytes)?;
    let keeps_dimensions = purpose == Purpose::Identify && case.unknowns().any(|one| one.nominal.is_some());
    let structure = structure(&case, keeps_dimensions, &mut files)?;
    let coarser_mesh = match &case.coarser_mesh {
        Some(entry) if purpose == Purpose::Identify => {
            Some(coarser::coarser_mesh(entry, (&structure, keeps_dimensions), &mut files)?)
        }
        _ => None,
    };
    let Structure { terms, of, dofs } = structure;
    let model = model::model(&case, terms)?;
    let load = force::load(&case.load, model.dim(), &dofs, &mut files)?;
    let measurements = measurements(&case, purpose, &dofs, &mut files)?;
    let model = model.with_decay_per_s(common_decay(&measurements)?);
    let mut sensitivities = None;
    let (identify, respond_hz) = match purpose {
        Purpose::Identify => {
            let identify = identify::identify(&case, overrides, (&model, &of), &measurements, &mut files)?;
            let frequency_hz = identify.frequency_hz.clone();
            (Some(identify), frequency_hz)
        }
        Purpose::Respond => (None, respond_hz(&case, overrides, &measurements)?),
        Purpose::Sensitivities => {
            let (found, frequency_hz) =
                sensitivities::sensitivities(&case, overrides, (&model, &of), &measurements)?;
            sensitivities = Some(found);
            (None, frequency_hz)
        }
    };
    for (term, part) in model.terms().iter().zip(&of) {
        let entry = case.matrices.iter().find(|entry| entry.name.value == part.matrix);
        if let Some(entry) = entry {
            factor::covers(&term.factor, &entry.factor.place, &respond_hz)?;
        }
    }
    factor::sizes(&case, &model, &of, &respond_hz)?;
    let sensors = measurements.iter().map(|measurement| measurement.sensor).collect();
    Ok(Case {
        units: case.units,
        title: one_line(&case.title.unwrap_or_else(|| stem(case_file))).into_owned(),
        experiment: Experiment { load, sensors },
        coarser_mesh,
        sensors: measurements.into_iter().map(|measurement| measurement.info).collect(),
        row_names: dofs.names(),
        inputs: files.inputs,
        reads: files.reads,
        model: Arc::new(model),
        identify,
        sensitivities,
        respond_hz,
    })
}

/// The terms of a model, and the names of its rows.
struct Structure {
    terms: Vec<Term>,
    /// The matrix of the case that each is, or is part of; what is attached follows them.
    of: Vec<PartOf>,
    dofs: Dofs,
}

/// Reads matrices, factors, names of rows and what is attached. `keeps_dimensions`: a matrix that is given at several values of a dimension is one term for each
/// power of it, and else the matrix at its nominal value.
fn structure(case: &CaseFile, keeps_dimensions: bool, files: &mut Files) -> Result<Structure, InputError> {
    let Terms { terms, of, labels } = model::terms(case, files)?;
    let mut terms = if keeps_dimensions { terms } else { dimension::at_nominal(case, terms, &of)? };
    let dim = terms.first().map_or(0, |term| term.matrix.dim());
    let dofs = Dofs::read(case.dofs.as_ref(), dim, &labels, case.units, files)?;
    terms.extend(attached::terms(&case.attached, case.units, dim, &dofs)?);
    Ok(Structure { terms, of, dofs })
}

/// Reads the matrix of this name from a file, or without a name its only one. For a term of a model it still has to pass
/// [`symmetric_matrix`], and where the files of a model name their rows, [`load`] is what brings these to one order.
///
/// # Errors
/// A file that cannot be read, what the reader refuses, no matrix of the name, or several that it could be.
pub fn load_matrix(path: &Path, name: Option<&str>) -> Result<CoordinateMatrix, InputError> {
    let bytes = load_bytes(path, &mut Reads::default())?;
    let matrix = read_matrices(&bytes).and_then(|all| take_matrix(all, name)?.matrix);
    matrix.map_err(|error| InputError::in_file(path, error))
}

/// Reads an FRF from a UFF file or a table.
///
/// # Errors
/// A file that cannot be read, or as [`read_frf`].
pub fn load_frf(path: &Path, choice: &Choice) -> Result<Frf, InputError> {
    let bytes = load_bytes(path, &mut Reads::default())?;
    read_frf(&bytes, choice).map_err(|error| InputError::in_file(path, error))
}

/// The bytes of a plain file, which is one of those that were read from now on.
///
/// # Errors
/// What is there instead: nothing, a folder, something that may not be read.
pub fn load_bytes(path: &Path, reads: &mut Reads) -> Result<Vec<u8>, InputError> {
    reads.read(path).map_err(|found| InputError::at(&Place::file(path), "a file", found))
}

/// All measurements, read as far as the purpose asks for.
fn measurements(
    case: &CaseFile,
    purpose: Purpose,
    dofs: &Dofs,
    files: &mut Files,
) -> Result<Vec<Measurement>, InputError> {
    let driven_at = match &case.load {
        LoadEntry::At(Spot::Dof(name)) => Some(name),
        _ => None,
    };
    let asks_for_values = |k: usize| match purpose {
        Purpose::Identify => true,
        Purpose::Respond => k == 0 && case.respond.is_none(),
        Purpose::Sensitivities => case.respond.is_none() && case.measurements[k].file.is_some(),
    };
    (case.measurements.iter().enumerate())
        .map(|(k, entry)| measurement(entry, driven_at, asks_for_values(k), dofs, files))
        .collect()
}

/// The frequencies of a response.
fn respond_hz(
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
        Some(curve) => band::frequencies(curve, overrides.band_hz.unwrap_or([0.0, f64::MAX]), &option),
        None => Ok(Vec::new()),
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
