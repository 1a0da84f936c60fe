//! One table of all runs of a store.

use super::store::Store;
use crate::error::{InputError, Place};
use frfit_formats::FormatError;
use frfit_formats::csv::{Cell, Table, write};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;
use std::time::SystemTime;

/// What a row of the table is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// A run: its verdict, how many lines are `ok`, and the median over these of every number in `identified.csv`.
    Runs,
    /// A line of `identified.csv` of a run.
    Lines,
}

/// A table of all runs.
#[derive(Debug)]
pub struct Collected {
    /// The table: `run`, `case`, the columns of the plan, then those of the results.
    pub csv: String,
    /// Runs in it.
    pub runs: usize,
    /// Runs that failed, which a table of runs has with the reason in the column `error`.
    pub failed: usize,
}

/// A run as it is found.
struct Run {
    row: u64,
    /// When its results were written.
    written: SystemTime,
    is_failure: bool,
    /// Names and texts that are the same for all of its lines.
    labels: Vec<(String, String)>,
    /// Names of the columns of its results.
    names: Vec<String>,
    lines: Vec<Vec<String>>,
}

const STATUS: &str = "status";
const FREQUENCY: &str = "frequency_hz";

/// Makes one table of all runs in a store, in the order of their plan; where a row was done more than once, since a file of it changed, the last counts.
///
/// # Errors
/// A store that cannot be read, or that has no runs; a run without its files.
pub fn collect(store_folder: &Path, detail: Detail) -> Result<Collected, InputError> {
    let store = Store::at(store_folder);
    let (done, failed) = (store.done()?, store.failed()?);
    if done.is_empty() && failed.is_empty() {
        return Err(InputError::at(&Place::file(store_folder), "a store with runs of frfit batch", "none"));
    }
    let mut done: Vec<String> = done.into_iter().collect();
    done.sort_unstable();
    let mut runs =
        done.par_iter().map(|key| of_run(&store.run(key), detail)).collect::<Result<Vec<Run>, _>>()?;
    let mut reasons: Vec<String> = failed.into_iter().collect();
    reasons.sort_unstable();
    for key in &reasons {
        runs.push(of_failure(&store.failure(key))?);
    }
    let mut runs = latest(runs);
    let failed = runs.iter().filter(|run| run.is_failure).count();
    let done = runs.len() - failed;
    runs.retain(|run| detail == Detail::Runs || !run.is_failure);
    runs.sort_by(|a, b| (a.row, &a.labels).cmp(&(b.row, &b.labels)));
    let (labels, names) =
        (union(runs.iter().map(label_names)), union(runs.iter().map(|run| run.names.clone())));
    let columns: Vec<&str> = labels.iter().chain(&names).map(String::as_str).collect();
    let row = |run: &Run, line: &[String]| -> Vec<String> {
        let label =
            |name: &String| run.labels.iter().find(|(own, _)| own == name).map(|(_, text)| text.clone());
        let value = |name: &String| run.names.iter().position(|own| own == name).map(|k| line[k].clone());
        labels.iter().map(label).chain(names.iter().map(value)).map(Option::unwrap_or_default).collect()
    };
    let texts: Vec<Vec<String>> = runs
        .par_iter()
        .flat_map_iter(|run| run.lines.iter().map(|line| row(run, line)).collect::<Vec<_>>())
        .collect();
    let cells = texts.iter().map(|row| row.iter().map(|text| cell(text)).collect::<Vec<Cell<'_>>>());
    let csv = write(&columns, cells).map_err(|error| InputError::in_file(store_folder, error))?;
    Ok(Collected { csv, runs: done, failed })
}

/// Of runs of the same row with other contents of its files, another version or another reduced model the last.
fn latest(runs: Vec<Run>) -> Vec<Run> {
    let mut last: HashMap<Vec<(String, String)>, Run> = HashMap::new();
    for run in runs {
        // All but the key.
        let row = run.labels[1..].to_vec();
        if last.get(&row).is_none_or(|before| before.written < run.written) {
            last.insert(row, run);
        }
    }
    last.into_values().collect()
}

fn written(file: &Path) -> SystemTime {
    std::fs::metadata(file).and_then(|of| of.modified()).unwrap_or(SystemTime::UNIX_EPOCH)
}

fn cell(text: &str) -> Cell<'_> {
    if text.is_empty() { Cell::Empty } else { Cell::Text(text) }
}

