//! The folder of results: a folder for each run, by its key, which is there whole or not at all.

use super::key::keys;
use super::plan::Plan;
use crate::error::{InputError, Place};
use crate::output::File;
use serde_json::Value;
use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Where results, reasons of failures, and results that are being written are.
const RUNS: &str = "runs";
const FAILED: &str = "failed";
const PARTIAL: &str = "partial";

/// How far a batch has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BatchStatus {
    /// Rows of the plan.
    pub rows: usize,
    /// Those that are done.
    pub done: usize,
    /// Those that failed.
    pub failed: usize,
}

impl BatchStatus {
    /// Rows that were not tried yet, or whose run was ended.
    pub fn missing(&self) -> usize {
        self.rows - self.done - self.failed
    }
}

/// How far a batch has come, by the keys of its runs and the names of its files.
///
/// # Errors
/// A store that cannot be read; a plan with a row without a case.
pub fn batch_status(plan: &Plan, store: &Path, reduced: Option<&Path>) -> Result<BatchStatus, InputError> {
    let store = Store::at(store);
    let (done, failed) = (store.done()?, store.failed()?);
    let mut status = BatchStatus { rows: plan.rows(), done: 0, failed: 0 };
    for key in keys(plan, &[("reduced", reduced)])? {
        if done.contains(&key) {
            status.done += 1;
        } else if failed.contains(&key) {
            status.failed += 1;
        }
    }
    Ok(status)
}

/// A folder of results. No process waits for another: what one has finished it renames into place.
#[derive(Debug)]
pub(super) struct Store {
    folder: PathBuf,
}

impl Store {
    pub(super) fn at(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf() }
    }

    /// Makes its folders.
    pub(super) fn create(&self) -> Result<(), InputError> {
        [RUNS, FAILED, PARTIAL].iter().try_for_each(|name| {
            let folder = self.folder.join(name);
            fs::create_dir_all(&folder).map_err(|error| unusable(&folder, &error))
        })
    }

    /// The keys of the runs that are done.
    pub(super) fn done(&self) -> Result<HashSet<String>, InputError> {
        self.names(RUNS, "")
    }

    /// The keys of the runs that failed.
    pub(super) fn failed(&self) -> Result<HashSet<String>, InputError> {
        self.names(FAILED, ".json")
    }

    /// The folder of a run.
    pub(super) fn run(&self, key: &str) -> PathBuf {
        self.folder.join(RUNS).join(key)
    }

    /// Why a run failed.
    pub(super) fn failure(&self, key: &str) -> PathBuf {
        self.folder.join(FAILED).join(format!("{key}.json"))
    }

    /// Puts the results of a run in place. What a killed process left of the same run is removed; where another process was faster, its results stay.
    pub(super) fn put(&self, key: &str, files: &[File]) -> Result<(), InputError> {
        let partial = self.clear(key)?;
        let written = files.iter().try_for_each(|file| {
            let path = partial.join(&file.path);
            fs::create_dir_all(path.parent().unwrap_or(&partial))?;
            fs::write(path, &file.bytes)
        });
        written.map_err(|error| unusable(&partial, &error))?;
        let run = self.run(key);
        if let Err(error) = fs::rename(&partial, &run) {
            if !run.is_dir() {
                return Err(unusable(&run, &error));
            }
            // Left behind, it does no harm.
            let _ = fs::remove_dir_all(&partial);
        }
        let _ = fs::remove_file(self.failure(key));
        Ok(())
    }

    /// Says why a run failed.
    pub(super) fn fail(&self, key: &str, reason: &Value) -> Result<(), InputError> {
        let partial = self.clear(key)?;
        let (written, place) = (partial.join("failure"), self.failure(key));
        let done = fs::create_dir_all(&partial)
            .and_then(|()| fs::write(&written, format!("{reason:#}\n")))
            .and_then(|()| fs::rename(&written, &place));
        let _ = fs::remove_dir_all(&partial);
        done.map_err(|error| unusable(&place, &error))
    }

    /// Where a run is written before it is in place; nothing is there.
    fn clear(&self, key: &str) -> Result<PathBuf, InputError> {
        let folder = self.folder.join(PARTIAL);
        let is_of_run = |name: &str| name.split('-').next() == Some(key);
        for entry in fs::read_dir(&folder).map_err(|error| unusable(&folder, &error))?.flatten() {
            if is_of_run(&entry.file_name().to_string_lossy()) {
                fs::remove_dir_all(entry.path()).map_err(|error| unusable(&entry.path(), &error))?;
            }
        }
        Ok(folder.join(format!("{key}-{}", std::process::id())))
    }

    fn names(&self, folder: &str, ending: &str) -> Result<HashSet<String>, InputError> {
        let folder = self.folder.join(folder);
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(HashSet::new()),
            Err(error) => return Err(unusable(&folder, &error)),
        };
        let name = |entry: fs::DirEntry| entry.file_name().to_str()?.strip_suffix(ending).map(str::to_owned);
        Ok(entries.flatten().filter_map(name).collect())
    }
}

fn unusable(path: &Path, error: &io::Error) -> InputError {
    InputError::at(&Place::file(path), "a folder of results that can be read and written", error.to_string())
}
