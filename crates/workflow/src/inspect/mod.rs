//! What is in a file: enough to see that it is the right one, and in which units.

mod function;
mod lvm;
mod matrix;
mod modes;
mod table;
mod text;
mod uff;

pub use lvm::LvmFacts;
pub use matrix::{LabelFacts, MatrixFacts};
pub use modes::{modes_json, natural_frequencies, rigid_body_modes};
pub use table::{TableFacts, TableUse};
pub use uff::{UffContent, UffRecord};

use crate::error::{InputError, Place};
use crate::load::{load_bytes, matrices_of};
use crate::reads::Reads;
use frfit_formats::{FileKind, FormatError, MATRIX_FORMATS, NamedMatrix, detect};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What is in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspection {
    /// The path as it was given.
    pub file: PathBuf,
    /// What the file holds.
    pub content: Content,
}

/// What a file holds, by its kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// The datasets of a UFF file.
    Uff(Vec<UffRecord>),
    /// A matrix that has no name.
    Matrix(Box<MatrixFacts>),
    /// Matrices with names.
    Matrices(FileKind, Vec<NamedFacts>),
    /// A table.
    Table(TableFacts),
    /// A LabVIEW measurement file.
    Lvm(LvmFacts),
}

/// A matrix of a file of several.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedFacts {
    /// Its name in the file.
    pub name: String,
    /// What it is, or why it cannot be read.
    pub facts: Result<MatrixFacts, FormatError>,
}

/// Looks into a file; of what kind it is, its content says.
///
/// The data of the functions of a UFF file are not read, and a dataset that cannot be read is listed with its error.
///
/// # Errors
/// A file that cannot be read, is of no known kind, or is a broken matrix or table.
pub fn inspect(path: &Path) -> Result<Inspection, InputError> {
    // Nothing is written of it.
    let mut reads = Reads::default();
    let bytes = load_bytes(path, &mut reads)?;
    let refuse = |error| InputError::in_file(path, error);
    let content = match detect(&bytes) {
        Some(FileKind::Uff) => Content::Uff(uff::records(&bytes).map_err(refuse)?),
        Some(FileKind::Lvm) => Content::Lvm(LvmFacts::read(&bytes).map_err(refuse)?),
        Some(FileKind::Csv) => Content::Table(TableFacts::read(&bytes).map_err(refuse)?),
        Some(kind) => matrices(path, kind, matrices_of(path, &bytes, &mut reads)?)?,
        None => return Err(unknown_kind(path, &bytes, "a table (CSV) or time records (.lvm)")),
    };
    Ok(Inspection { file: path.to_path_buf(), content })
}

/// What a matrix file holds.
fn matrices(path: &Path, kind: FileKind, all: Vec<NamedMatrix>) -> Result<Content, InputError> {
    if let [NamedMatrix { name, matrix, labels }] = &all[..]
        && name.is_empty()
    {
        let matrix = matrix.as_ref().map_err(|error| InputError::in_file(path, error.clone()))?;
        return Ok(Content::Matrix(Box::new(MatrixFacts::of(kind, matrix, labels))));
    }
    let facts = all.into_iter().map(|NamedMatrix { name, matrix, labels }| {
        let facts = matrix.map(|matrix| MatrixFacts::of(kind, &matrix, &labels));
        let facts = facts.map_err(|error| error.in_file(path));
        NamedFacts { name, facts }
    });
    Ok(Content::Matrices(kind, facts.collect()))
}

impl NamedFacts {
    fn json(&self) -> Value {
        let mut object = match &self.facts {
            Ok(facts) => facts.json(),
            Err(error) => json!({"error": error.to_string()}),
        };
        object["name"] = json!(self.name);
        object
    }

    fn lines(&self) -> String {
        let lines = match &self.facts {
            Ok(facts) => facts.lines(&self.name),
            Err(error) => format!("  {error}\n"),
        };
        let indented = lines.lines().map(|line| format!("  {line}\n"));
        format!("  {}\n{}", self.name, indented.collect::<String>())
    }
}

impl Inspection {
    /// Everything as JSON; `file` and `kind` are always there.
    pub fn json(&self) -> Value {
        let (kind, mut object) = match &self.content {
            Content::Uff(records) => {
                let records: Vec<_> = records.iter().map(|record| record.json(&self.file)).collect();
                ("uff", json!({"records": records}))
            }
            Content::Matrix(facts) => (matrix::kind_word(facts.kind), facts.json()),
            Content::Matrices(kind, all) => {
                let all: Vec<_> = all.iter().map(NamedFacts::json).collect();
                (matrix::kind_word(*kind), json!({"matrices": all}))
            }
            Content::Table(facts) => ("csv", facts.json(&self.file)),
            Content::Lvm(facts) => ("lvm", facts.json()),
        };
        object["file"] = json!(self.file.to_string_lossy());
        object["kind"] = json!(kind);
        object
    }

    /// A few lines for a person, each ended by a line feed.
    pub fn text(&self) -> String {
        let (heading, lines) = match &self.content {
            Content::Uff(records) => (uff::heading(records), uff::lines(records, &self.file)),
            Content::Matrix(facts) => (facts.kind.to_string(), facts.lines("")),
            Content::Matrices(kind, all) => {
                (kind.to_string(), all.iter().map(NamedFacts::lines).collect::<String>())
            }
            Content::Lvm(facts) => (FileKind::Lvm.to_string(), facts.lines()),
            Content::Table(facts) => (FileKind::Csv.to_string(), facts.lines(&self.file)),
        };
        format!("{}: {heading}\n{lines}", self.file.display())
    }
}

/// The error about a file of no known kind: UFF and matrices were expected, and others.
pub(crate) fn unknown_kind(path: &Path, bytes: &[u8], others: &str) -> InputError {
    let expected = format!("a UFF file, matrices ({MATRIX_FORMATS}), {others}");
    let found = match bytes {
        [] => "an empty file",
        _ => {
            "none of them (no %%MatrixMarket or -1 at the top, no matrix type in line 3, no names of columns)"
        }
    };
    InputError::at(&Place::file(path), expected, found)
}
