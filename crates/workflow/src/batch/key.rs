//! The checksum of everything that a run depends on.

use super::plan::Plan;
use crate::error::InputError;
use crate::load::files_beside;
use crate::output::{hexadecimal, sha256};
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, Value};

/// Of a layout of results that another version would not make.
const LAYOUT: &str = "frfit batch 1";

/// Hexadecimal digits of a key.
const DIGITS: usize = 32;

/// The key of every run of a plan, in its order: a checksum of the row, the case, the contents of every file that either of them names, the
/// options of the batch, and the version of this program.
///
/// # Errors
/// A row without a case.
pub(super) fn keys(plan: &Plan, options: &[(&str, Option<&Path>)]) -> Result<Vec<String>, InputError> {
    let cases: Vec<PathBuf> = (0..plan.rows()).map(|row| plan.case(row)).collect::<Result<_, _>>()?;
    let bases: BTreeSet<&PathBuf> = cases.iter().collect();
    let bases: HashMap<&PathBuf, String> = bases.into_par_iter().map(|case| (case, of_case(case))).collect();
    let named: BTreeSet<PathBuf> = (0..plan.rows()).flat_map(|row| files(plan, row, &cases[row])).collect();
    let sums: HashMap<PathBuf, String> =
        named.into_par_iter().map(|file| (file.clone(), of_file(&file))).collect();
    let mut common = Sha256::new();
    let text = |sum: &mut Sha256, text: &str| {
        sum.update((text.len() as u64).to_le_bytes());
        sum.update(text);
    };
    text(&mut common, LAYOUT);
    text(&mut common, env!("CARGO_PKG_VERSION"));
    for (name, file) in options {
        text(&mut common, name);
        text(&mut common, &file.map_or(String::new(), of_file));
    }
    let key = |row: usize| {
        let mut sum = common.clone();
        text(&mut sum, &bases[&cases[row]]);
        for (name, cell) in plan.cells(row) {
            text(&mut sum, name);
            text(&mut sum, cell);
        }
        for file in files(plan, row, &cases[row]) {
            text(&mut sum, &sums[&file]);
        }
        let mut digits = hexadecimal(&sum.finalize());
        digits.truncate(DIGITS);
        digits
    };
    Ok((0..plan.rows()).into_par_iter().map(key).collect())
}

/// The files that the cells of a row name.
fn files<'a>(plan: &'a Plan, row: usize, case: &'a Path) -> impl Iterator<Item = PathBuf> + 'a {
    let folder = case.parent().unwrap_or(Path::new(""));
    let is_file = |key: &str| key.rsplit('.').next() == Some("file");
    plan.edits(row)
        .filter(move |edit| is_file(edit.key))
        .map(move |edit| folder.join(edit.value.trim_matches('"')))
}

/// A case, and all files that its texts name.
fn of_case(case: &Path) -> String {
    let Ok(bytes) = std::fs::read(case) else { return String::from("none") };
    let mut names = BTreeSet::new();
    if let Some(document) = std::str::from_utf8(&bytes).ok().and_then(|text| text.parse::<DocumentMut>().ok())
    {
        texts(document.as_item(), &mut names);
    }
    let folder = case.parent().unwrap_or(Path::new(""));
    let of = |name: &String| {
        let path = folder.join(name);
        if path.is_file() && path != case { format!("\n{name} {}", of_file(&path)) } else { String::new() }
    };
    let files: Vec<String> = names.par_iter().map(of).collect();
    sha256(&[&bytes[..], files.concat().as_bytes()].concat())
}

/// A file, and what names its rows beside it.
fn of_file(path: &Path) -> String {
    let sum = |path: &Path| std::fs::read(path).map_or(String::from("none"), |bytes| sha256(&bytes));
    files_beside(path).iter().fold(sum(path), |all, beside| all + &sum(beside))
}

fn texts(item: &Item, into: &mut BTreeSet<String>) {
    match item {
        Item::None => {}
        Item::Value(value) => texts_of(value, into),
        Item::Table(table) => table.iter().for_each(|(_, item)| texts(item, into)),
        Item::ArrayOfTables(tables) => {
            tables.iter().flat_map(|table| table.iter()).for_each(|(_, item)| texts(item, into));
        }
    }
}

fn texts_of(value: &Value, into: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => {
            into.insert(text.value().clone());
        }
        Value::Array(values) => values.iter().for_each(|value| texts_of(value, into)),
        Value::InlineTable(table) => table.iter().for_each(|(_, value)| texts_of(value, into)),
        _ => {}
    }
}
