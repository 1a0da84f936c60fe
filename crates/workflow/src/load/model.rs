//! The matrices and their factors: the model.

use super::factor::law;
use super::files::{Files, NamedFile};
use super::matrix::{check_symmetric, symmetric_matrix};
use crate::case::{CaseFile, MatrixEntry};
use crate::error::InputError;
use frfit::model::{DynamicStiffness, ModelError, Term};
use frfit_formats::{CoordinateMatrix, Entries, FormatError, read_matrix};

/// Reads all matrices and factors: one term for each, in their order.
pub(super) fn terms(case: &CaseFile, files: &mut Files) -> Result<Vec<Term>, InputError> {
    let mut read = Vec::with_capacity(case.matrices.len());
    for entry in &case.matrices {
        let file = files.read(&entry.file)?;
        let matrix = read_matrix(&file.bytes).map_err(|error| file.refuse(error))?;
        check_symmetric(&matrix).map_err(|error| file.refuse(error))?;
        // The numbers are in the matrix: the text need not stay in memory.
        read.push((entry, matrix, NamedFile { bytes: Default::default(), ..file }));
    }
    same_sizes(&read)?;
    every_row_has_an_entry(case, &read)?;
    let mut terms = Vec::with_capacity(read.len());
    for (entry, matrix, file) in read {
        let matrix = symmetric_matrix(&matrix).map_err(|error| file.refuse(error))?;
        let factor = law(&entry.factor, files)?;
        terms.push(Term { name: entry.name.value.clone(), role: entry.role, matrix, factor });
    }
    Ok(terms)
}

/// The model of all terms.
pub(super) fn model(case: &CaseFile, terms: Vec<Term>) -> Result<DynamicStiffness, InputError> {
    let model = DynamicStiffness::new(terms).map_err(|error| unusable(case, &error))?;
    Ok(model.with_threads(rayon::current_num_threads()))
}

fn same_sizes(read: &[(&MatrixEntry, CoordinateMatrix, NamedFile)]) -> Result<(), InputError> {
    let Some(((first, size, _), others)) = read.split_first() else { return Ok(()) };
    match others.iter().find(|(_, matrix, _)| matrix.nrows != size.nrows) {
        Some((_, matrix, file)) => {
            let expected = format!("{} rows, as matrix {:?} has", size.nrows, first.name.value);
            Err(file.refuse(FormatError::whole(expected, matrix.nrows.to_string())))
        }
        None => Ok(()),
    }
}

/// Refuses a degree of freedom that nothing holds or moves: D would be singular at every frequency.
///
/// It is also what bounds memory: a file of a few bytes may say that it has two billion rows.
fn every_row_has_an_entry(
    case: &CaseFile,
    read: &[(&MatrixEntry, CoordinateMatrix, NamedFile)],
) -> Result<(), InputError> {
    let rows = read.first().map_or(0, |(_, matrix, _)| matrix.nrows);
    let entries: usize = read.iter().map(|(_, matrix, _)| matrix.rows.len()).sum();
    let refuse = |found: String| {
        let place = &case.matrices[0].file.place;
        Err(InputError::at(place, format!("an entry in each of the {rows} rows, in some matrix"), found))
    };
    // An entry is in two rows at most: its own and that of its mirror image.
    if rows / 2 > entries {
        return refuse(format!("{entries} in all"));
    }
    let mut empty = vec![true; rows];
    for (_, matrix, _) in read {
        for (k, (&row, &col)) in matrix.rows.iter().zip(&matrix.cols).enumerate() {
            if !is_zero(&matrix.entries, k) {
                empty[row] = false;
                empty[col] = false;
            }
        }
    }
    match empty.iter().position(|&empty| empty) {
        Some(row) => refuse(format!("none in row {}", row + 1)),
        None => Ok(()),
    }
}

fn is_zero(entries: &Entries, k: usize) -> bool {
    match entries {
        Entries::Pattern => false,
        Entries::Real(values) => values[k] == 0.0,
        Entries::Complex(values) => values[k].norm() == 0.0,
    }
}

fn unusable(case: &CaseFile, error: &ModelError) -> InputError {
    let place = &case.matrices[0].name.place;
    InputError::at(place, "matrices that make a model", error.to_string())
}
