//! The matrices and their factors: the model.

use super::factor::law;
use super::files::{Files, NamedFile};
use super::matrix::{check_symmetric, symmetric_matrix};
use crate::case::{CaseFile, MatrixEntry};
use crate::error::InputError;
use frfit::model::{DynamicStiffness, ModelError, Term};
use frfit_formats::{CoordinateMatrix, Entries, FormatError, NamedMatrix, choose_matrix, read_matrices};
use std::rc::Rc;

/// A matrix of the case, and where it is from.
struct Read<'a> {
    entry: &'a MatrixEntry,
    /// All of its file: terms may be in one file.
    all: Rc<Vec<NamedMatrix>>,
    file: NamedFile,
}

impl Read<'_> {
    fn matrix(&self) -> Result<&CoordinateMatrix, FormatError> {
        choose_matrix(&self.all, self.entry.in_file.as_ref().map(|name| name.value.as_str()))
    }

    /// What is wrong with it, with its file and the key that names it.
    fn refuse(&self, error: FormatError) -> InputError {
        self.file.refuse(error)
    }
}

/// Reads all matrices and factors: one term for each, in their order.
pub(super) fn terms(case: &CaseFile, files: &mut Files) -> Result<Vec<Term>, InputError> {
    let mut read: Vec<Read<'_>> = Vec::with_capacity(case.matrices.len());
    for entry in &case.matrices {
        let file = files.read(&entry.file)?;
        let all = match read.iter().find(|earlier| earlier.file.path == file.path) {
            Some(earlier) => Rc::clone(&earlier.all),
            None => Rc::new(read_matrices(&file.bytes).map_err(|error| file.refuse(error))?),
        };
        // The numbers are in the matrix: the text need not stay in memory.
        let one = Read { entry, all, file: NamedFile { bytes: Default::default(), ..file } };
        one.matrix().and_then(check_symmetric).map_err(|error| one.refuse(error))?;
        read.push(one);
    }
    let matrices: Vec<_> = read.iter().flat_map(|one| Some((one, one.matrix().ok()?))).collect();
    same_sizes(&matrices)?;
    every_row_has_an_entry(case, &matrices)?;
    let mut terms = Vec::with_capacity(read.len());
    for one in read {
        let matrix = one.matrix().and_then(symmetric_matrix).map_err(|error| one.refuse(error))?;
        let factor = law(&one.entry.factor, files)?;
        terms.push(Term { name: one.entry.name.value.clone(), role: one.entry.role, matrix, factor });
    }
    Ok(terms)
}

/// The model of all terms.
pub(super) fn model(case: &CaseFile, terms: Vec<Term>) -> Result<DynamicStiffness, InputError> {
    DynamicStiffness::new(terms).map_err(|error| unusable(case, &error))
}

fn same_sizes(read: &[(&Read<'_>, &CoordinateMatrix)]) -> Result<(), InputError> {
    let Some(((first, size), others)) = read.split_first() else { return Ok(()) };
    match others.iter().find(|(_, matrix)| matrix.nrows != size.nrows) {
        Some((one, matrix)) => {
            let expected = format!("{} rows, as matrix {:?} has", size.nrows, first.entry.name.value);
            Err(one.refuse(FormatError::whole(expected, matrix.nrows.to_string())))
        }
        None => Ok(()),
    }
}

/// Refuses a degree of freedom that nothing holds or moves: D would be singular at every frequency.
///
/// It is also what bounds memory: a file of a few bytes may say that it has two billion rows.
fn every_row_has_an_entry(
    case: &CaseFile,
    read: &[(&Read<'_>, &CoordinateMatrix)],
) -> Result<(), InputError> {
    let rows = read.first().map_or(0, |(_, matrix)| matrix.nrows);
    let entries: usize = read.iter().map(|(_, matrix)| matrix.rows.len()).sum();
    let refuse = |found: String| {
        let place = &case.matrices[0].file.place;
        Err(InputError::at(place, format!("an entry in each of the {rows} rows, in some matrix"), found))
    };
    // An entry is in two rows at most: its own and that of its mirror image.
    if rows / 2 > entries {
        return refuse(format!("{entries} in all"));
    }
    let mut empty = vec![true; rows];
    for (_, matrix) in read {
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
