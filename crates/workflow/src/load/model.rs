//! The matrices and their factors: the model.

use super::dimension::{PartOf, polynomial};
use super::factor::law;
use super::files::{Files, NamedFile};
use super::labels::{Member, Order, names_beside, one_order, read_names, sibling};
use super::matrix::{check_symmetric, empty_rows, symmetric_matrix};
use super::solver;
use crate::case::Located;
use crate::case::{CaseFile, MatrixEntry};
use crate::error::InputError;
use frfit::model::Role;
use frfit::model::{DynamicStiffness, ModelError, Term};
use frfit_formats::{
    CoordinateMatrix, DofLabel, FormatError, Labels, NamedMatrix, choose_matrix, detect, read_matrices,
};
use frfit_linalg::sparse::{SymmetricMatrix, Values};
use std::borrow::Cow;
use std::rc::Rc;
use std::sync::Arc;

/// A matrix of the case, and where it is from.
struct Read<'a> {
    entry: &'a MatrixEntry,
    /// The entry's number, and of a dimension's value whose matrix this is.
    number: usize,
    value: Option<f64>,
    /// All of its file: terms may be in one file.
    all: Rc<Vec<NamedMatrix>>,
    /// Names of its rows that are in a file beside it.
    beside: Option<Labels>,
    file: NamedFile,
}

impl Read<'_> {
    fn chosen(&self) -> Result<&NamedMatrix, FormatError> {
        choose_matrix(&self.all, self.entry.in_file.as_ref().map(|name| name.value.as_str()))
    }

    fn matrix(&self) -> Result<&CoordinateMatrix, FormatError> {
        self.chosen()?.matrix.as_ref().map_err(FormatError::clone)
    }

    fn labels(&self) -> Result<&Labels, FormatError> {
        self.beside.as_ref().map_or_else(|| Ok(&self.chosen()?.labels), Ok)
    }

    /// What is wrong with it, with its file and the key that names it.
    fn refuse(&self, error: FormatError) -> InputError {
        self.file.refuse(error)
    }
}

/// The terms of the model.
pub(super) struct Terms {
    pub(super) terms: Vec<Term>,
    /// The matrix of the case that each is, or is part of.
    pub(super) of: Vec<PartOf>,
    /// What each row stands for, where the files of the matrices say so: then all are in one order.
    pub(super) labels: Vec<DofLabel>,
}

/// Reads all matrices and factors: one term for each, in their order, or of a matrix that is given at several values of a dimension one for each of its powers.
pub(super) fn terms(case: &CaseFile, files: &mut Files) -> Result<Terms, InputError> {
    let mut read: Vec<Read<'_>> = Vec::with_capacity(case.matrices.len());
    let wanted = case.matrices.iter().enumerate().flat_map(|(number, entry)| {
        let alone = entry.at.is_none().then_some((number, entry, None, &entry.file));
        let each = entry.at.iter().flat_map(|at| &at.files);
        alone.into_iter().chain(each.map(move |(value, file)| (number, entry, Some(*value), file)))
    });
    for (number, entry, value, name) in wanted {
        let file = files.read(name)?;
        let all = match read.iter().find(|earlier| earlier.file.path == file.path) {
            Some(earlier) => Rc::clone(&earlier.all),
            None => Rc::new(read_matrices(&file.bytes).map_err(|error| file.refuse(error))?),
        };
        let kind = detect(&file.bytes);
        // The numbers are in the matrix: the text need not stay in memory.
        let file = file.closed();
        let mut one = Read { entry, number, value, all, beside: None, file };
        one.matrix().and_then(check_symmetric).map_err(|error| one.refuse(error))?;
        if let Some((kind, path)) = kind.and_then(|kind| Some((kind, names_beside(&one.file.path, kind)?))) {
            let name = Located { value: sibling(&name.value, &path), place: name.place.clone() };
            let names = files.read(&name)?;
            let rows = one.matrix().map_or(0, |matrix| matrix.nrows);
            one.beside = Some(read_names(kind, &names.bytes, rows).map_err(|error| names.refuse(error))?);
        }
        read.push(one);
    }
    let (labels, matrices) = in_one_order(&read)?;
    same_sizes(&matrices)?;
    every_row_has_an_entry(case, &matrices, &labels)?;
    let (mut terms, mut of) = (Vec::with_capacity(read.len()), Vec::with_capacity(read.len()));
    for (entry, own) in case.matrices.iter().zip(matrices.chunk_by(|(a, _), (b, _)| a.number == b.number)) {
        let factor = law(&entry.factor, files)?;
        let term = |name: String, matrix| Term { name, role: entry.role, matrix, factor: factor.clone() };
        let name = &entry.name.value;
        let mut samples = Vec::with_capacity(own.len());
        for (one, matrix) in own {
            let matrix = symmetric_matrix(matrix).map_err(|error| one.refuse(error))?;
            let matrix = in_metres(matrix, case.units.matrix(entry.role));
            samples.push((one.value, matrix));
        }
        match &entry.at {
            None => {
                terms.extend(samples.into_iter().map(|(_, matrix)| term(name.clone(), matrix)));
                of.push(PartOf { matrix: name.clone(), dimension: None });
            }
            Some(at) => {
                let samples = samples.into_iter().filter_map(|(value, matrix)| Some((value?, matrix)));
                let samples: Vec<_> = samples.collect();
                for (power, matrix) in polynomial(&samples, at.powers.as_ref(), &at.dimension)? {
                    let dimension = at.dimension.value.clone();
                    terms.push(term(format!("{name} ({dimension}^{power})"), matrix));
                    of.push(PartOf { matrix: name.clone(), dimension: Some((dimension, power)) });
                }
            }
        }
    }
    Ok(Terms { terms, of, labels })
}

