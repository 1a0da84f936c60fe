//! The table of runs.

use crate::case::{Edit, edited};
use crate::error::{InputError, Place};
use crate::load::load_bytes;
use crate::reads::Reads;
use frfit_formats::csv::Table;
use frfit_formats::{FormatError, Position};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The column that names the case of a run.
const CASE: &str = "case";

/// A table of runs: each row names a case and its changes.
///
/// The column `case` is the path of a case file from where the plan is. A column whose name has a dot is the path of a key of the case, such as `measurement.file`,
/// `measurement.2.file`, `matrix.core.factor.storage` or `identify.bounds.storage`: a cell is the value of the key, and an empty cell leaves the value of the case. All other columns are
/// labels of the run, such as a specimen or a temperature.
#[derive(Debug)]
pub struct Plan {
    pub(super) file: PathBuf,
    folder: PathBuf,
    table: Table,
    case: usize,
    /// Its columns but for that of the case, and whether each is a key.
    pub(super) columns: Vec<(usize, bool)>,
    pub(super) reads: Reads,
}

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// A file that is no table, has no column `case`, no row, or two columns of one name.
    pub fn read(file: &Path) -> Result<Self, InputError> {
        let mut reads = Reads::default();
        let bytes = load_bytes(file, &mut reads)?;
        let in_file = |error: FormatError| InputError::in_file(file, error);
        let table = Table::read(&bytes).map_err(in_file)?;
        let names: Vec<&str> = table.names().collect();
        let twice = names.iter().enumerate().find(|(k, name)| names[..*k].contains(name));
        if let Some((_, name)) = twice {
            return Err(in_file(FormatError::line(
                1,
                "columns with names of their own",
                format!("two named {name:?}"),
            )));
        }
        let case = names.iter().position(|name| *name == CASE);
        let expected = format!("a column {CASE:?} with the path of a case file");
        let case = case.ok_or_else(|| in_file(FormatError::line(1, expected, names.join(", "))))?;
        if table.rows() == 0 {
            return Err(in_file(FormatError::whole("a row for each run", "none")));
        }
        let others = names.iter().enumerate().filter(|(k, _)| *k != case);
        let columns = others.map(|(k, name)| (k, name.contains('.'))).collect();
        let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
        Ok(Self { file: file.to_path_buf(), folder, table, case, columns, reads })
    }

    /// How many runs.
    pub fn rows(&self) -> usize {
        self.table.rows()
    }

    /// The case file of a run.
    pub(super) fn case(&self, row: usize) -> Result<PathBuf, InputError> {
        match self.table.text(row, self.case) {
            "" => Err(InputError::in_file(
                &self.file,
                self.table.error(row, self.case, "the path of a case", "none"),
            )),
            path => Ok(self.folder.join(path)),
        }
    }

    /// Name and cell of each column but for that of the case.
    pub(super) fn cells(&self, row: usize) -> impl Iterator<Item = (&str, &str)> {
        self.columns.iter().map(move |&(column, _)| (self.name(column), self.table.text(row, column)))
    }

    /// The changes in the case of a run.
    pub(super) fn edits(&self, row: usize) -> impl Iterator<Item = Edit<'_>> {
        let keys = self.columns.iter().filter(|(_, is_key)| *is_key);
        let edits = keys
            .map(move |&(column, _)| Edit { key: self.name(column), value: self.table.text(row, column) });
        edits.filter(|edit| !edit.value.is_empty())
    }

    /// The text of the case of a run.
    ///
    /// # Errors
    /// A path of keys that leads nowhere, with the cell.
    pub(super) fn text(&self, row: usize, bytes: &[u8]) -> Result<String, InputError> {
        let edits: Vec<Edit<'_>> = self.edits(row).collect();
        let text = String::from_utf8_lossy(bytes);
        edited(&text, &edits).map_err(|error| {
            let line = self.table.line(row);
            let key = Some(edits[error.edit].key.to_owned());
            let place =
                Place { file: Some(self.file.clone()), position: Position::Line { line, column: None }, key };
            InputError::at(&place, error.expected, error.found)
        })
    }

    /// The row as it is kept beside its results.
    pub(super) fn json(&self, row: usize, key: &str) -> Value {
        let cells: Vec<Value> = self.cells(row).map(|(name, cell)| json!([name, cell])).collect();
        json!({"row": row + 1, "run": key, "case": self.table.text(row, self.case), "cells": cells})
    }

    fn name(&self, column: usize) -> &str {
        self.table.names().nth(column).unwrap_or_default()
    }
}