fn label_names(run: &Run) -> Vec<String> {
    run.labels.iter().map(|(name, _)| name.clone()).collect()
}

/// All names, in the order in which they are met.
fn union(all: impl Iterator<Item = Vec<String>>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in all.flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn of_run(folder: &Path, detail: Detail) -> Result<Run, InputError> {
    let plan = json(&folder.join("plan.json"))?;
    let file = folder.join("identified.csv");
    let bytes = std::fs::read(&file).map_err(|error| missing(&file, &error))?;
    let table = Table::read(&bytes).map_err(|error| InputError::in_file(&file, error))?;
    let own: Vec<String> = table.names().map(str::to_owned).collect();
    let (names, lines) = match detail {
        Detail::Lines => {
            let line = |row: usize| (0..own.len()).map(|column| table.text(row, column).to_owned()).collect();
            (own.clone(), (0..table.rows()).map(line).collect())
        }
        Detail::Runs => {
            let summary = json(&folder.join("summary.json"))?;
            let in_file = |error: FormatError| InputError::in_file(&file, error);
            let status = own.iter().position(|name| name == STATUS);
            let is_ok = |row: &usize| status.is_some_and(|column| table.text(*row, column) == "ok");
            let ok: Vec<usize> = (0..table.rows()).filter(is_ok).collect();
            let mut names = vec!["verdict".to_owned(), "trusted".into(), "lines".into(), "ok".into()];
            let verdict = summary["fit"]["verdict"].as_str().unwrap_or_default().to_owned();
            let trusted = summary["trusted"].as_bool().map_or(String::new(), |trusted| trusted.to_string());
            let mut line = vec![verdict, trusted, table.rows().to_string(), ok.len().to_string()];
            for (column, name) in
                own.iter().enumerate().filter(|(_, name)| *name != STATUS && *name != FREQUENCY)
            {
                let filled = ok.iter().filter(|&&row| !table.is_empty(row, column));
                let mut values = filled
                    .map(|&row| table.number(row, column))
                    .collect::<Result<Vec<f64>, _>>()
                    .map_err(in_file)?;
                names.push(name.clone());
                line.push(median(&mut values).map_or(String::new(), |value| value.to_string()));
            }
            names.push("error".into());
            line.push(String::new());
            (names, vec![line])
        }
    };
    Ok(Run {
        written: written(&file),
        is_failure: false,
        row: plan["row"].as_u64().unwrap_or(u64::MAX),
        labels: labels(&plan),
        names,
        lines,
    })
}

fn of_failure(file: &Path) -> Result<Run, InputError> {
    let failure = json(file)?;
    let text = failure["error"].as_str().unwrap_or_default().replace(['\n', '\r'], " ");
    Ok(Run {
        written: written(file),
        is_failure: true,
        row: failure["row"].as_u64().unwrap_or(u64::MAX),
        labels: labels(&failure),
        names: vec!["verdict".into(), "error".into()],
        lines: vec![vec!["failed".into(), text]],
    })
}

/// `run`, `case` and the columns of the plan.
fn labels(plan: &Value) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let cells = plan["cells"].as_array().map_or(&[][..], Vec::as_slice);
    let own = ["run", "case"].into_iter().map(|name| (name.to_owned(), text(&plan[name])));
    own.chain(cells.iter().map(|cell| (text(&cell[0]), text(&cell[1])))).collect()
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    Some(0.5 * (values.get(n.checked_sub(1)? / 2)? + values.get(n / 2)?))
}

fn json(file: &Path) -> Result<Value, InputError> {
    let bytes = std::fs::read(file).map_err(|error| missing(file, &error))?;
    let refuse = |error: serde_json::Error| {
        InputError::at(&Place::file(file), "JSON of frfit batch", error.to_string())
    };
    serde_json::from_slice(&bytes).map_err(refuse)
}

fn missing(file: &Path, error: &std::io::Error) -> InputError {
    InputError::at(&Place::file(file), "a file of a run of frfit batch", error.to_string())
}
