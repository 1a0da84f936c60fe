//! The same structure on a coarser mesh: the matrices and the experiment of a second case.

use super::files::{Files, InputFile};
use super::measurement::measurement;
use super::{Structure, force, model, structure};
use crate::case::{self, CoarserMeshEntry};
use crate::error::InputError;
use frfit::identify::CoarserMesh;
use frfit::model::Experiment;

/// Reads the second case as far as it is a model with a load and sensors, and checks that it is of the same structure.
pub(super) fn coarser_mesh(
    entry: &CoarserMeshEntry,
    (fine, keeps_dimensions): (&Structure, bool),
    files: &mut Files,
) -> Result<CoarserMesh, InputError> {
    let refuse = |expected: String, found: String| Err(InputError::at(&entry.file.place, expected, found));
    let path = files.beside(&entry.file)?;
    let (mut own, bytes) = Files::of_case(&path).map_err(|error| error.named_by(&entry.file.place))?;
    let case = case::parse(&path, &bytes)?;
    let Structure { terms, of, dofs } = structure(&case, keeps_dimensions, &mut own)?;
    let names = |structure: &[super::dimension::PartOf]| {
        let mut names: Vec<String> = structure.iter().map(|part| part.matrix.clone()).collect();
        names.dedup();
        names.join(", ")
    };
    let [wanted, found] = [names(&fine.of), names(&of)];
    if wanted != found || fine.terms.len() != terms.len() {
        let more = |of: &Structure| of.terms.len() - of.of.len();
        let count = |matrices: &str, more: usize| match more {
            0 => matrices.to_owned(),
            more => format!("{matrices} and {more} attached"),
        };
        let expected = count(&wanted, more(fine));
        let found = count(&found, terms.len() - of.len());
        return refuse(format!("a case with the same matrices in the same order, {expected}"), found);
    }
    let model = model::model(&case, terms)?;
    let load = force::load(&case.load, model.dim(), &dofs, &mut own)?;
    let mut sensors = Vec::with_capacity(case.measurements.len());
    for entry in &case.measurements {
        sensors.push(measurement(entry, None, false, &dofs, &mut own)?.sensor);
    }
    let folder = path.parent().map(std::path::Path::to_path_buf).unwrap_or_default();
    let named = own.inputs.into_iter().enumerate().map(|(k, file)| match k {
        0 => file,
        _ => InputFile { path: folder.join(&file.path), ..file },
    });
    files.inputs.extend(named);
    files.reads.extend(own.reads);
    Ok(CoarserMesh {
        model,
        experiment: Experiment { load, sensors },
        element_ratio: entry.element_ratio.unwrap_or(CoarserMesh::ELEMENT_RATIO),
        order: entry.order.unwrap_or(CoarserMesh::ORDER),
    })
}
