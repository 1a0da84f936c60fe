//! The same structure on a coarser mesh: the matrices and the experiment of a second case.

use super::files::{Files, InputFile};
use super::force::load;
use super::measurement::measurement;
use super::model::model;
use super::structure::{Structure, structure};
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
    let path = files.beside(&entry.file)?;
    let (mut own, bytes) = Files::of_case(&path).map_err(|error| error.named_by(&entry.file.place))?;
    let case = case::parse(&path, &bytes)?;
    let coarse = structure(&case, keeps_dimensions, &mut own)?;
    let [wanted, found] = [described(fine), described(&coarse)];
    if wanted != found {
        let expected = format!("a case with the same matrices in the same order, {wanted}");
        return Err(InputError::at(&entry.file.place, expected, found));
    }
    let Structure { terms, dofs, .. } = coarse;
    let model = model(&case, terms)?;
    let load = load(&case.load, model.dim(), &dofs, &mut own)?;
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

/// Its matrices, each once however many powers of a dimension it has, and how many terms are attached.
fn described(structure: &Structure) -> String {
    let mut names: Vec<&str> = structure.of.iter().map(|part| part.matrix.as_str()).collect();
    names.dedup();
    let attached = match structure.terms.len() - structure.of.len() {
        0 => String::new(),
        count => format!(" and {count} attached"),
    };
    names.join(", ") + &attached
}
