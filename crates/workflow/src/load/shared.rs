//! Models that several cases have in common: read, brought to one pattern and analysed once.

use super::dimension::PartOf;
use super::dofs::Dofs;
use super::factor::law;
use super::files::{Files, InputFile};
use super::model::{analysed, with_stds};
use super::structure::{Structure, structure};
use crate::case::{AtValues, CaseFile};
use crate::error::InputError;
use crate::reads::Reads;
use frfit::model::{DynamicStiffness, Experiment};
use frfit::subspace::KeptSubspace;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Models at most: plans have one or a few.
const MAX_MODELS: usize = 4;

/// The models of cases that are loaded one after the other, or at the same time. Cases whose matrices, names of rows and attached parts are the same files share one, whatever
/// their factors, measurements and unknowns.
#[derive(Debug, Default)]
pub(crate) struct SharedModels(Mutex<Vec<Arc<SharedModel>>>);

#[derive(Debug)]
struct SharedModel {
    /// What makes a model this one.
    key: String,
    model: DynamicStiffness,
    of: Vec<PartOf>,
    dofs: Arc<Dofs>,
    /// What was read for it.
    inputs: Vec<InputFile>,
    reads: Reads,
    /// Reduced models that were read for it, with their file, load and sensors.
    kept: Mutex<Vec<ReducedOf>>,
}

/// A reduced model that was read: its file, for which load and sensors, and what was read.
#[derive(Debug)]
struct ReducedOf {
    path: PathBuf,
    experiment: Experiment,
    kept: KeptSubspace,
    input: Option<InputFile>,
}

/// The model of a case.
pub(super) struct Loaded {
    pub(super) model: DynamicStiffness,
    pub(super) of: Vec<PartOf>,
    pub(super) dofs: Arc<Dofs>,
    shared: Arc<SharedModel>,
}

impl SharedModels {
    /// The model of a case, read where no other case had it. Who comes at the same time waits.
    pub(super) fn of_case(
        &self,
        case: &CaseFile,
        keeps_dimensions: bool,
        files: &mut Files,
    ) -> Result<Loaded, InputError> {
        let key = key(case, keeps_dimensions, files.folder());
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = match all.iter().find(|shared| shared.key == key) {
            Some(shared) => Arc::clone(shared),
            None => {
                let mut own = files.of_the_same_case();
                let Structure { terms, of, dofs } = structure(case, keeps_dimensions, &mut own)?;
                let model = analysed(case, terms)?;
                let Files { inputs, reads, .. } = own;
                let (dofs, kept) = (Arc::new(dofs), Mutex::default());
                let new = Arc::new(SharedModel { key, model, of, dofs, inputs, reads, kept });
                if all.len() == MAX_MODELS {
                    all.remove(0);
                }
                all.push(Arc::clone(&new));
                new
            }
        };
        drop(all);
        files.extend(&shared.inputs, &shared.reads);
        let mut model = shared.model.clone();
        for (term, part) in shared.of.iter().enumerate() {
            if let Some(entry) = case.matrices.iter().find(|entry| entry.name.value == part.matrix) {
                model = model.with_factor(term, law(&entry.factor, files)?);
            }
        }
        let model = with_stds(case, model)?;
        Ok(Loaded { model, of: shared.of.clone(), dofs: Arc::clone(&shared.dofs), shared })
    }
}

impl Loaded {
    /// The reduced model in a file, read where no other case of this model has it for the same load and sensors.
    pub(super) fn reduced(
        &self,
        path: &Path,
        experiment: &Experiment,
        files: &mut Files,
    ) -> Result<KeptSubspace, InputError> {
        let mut all = self.shared.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = all.iter().find(|one| one.path == path && one.experiment == *experiment) {
            files.extend(before.input.as_slice(), &Reads::default());
            return Ok(before.kept.clone());
        }
        let kept = files.read_reduced(path, &self.model, experiment)?;
        let (path, experiment, input) =
            (path.to_path_buf(), experiment.clone(), files.inputs.last().cloned());
        all.push(ReducedOf { path, experiment, kept: kept.clone(), input });
        Ok(kept)
    }
}

/// Everything that makes a model, but for factors and places in the case file.
fn key(case: &CaseFile, keeps_dimensions: bool, folder: &Path) -> String {
    let at = |at: &AtValues| {
        let files: Vec<(f64, &str)> =
            at.files.iter().map(|(value, file)| (*value, file.value.as_str())).collect();
        let powers = at.powers.as_ref().map(|powers| powers.value.as_slice());
        format!("{} {files:?} {powers:?}", at.dimension.value)
    };
    let matrices: Vec<String> = case
        .matrices
        .iter()
        .map(|entry| {
            let in_file = entry.in_file.as_ref().map(|name| &name.value);
            let dimension = entry.at.as_ref().map(at);
            format!(
                "{:?} {:?} {:?} {in_file:?} {dimension:?}",
                entry.name.value, entry.role, entry.file.value
            )
        })
        .collect();
    let dofs = case.dofs.as_ref().map(|file| &file.value);
    format!(
        "{folder:?} {:?} {keeps_dimensions} {matrices:?} {dofs:?} {:?} {:?}",
        case.units, case.attached, case.solver
    )
}
