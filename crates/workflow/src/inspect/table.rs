//! A table, and what it can serve as.

use super::text::aligned;
use crate::error::InputError;
use crate::terminal::short;
use frfit_formats::FormatError;
use frfit_formats::csv::{self, Table};
use serde_json::{Value, json};
use std::path::Path;

/// What a table can serve as in a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableUse {
    /// A frequency response function.
    Frf,
    /// A load by rows.
    Vector,
    /// Names of rows.
    Dofs,
    /// A modulus over frequency.
    Modulus,
}

impl TableUse {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Frf, Self::Vector, Self::Dofs, Self::Modulus];

    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frf => "frf",
            Self::Vector => "vector",
            Self::Dofs => "dofs",
            Self::Modulus => "modulus",
        }
    }

    /// What it is, and where a case names it.
    fn place(self) -> &'static str {
        match self {
            Self::Frf => "an FRF (file of a [[measurement]])",
            Self::Vector => "a load (file of [load])",
            Self::Dofs => "names of rows (file of [dofs])",
            Self::Modulus => "a modulus over frequency (table of a factor)",
        }
    }

    /// First and last frequency, where there are any, of the table read for this use.
    fn range_hz(self, bytes: &[u8]) -> Result<Option<[f64; 2]>, FormatError> {
        let ends = |frequency_hz: Vec<f64>| Some([*frequency_hz.first()?, *frequency_hz.last()?]);
        Ok(match self {
            Self::Frf => ends(csv::read_frf(bytes)?.frequency_hz),
            Self::Vector => csv::read_vector(bytes).map(|_| None)?,
            Self::Dofs => csv::read_dof_names(bytes).map(|_| None)?,
            Self::Modulus => ends(csv::read_modulus(bytes)?.frequency_hz),
        })
    }
}

/// A table in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct TableFacts {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Number of rows below the names.
    pub rows: usize,
    /// What it can serve as.
    pub uses: Vec<TableUse>,
    /// First and last frequency in hertz, where it can serve as something over frequency.
    pub range_hz: Option<[f64; 2]>,
    /// Why it can serve as nothing else.
    pub refusals: Vec<(TableUse, FormatError)>,
}

impl TableFacts {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let table = Table::read(bytes)?;
        let columns = table.names().map(str::to_owned).collect();
        let mut facts =
            Self { columns, rows: table.rows(), uses: Vec::new(), range_hz: None, refusals: Vec::new() };
        drop(table);
        for wanted in TableUse::ALL {
            match wanted.range_hz(bytes) {
                Ok(range_hz) => {
                    facts.uses.push(wanted);
                    facts.range_hz = facts.range_hz.or(range_hz);
                }
                Err(error) => facts.refusals.push((wanted, error)),
            }
        }
        Ok(facts)
    }

    pub(super) fn json(&self, file: &Path) -> Value {
        let refusals = self.refusals.iter().map(|(wanted, error)| {
            (wanted.name().to_owned(), json!(InputError::in_file(file, error.clone()).to_string()))
        });
        json!({
            "columns": self.columns,
            "rows": self.rows,
            "serves_as": self.uses.iter().map(|wanted| wanted.name()).collect::<Vec<_>>(),
            "range_hz": self.range_hz,
            "refused_as": Value::Object(refusals.collect()),
        })
    }

    /// The reasons why a table has no use are given only where it has none.
    pub(super) fn lines(&self, file: &Path) -> String {
        const MAX_SHOWN: usize = 8;
        let rest = if self.columns.len() > MAX_SHOWN { ", ..." } else { "" };
        let named = &self.columns[..self.columns.len().min(MAX_SHOWN)];
        let mut lines = vec![
            ("columns", format!("{} ({}{rest})", self.columns.len(), named.join(", "))),
            ("rows", self.rows.to_string()),
        ];
        if let Some([first, last]) = self.range_hz {
            lines.push(("range", format!("{} to {} Hz", short(first), short(last))));
        }
        lines.extend(self.uses.iter().map(|wanted| ("use", wanted.place().to_owned())));
        if self.uses.is_empty() {
            lines.push(("use", "none".to_owned()));
            lines.extend(self.refusals.iter().map(|(wanted, error)| {
                let error = InputError::in_file(file, error.clone());
                ("", format!("not {}: {error}", wanted.place()))
            }));
        }
        aligned(&lines)
    }
}
