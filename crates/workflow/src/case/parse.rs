//! The whole file.

use super::document::Document;
use super::entries::{CaseFile, FactorEntry, MatrixEntry};
use super::field::{Table, shown};
use super::identify::identify;
use super::keys::{ATTACHED, CASE, DOFS, LOAD, MATRIX, MEASUREMENT, Section};
use super::sections::{
    attached, coarser_mesh, factor, load, matrix, measurement, model_error, respond, solver, units,
};
use crate::error::{InputError, Place};
use frfit::material::Law;
use std::path::Path;

/// Reads a case file from its bytes. `file` is its name in errors.
///
/// # Errors
/// Text that is not TOML; a key that is unknown, missing or of the wrong type, and the place where it is.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<CaseFile, InputError> {
    let document = Document::new(file, bytes)?;
    let tables = document.tables()?;
    let case = Table::new(&document, Place::file(file), tables.get_ref(), &[&CASE])?;
    let missing = |table: String| InputError::at(&case.place, table, "none");
    let many = |name: &str, section: &'static Section| match case.find(name) {
        Some(field) => field.tables(name, &[section]),
        None => Err(missing(format!("at least one table [[{name}]]"))),
    };

    let matrices = many("matrix", &MATRIX)?;
    let measurements = many("measurement", &MEASUREMENT)?;
    let attached = match case.find("attached") {
        Some(field) => {
            field.tables("attached", &[&ATTACHED])?.iter().map(attached).collect::<Result<_, _>>()?
        }
        None => Vec::new(),
    };
    let force = case.find("load").ok_or_else(|| missing("a table [load]".into()))?;
    let dofs = match case.find("dofs") {
        Some(dofs) => Some(dofs.table(&[&DOFS])?.need("file")?.text()?),
        None => None,
    };
    Ok(CaseFile {
        file: file.to_path_buf(),
        units: case.find("units").map(|units| self::units(&units)).transpose()?.unwrap_or_default(),
        title: case.find("title").map(|title| title.text()).transpose()?.map(|title| title.value),
        matrices: named_once(matrices.iter().map(matrix).collect::<Result<_, _>>()?)?,
        dofs,
        attached,
        load: load(&force.table(&[&LOAD])?)?,
        measurements: measurements.iter().map(measurement).collect::<Result<_, _>>()?,
        model_error: case
            .find("model_error")
            .map(|field| model_error(&field))
            .transpose()?
            .unwrap_or_default(),
        coarser_mesh: case.find("coarser_mesh").map(|field| coarser_mesh(&field)).transpose()?,
        identify: case.find("identify").map(|field| identify(&field)).transpose()?,
        respond: case.find("respond").map(|field| respond(&field)).transpose()?,
        solver: case.find("solver").map(|field| solver(&field)).transpose()?.unwrap_or_default(),
    })
}

/// The law of a line `factor = { … }`, as `law.json` has it. `file` is where the line is.
///
/// # Errors
/// The error of a case file with this line; a table in place of a law.
pub(crate) fn law_of_snippet(file: &Path, line: &str) -> Result<Law, InputError> {
    let document = Document::new(file, line.as_bytes())?;
    let tables = document.tables()?;
    let table = Table::new(&document, Place::file(file), tables.get_ref(), &[&MATRIX])?;
    let field = table.need("factor")?;
    match factor(&field)?.value {
        FactorEntry::Law(law) => Ok(law),
        FactorEntry::Table(_) => Err(field.refuse("a law")),
    }
}

/// Refuses a name that two matrices have.
fn named_once(matrices: Vec<MatrixEntry>) -> Result<Vec<MatrixEntry>, InputError> {
    for (k, entry) in matrices.iter().enumerate() {
        if matrices[..k].iter().any(|earlier| earlier.name.value == entry.name.value) {
            let found = format!("{} a second time", shown(&entry.name.value));
            return Err(InputError::at(&entry.name.place, "a name of its own for each matrix", found));
        }
    }
    Ok(matrices)
}
