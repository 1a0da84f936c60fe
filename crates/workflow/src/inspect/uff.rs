//! The datasets of a UFF file, one line each.

use super::function;
use super::text::count;
use crate::error::InputError;
use crate::terminal::short;
use frfit_formats::uff::{File, FileHeader, FunctionSummary, FunctionType, Record, Units};
use frfit_formats::{FileKind, FormatError};
use serde_json::{Value, json};
use std::path::Path;

/// A dataset in a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct UffRecord {
    /// Number of the dataset.
    pub dataset: u32,
    /// Whether its data are binary.
    pub binary: bool,
    /// Line of the opening `-1`, from 1.
    pub line: usize,
    /// Its contents, or why it cannot be read.
    pub content: Result<UffContent, FormatError>,
}

/// What is in a dataset.
#[derive(Debug, Clone, PartialEq)]
pub enum UffContent {
    /// 58: what the header says.
    Function {
        /// Its number among the FRFs of the file, from 1, as `record` of a case counts them; `None` of another function.
        record: Option<usize>,
        /// What it is a function of what.
        summary: Box<FunctionSummary>,
    },
    /// 15, 2411: how many nodes.
    Nodes(usize),
    /// 82.
    TraceLine {
        /// Its name.
        name: String,
        /// How many nodes it visits.
        nodes: usize,
    },
    /// 151.
    FileHeader(Box<FileHeader>),
    /// 164.
    Units(Box<Units>),
    /// Any other: how many bytes.
    Other(usize),
}

/// All datasets of a file.
pub(super) fn records(bytes: &[u8]) -> Result<Vec<UffRecord>, FormatError> {
    let file = File::new(bytes)?;
    let mut frfs = 0;
    let record = |index| {
        let content = content(&file, index, &mut frfs);
        let entry = &file.entries()[index];
        UffRecord { dataset: entry.dataset, binary: entry.is_binary(), line: entry.line, content }
    };
    Ok((0..file.entries().len()).map(record).collect())
}

fn content(file: &File<'_>, index: usize, frfs: &mut usize) -> Result<UffContent, FormatError> {
    if let Some(summary) = file.summary(index)?.function {
        let is_frf = summary.function_type == FunctionType::FrequencyResponse.name();
        *frfs += usize::from(is_frf);
        return Ok(UffContent::Function { record: is_frf.then_some(*frfs), summary: Box::new(summary) });
    }
    Ok(match file.record(index)? {
        Record::Nodes(nodes) => UffContent::Nodes(nodes.len()),
        Record::TraceLine(line) => UffContent::TraceLine { nodes: line.nodes.len(), name: line.name },
        Record::FileHeader(header) => UffContent::FileHeader(header),
        Record::Units(units) => UffContent::Units(units),
        Record::Function(_) => UffContent::Other(file.entries()[index].bytes.len()),
        Record::Other { bytes, .. } => UffContent::Other(bytes.len()),
    })
}

pub(super) fn heading(records: &[UffRecord]) -> String {
    let is_frf =
        |record: &&UffRecord| matches!(record.content, Ok(UffContent::Function { record: Some(_), .. }));
    let frfs = records.iter().filter(is_frf).count();
    format!("{}, {}, {}", FileKind::Uff, count(records.len(), "dataset"), count(frfs, "FRF"))
}

/// Line, number and content of each dataset.
pub(super) fn lines(records: &[UffRecord], file: &Path) -> String {
    let number = |record: &UffRecord| format!("{}{}", record.dataset, if record.binary { "b" } else { "" });
    let width = |length: fn(&str) -> usize, column: &dyn Fn(&UffRecord) -> String| {
        records.iter().map(|record| length(&column(record))).max().unwrap_or(0)
    };
    let places = width(str::len, &|record| record.line.to_string());
    let numbers = width(str::len, &number);
    let line = |record: &UffRecord| {
        let words = match &record.content {
            Ok(content) => content.words(),
            Err(error) => format!("broken: {}", InputError::in_file(file, error.clone())),
        };
        format!("  line {:>places$}  {:<numbers$}  {words}\n", record.line, number(record))
    };
    records.iter().map(line).collect()
}

impl UffRecord {
    pub(super) fn json(&self, file: &Path) -> Value {
        let mut object = match &self.content {
            Ok(content) => content.json(),
            Err(error) => json!({"error": InputError::in_file(file, error.clone()).to_string()}),
        };
        object["dataset"] = json!(self.dataset);
        object["binary"] = json!(self.binary);
        object["line"] = json!(self.line);
        object
    }
}

impl UffContent {
    fn words(&self) -> String {
        match self {
            Self::Function { record, summary } => function::words(*record, summary),
            Self::Nodes(nodes) => count(*nodes, "node"),
            Self::TraceLine { name, nodes } => format!("trace line {name:?} over {}", count(*nodes, "node")),
            Self::FileHeader(header) => {
                let said = [&header.model, &header.description, &header.created_by, &header.created];
                let said: Vec<_> = said.into_iter().filter(|text| !text.is_empty()).cloned().collect();
                format!("file header: {}", said.join(", "))
            }
            Self::Units(units) => {
                let Units { description, length, force, .. } = &**units;
                format!(
                    "units {description:?}: {} to the metre, {} to the newton",
                    short(*length),
                    short(*force)
                )
            }
            Self::Other(bytes) => format!("{}, not read", count(*bytes, "byte")),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Function { record, summary } => function::json(*record, summary),
            Self::Nodes(nodes) => json!({"nodes": nodes}),
            Self::TraceLine { name, nodes } => json!({"name": name, "nodes": nodes}),
            Self::FileHeader(header) => json!({
                "model": header.model,
                "description": header.description,
                "created_by": header.created_by,
                "created": header.created,
            }),
            Self::Units(units) => json!({
                "description": units.description,
                "length_factor": units.length,
                "force_factor": units.force,
                "temperature_factor": units.temperature,
            }),
            Self::Other(bytes) => json!({"bytes": bytes}),
        }
    }
}
