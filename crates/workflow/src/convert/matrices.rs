//! Matrices of files that may hold several.

use super::ConvertOptions;
use crate::error::{InputError, Place};
use frfit_formats::{FormatError, Labels, NamedMatrix, csv, op4, take_matrix};
use std::path::Path;

/// The matrix that is meant.
pub(super) fn one(
    input: &Path,
    all: Vec<NamedMatrix>,
    options: &ConvertOptions,
) -> Result<NamedMatrix, InputError> {
    take_matrix(all, options.name.as_deref()).map_err(|error| match options.name {
        Some(_) => InputError::at(&Place::option("--name"), error.expected, error.found),
        None => InputError::at(&Place::file(input), "one matrix, or --name", error.found),
    })
}

/// A table of row, node and direction, which `[dofs]` reads; rows without a direction, or at a node of the solver's own,
/// are not in it.
pub(super) fn names_of_rows(labels: &Labels) -> Result<Vec<u8>, FormatError> {
    let named = labels.rows.iter().enumerate().filter(|(_, label)| label.node > 0);
    let rows: Vec<_> = named
        .filter_map(|(row, label)| Some((row, usize::try_from(label.node).ok()?, label.direction()?)))
        .map(|(row, node, direction)| {
            [csv::Cell::Count(row + 1), csv::Cell::Count(node), csv::Cell::Text(direction.name())]
        })
        .collect();
    if rows.is_empty() {
        let expected = "a file that names its rows (or has a .dof or .mapping file beside it)";
        return Err(FormatError::whole(expected, "no names"));
    }
    csv::write(&["row", "node", "direction"], rows).map(String::into_bytes)
}

/// All matrices of a file, or the one that is meant, for Nastran.
pub(super) fn op4(
    input: &Path,
    all: Vec<NamedMatrix>,
    options: &ConvertOptions,
) -> Result<Vec<u8>, InputError> {
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let meant = if options.name.is_some() { vec![one(input, all, options)?] } else { all };
    let mut matrices = Vec::new();
    for NamedMatrix { name, matrix, .. } in meant {
        let matrix = matrix.map_err(|error| match options.name {
            Some(_) => in_input(error),
            None => {
                let found = format!("{} in {name:?}", error.found);
                in_input(FormatError { expected: format!("{}, or --name", error.expected), found, ..error })
            }
        })?;
        matrices.push((name, matrix));
    }
    let stem = input.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let names: Vec<_> =
        matrices.iter().map(|(name, _)| for_nastran(if name.is_empty() { &stem } else { name })).collect();
    if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        let expected = "names that differ in eight letters and digits, or --name";
        return Err(in_input(FormatError::whole(expected, format!("{:?} a second time", names[k]))));
    }
    let named: Vec<_> =
        names.iter().map(String::as_str).zip(matrices.iter().map(|(_, matrix)| matrix)).collect();
    op4::write(&named).map_err(in_input)
}

/// Eight letters and digits at most, the first a letter.
fn for_nastran(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_uppercase());
    let start = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "M" };
    start.chars().chain(letters).take(8).collect()
}

#[cfg(test)]
mod tests {
    use super::for_nastran;

    #[test]
    fn names_are_those_that_nastran_allows() {
        for (name, expected) in [
            ("K", "K"),
            ("K_skins", "KSKINS"),
            ("model.stiffness", "MODELSTI"),
            ("2nd", "M2ND"),
            ("_x", "MX"),
            ("", "M"),
        ] {
            assert_eq!(for_nastran(name), expected);
        }
    }
}
