//! Tables with columns of each unknown.

use crate::load::IdentifyCase;
use frfit_formats::csv::{Cell, write};

/// These parts of each unknown, one unknown after the other.
pub(super) fn named(identify: &IdentifyCase, parts: &[&str]) -> Vec<String> {
    let of_one = |j: usize| parts.iter().map(move |part| format!("{}{part}", identify.prefix(j)));
    (0..identify.unknowns.len()).flat_map(of_one).collect()
}

/// A table of rows that have these columns.
pub(super) fn table<'a>(columns: &[String], rows: impl Iterator<Item = Vec<Cell<'a>>>) -> String {
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    write(&columns, rows).expect("every row has the columns, and no name a line break")
}
