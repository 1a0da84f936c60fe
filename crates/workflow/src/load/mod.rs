//! From a case file to everything that a computation needs: all files read, everything checked, nothing computed.

mod arrays;
mod attached;
mod band;
mod coarser;
mod corrections;
mod dimension;
mod dofs;
mod factor;
mod files;
mod force;
mod frf;
mod identify;
mod labels;
mod lines;
mod loaded;
mod matrix;
mod measurement;
mod model;
mod modes;
mod options;
mod overrides;
mod sensitivities;
mod shared;
mod solver;
mod structure;
mod table_of_unknown;
mod uff;
mod unknowns;

pub use arrays::{
    ArraysError, MeasuredFrf, Wanted, WantedUnknown, case_of_arrays, powers_of_arrays, response_of_arrays,
    sensitivities_of_arrays,
};
pub use band::MeasuredNoise;
pub use corrections::{Corrections, HannWindow, SensorShifts, WindowSource};
pub use files::{InputFile, load_bytes, read_frf};
pub(crate) use frf::decay_line;
pub use frf::{Choice, Frf};
pub use identify::{Check, IdentifyCase};
pub(crate) use labels::files_beside;
pub(crate) use labels::{Member, load_one, matrices_of, one_order};
pub use loaded::Case;
pub(crate) use matrix::empty_rows;
pub(crate) use matrix::{asymmetry, complex};
pub use matrix::{check_symmetric, symmetric_matrix};
pub use measurement::SensorInfo;
pub use modes::{MeasuredBand, ModesCase};
pub use overrides::Overrides;
pub use sensitivities::SensitivitiesCase;
pub(crate) use shared::SharedModels;
pub(crate) use table_of_unknown::table_of_unknown;
pub(crate) use uff::STD_LABEL;
pub use uff::read_frfs;

use crate::case::{self, CaseFile, LoadEntry, Spot};
use crate::error::InputError;
use crate::reads::Reads;
use crate::terminal::one_line;
use band::respond_hz;
use dofs::Dofs;
use files::Files;
use frfit::model::Experiment;
use frfit_formats::{CoordinateMatrix, read_matrices, take_matrix};
use measurement::{Measurement, common_decay, measurement};
use std::path::Path;
use std::sync::Arc;
use structure::{Structure, structure};

/// What a case is loaded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// `[identify]` and the files of all measurements are needed.
    Identify,
    /// `[identify]` is needed. Where a measurement has no file, no file is read: the values are not needed, and the frequencies are those of `[respond]`
    /// in the band, or equally spaced.
    Train,
    /// Neither is: a measurement's file is opened only for what the case leaves open (where it was measured, what was
    /// measured, and without `[respond]` the frequencies of the first).
    Respond,
    /// Neither is: as for a response, but without `[respond]` all files that there are, for what they say about noise, within `identify.band_hz`.
    Sensitivities,
    /// Neither is: all files of measurements that there are, within the band.
    Modes,
}

impl Purpose {
    fn identifies(self) -> bool {
        matches!(self, Self::Identify | Self::Train)
    }
}

/// Reads a case and every file it names.
///
/// # Errors
/// The first thing that the user has to put right.
pub fn load(case_file: &Path, overrides: &Overrides, purpose: Purpose) -> Result<Case, InputError> {
    let (files, bytes) = Files::of_case(case_file)?;
    load_text((case_file, &bytes), files, (overrides, purpose), None)
}

/// Reads a case to identify, of which another text takes the place of the one in its file, and shares its model with others.
pub(crate) fn load_edited(
    case_file: &Path,
    edit: impl FnOnce(&[u8]) -> Result<String, InputError>,
    overrides: &Overrides,
    shared: &SharedModels,
) -> Result<Case, InputError> {
    let (files, bytes) = Files::of_case(case_file)?;
    load_text((case_file, edit(&bytes)?.as_bytes()), files, (overrides, Purpose::Identify), Some(shared))
}

fn load_text(
    (case_file, bytes): (&Path, &[u8]),
    mut files: Files,
    (overrides, purpose): (&Overrides, Purpose),
    shared: Option<&SharedModels>,
) -> Result<Case, InputError> {
    let mut case = case::parse(case_file, bytes)?;
    case.solver = solver::overridden(case.solver, overrides)?;
    let keeps_dimensions = purpose.identifies() && case.unknowns().any(|one| one.nominal.is_some());
    let mut coarser_mesh = None;
    // A coarser mesh is compared with what was read.
    let shared = shared.filter(|_| case.coarser_mesh.is_none());
    let loaded = shared.map(|shared| shared.of_case(&case, keeps_dimensions, &mut files)).transpose()?;
    let (model, of, dofs) = match &loaded {
        Some(shared) => (shared.model.clone(), shared.of.clone(), Arc::clone(&shared.dofs)),
        None => {
            let structure = structure(&case, keeps_dimensions, &mut files)?;
            if let Some(entry) = case.coarser_mesh.as_ref().filter(|_| purpose.identifies()) {
                let fine = (&structure, keeps_dimensions);
                coarser_mesh = Some(coarser::coarser_mesh(entry, fine, &mut files)?);
            }
            let Structure { mut terms, of, dofs } = structure;
            if let Some(path) = &overrides.identified {
                modes::with_identified(&case, path, (&mut terms, &of), &mut files)?;
            }
            (model::model(&case, terms)?, of, Arc::new(dofs))
        }
    };
    let load = force::load(&case.load, model.dim(), &dofs, &mut files)?;
    let measurements = measurements(&case, purpose, &dofs, &mut files)?;
    let model = model.with_decay_per_s(common_decay(&measurements)?);
    let (mut sensitivities, mut modes) = (None, None);
    let (identify, respond_hz) = match purpose {
        Purpose::Identify | Purpose::Train => {
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
        Purpose::Modes => {
            modes = Some(modes::modes(&case, overrides, (&model, &of), &measurements)?);
            (None, Vec::new())
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
    let experiment = Experiment { load, sensors };
    let reduced = match &overrides.reduced {
        Some(path) => Some(match &loaded {
            Some(shared) => shared.reduced(path, &experiment, &mut files)?,
            None => files.read_reduced(path, &model, &experiment)?,
        }),
        None => None,
    };
    Ok(Case {
        units: case.units,
        title: one_line(&case.title.unwrap_or_else(|| stem(case_file))).into_owned(),
        experiment,
        reduced,
        coarser_mesh,
        sensors: measurements.into_iter().map(|measurement| measurement.info).collect(),
        row_names: dofs.names(),
        first_number: 1,
        inputs: files.inputs,
        reads: files.reads,
        model: Arc::new(model),
        identify,
        sensitivities,
        modes,
        respond_hz,
    })
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
        Purpose::Train => case.measurements.iter().all(|entry| entry.file.is_some()),
        Purpose::Respond => k == 0 && case.respond.is_none(),
        Purpose::Modes => case.measurements[k].file.is_some(),
        Purpose::Sensitivities => case.respond.is_none() && case.measurements[k].file.is_some(),
    };
    (case.measurements.iter().enumerate())
        .map(|(k, entry)| measurement(entry, driven_at, asks_for_values(k), dofs, files))
        .collect()
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