/// A matrix of the model's units that acts on metres: see [`crate::units`].
fn in_metres(matrix: SymmetricMatrix, by: f64) -> SymmetricMatrix {
    if by == 1.0 {
        return matrix;
    }
    let values = match matrix.values() {
        Values::Real(values) => Values::Real(values.iter().map(|value| by * value).collect()),
        Values::Complex(values) => Values::Complex(values.iter().map(|value| by * value).collect()),
    };
    SymmetricMatrix::new(Arc::clone(matrix.pattern()), values)
}

/// All matrices on the same rows, and what these stand for; nothing where no file says so.
fn in_one_order<'a>(read: &'a [Read<'_>]) -> Result<(Vec<DofLabel>, Vec<OfFile<'a>>), InputError> {
    let mut members = Vec::with_capacity(read.len());
    for one in read {
        let refuse = |error| one.refuse(error);
        let is_stiffness = one.entry.role == Role::Stiffness;
        let (matrix, labels) = (one.matrix().map_err(refuse)?, one.labels().map_err(refuse)?);
        members.push(Member { matrix, labels, is_stiffness });
    }
    let order = one_order(&members).map_err(|(k, error)| read[k].refuse(error))?;
    let mut matrices = Vec::with_capacity(read.len());
    for (k, (one, member)) in read.iter().zip(&members).enumerate() {
        let moved = order.as_ref().and_then(|order| order.apply(k, member.matrix)).transpose();
        let moved = moved.map_err(|error| one.refuse(error))?;
        matrices.push((one, moved.map_or(Cow::Borrowed(member.matrix), Cow::Owned)));
    }
    Ok((order.map_or(Vec::new(), |Order { labels, .. }| labels), matrices))
}

/// A matrix of the model, and where it is from.
type OfFile<'a> = (&'a Read<'a>, Cow<'a, CoordinateMatrix>);

/// The model of all terms.
pub(super) fn model(case: &CaseFile, terms: Vec<Term>) -> Result<DynamicStiffness, InputError> {
    with_stds(case, analysed(case, terms)?)
}

/// All terms on one pattern.
pub(super) fn analysed(case: &CaseFile, terms: Vec<Term>) -> Result<DynamicStiffness, InputError> {
    let engine = solver::engine(&case.solver)?;
    DynamicStiffness::with_engine(terms, engine.as_ref()).map_err(|error| unusable(case, &error))
}

/// A model with what the case says of its factors.
pub(super) fn with_stds(case: &CaseFile, model: DynamicStiffness) -> Result<DynamicStiffness, InputError> {
    let with_std = |model: DynamicStiffness, entry: &MatrixEntry| match &entry.factor_std {
        Some(std) => {
            let term = model.find(&entry.name.value).map_err(|error| unusable(case, &error))?;
            Ok(model.with_factor_std(term, std.value))
        }
        None => Ok(model),
    };
    let model = case.matrices.iter().try_fold(model, with_std)?;
    Ok(model.with_threads(rayon::current_num_threads()))
}

fn same_sizes(read: &[OfFile<'_>]) -> Result<(), InputError> {
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
    read: &[OfFile<'_>],
    labels: &[DofLabel],
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
    match empty_rows(rows, read.iter().map(|(_, matrix)| matrix.as_ref())).first() {
        Some(&row) => {
            let name = labels.get(row).map_or(String::new(), |label| format!(" ({label})"));
            refuse(format!("none in row {}{name}", row + 1))
        }
        None => Ok(()),
    }
}

fn unusable(case: &CaseFile, error: &ModelError) -> InputError {
    let place = &case.matrices[0].name.place;
    InputError::at(place, "matrices that make a model", error.to_string())
}
