//! Matrices of files that may hold several.

use super::ConvertOptions;
use crate::error::{InputError, Place};
use frfit_formats::{CoordinateMatrix, FormatError, choose, op4, read_matrices};
use std::path::Path;

/// The matrix that is meant.
pub(super) fn one(
    input: &Path,
    bytes: &[u8],
    options: &ConvertOptions,
) -> Result<CoordinateMatrix, InputError> {
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let mut all = read_matrices(bytes).map_err(in_input)?;
    if let Some(name) = &options.name {
        choose(&all, Some(name))
            .map_err(|error| InputError::at(&Place::option("--name"), error.expected, error.found))?;
        all.retain(|entry| entry.name == *name);
    }
    choose(&all, None)
        .map_err(|error| InputError::at(&Place::file(input), "one matrix, or --name", error.found))?;
    all.remove(0).matrix.map_err(in_input)
}

/// All matrices of a file, or the one that is meant, for Nastran.
pub(super) fn op4(input: &Path, bytes: &[u8], options: &ConvertOptions) -> Result<Vec<u8>, InputError> {
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let mut matrices = Vec::new();
    if let Some(name) = &options.name {
        matrices.push((name.clone(), one(input, bytes, options)?));
    } else {
        for entry in read_matrices(bytes).map_err(in_input)? {
            let matrix = entry.matrix.map_err(|error| {
                let found = format!("{} in {:?}", error.found, entry.name);
                in_input(FormatError { expected: format!("{}, or --name", error.expected), found, ..error })
            })?;
            matrices.push((entry.name, matrix));
        }
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
