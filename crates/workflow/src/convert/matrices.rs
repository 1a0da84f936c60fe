//! Matrices of files that may hold several.

use super::ConvertOptions;
use crate::error::{InputError, Place};
use frfit_formats::{CoordinateMatrix, FormatError, Labels, NamedMatrix, csv, mat, op4, take_matrix};
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

/// Matrices with names as the bytes of a file.
type Writer = fn(&[(&str, &CoordinateMatrix)]) -> Result<Vec<u8>, FormatError>;

/// How a format of several matrices is written.
pub(super) struct Several {
    /// A name as the format takes it.
    name: fn(&str) -> String,
    /// What two names have to differ in.
    differ: &'static str,
    write: Writer,
}

pub(super) const NASTRAN: Several =
    Several { name: for_nastran, differ: "names that differ in eight letters and digits", write: op4::write };

pub(super) const MATLAB: Several = Several {
    name: for_matlab,
    differ: "names that differ in letters, digits and underscores",
    write: mat::write,
};

/// All matrices of a file, or the one that is meant.
pub(super) fn written(
    input: &Path,
    all: Vec<NamedMatrix>,
    options: &ConvertOptions,
    format: &Several,
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
    let of = |(name, _): &(String, CoordinateMatrix)| {
        (format.name)(if name.is_empty() { &stem } else { name.as_str() })
    };
    let names: Vec<String> = matrices.iter().map(of).collect();
    if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
        let expected = format!("{}, or --name", format.differ);
        return Err(in_input(FormatError::whole(expected, format!("{:?} a second time", names[k]))));
    }
    let named: Vec<_> =
        names.iter().map(String::as_str).zip(matrices.iter().map(|(_, matrix)| matrix)).collect();
    (format.write)(&named).map_err(in_input)
}

/// A letter and letters, digits and underscores, 63 in all.
fn for_matlab(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let start = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "M" };
    start.chars().chain(name.chars().map(letter)).take(63).collect()
}

/// Eight letters and digits at most, the first a letter.
fn for_nastran(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_uppercase());
    let start = if name.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "M" };
    start.chars().chain(letters).take(8).collect()
}

#[cfg(test)]
mod tests {
    use super::{for_matlab, for_nastran};

    #[test]
    fn names_are_those_that_each_program_allows() {
        for (name, nastran, matlab) in [
            ("K", "K", "K"),
            ("K_skins", "KSKINS", "K_skins"),
            ("model.stiffness", "MODELSTI", "model_stiffness"),
            ("2nd", "M2ND", "M2nd"),
            ("_x", "MX", "M_x"),
            ("", "M", "M"),
        ] {
            assert_eq!([for_nastran(name), for_matlab(name)], [nastran, matlab]);
        }
    }
}
