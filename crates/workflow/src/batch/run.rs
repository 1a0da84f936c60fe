//! Doing what is missing.

use super::key::keys;
use super::plan::Plan;
use super::slurm::Shard;
use super::store::Store;
use crate::job::{JobError, Pictures, compute, result_files};
use crate::load::{Overrides, SharedModels, load_edited};
use crate::output::{File, check_folder};
use crate::run::{Progress, RunOptions, STACK_BYTES};
use rayon::ThreadPoolBuilder;
use serde_json::json;
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

/// What is done of a plan, and how.
#[derive(Debug, Clone, Default)]
pub struct BatchOptions {
    /// Which rows.
    pub shard: Shard,
    /// Runs at a time, each on one thread. `None`: as many as there are cores.
    pub jobs: Option<usize>,
    /// Which runs are done again.
    pub retry: Retry,
    /// A reduced model that was trained already, for all runs.
    pub reduced: Option<PathBuf>,
    /// Bytes of memory that a run may use. `None`: what the system says is available.
    pub memory_bytes: Option<u64>,
}

/// Which runs are done again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Retry {
    /// None.
    #[default]
    Nothing,
    /// Those that failed.
    Failed,
}

/// What was done of a plan.
#[derive(Debug)]
pub struct BatchRun {
    /// Rows of the plan's share.
    pub rows: usize,
    /// Runs that were there already.
    pub kept: usize,
    /// Runs that were done.
    pub done: usize,
    /// Runs that failed before and were not tried again.
    pub left_failed: usize,
    /// Rows (from 1) of runs that failed, and why.
    pub failed: Vec<(usize, String)>,
    /// How long it took.
    pub seconds: f64,
}

/// Does the runs of a plan that are missing in a store. The results of a run do not depend on the others, on their number at a time, or on the share it is in.
///
/// # Errors
/// A store that cannot be written, which ends the batch. A run that fails is one of [`BatchRun::failed`], and the next one is done.
pub fn run_batch(
    plan: &Plan,
    store: &Path,
    options: &BatchOptions,
    progress: Progress<'_>,
) -> Result<BatchRun, JobError> {
    let start = Instant::now();
    check_folder(store, &[], &plan.reads)?;
    let keys = keys(plan, &[("reduced", options.reduced.as_deref())])?;
    let store = Store::at(store);
    store.create()?;
    let (there, failed_before) = (store.done()?, store.failed()?);
    let mut run = BatchRun { rows: 0, kept: 0, done: 0, left_failed: 0, failed: Vec::new(), seconds: 0.0 };
    let (mut missing, mut taken) = (Vec::new(), HashSet::new());
    for row in (0..plan.rows()).filter(|&row| options.shard.has(row)) {
        run.rows += 1;
        if there.contains(&keys[row]) {
            run.kept += 1;
        } else if options.retry == Retry::Nothing && failed_before.contains(&keys[row]) {
            run.left_failed += 1;
        } else if taken.insert(&keys[row]) {
            missing.push(row);
        } else {
            run.kept += 1;
        }
    }
    let batch = Batch { plan, keys: &keys, store: &store, options, shared: SharedModels::default() };
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let (failed, ended) = (Mutex::new(Vec::new()), Mutex::new(None));
    let work = || {
        while let Some(&row) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
            match batch.carry_out(row) {
                Ok(None) => {}
                Ok(Some(reason)) => lock(&failed).push((row + 1, reason)),
                Err(error) => {
                    next.store(missing.len(), Ordering::Relaxed);
                    lock(&ended).get_or_insert(error);
                    return;
                }
            }
            progress(1 + done.fetch_add(1, Ordering::Relaxed), missing.len());
        }
    };
    progress(0, missing.len());
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let jobs = options.jobs.unwrap_or(cores).clamp(1, missing.len().max(1));
    // A run is small beside the batch: each has a thread of its own, and all of its parts are done on that.
    let alone = || match ThreadPoolBuilder::new().num_threads(1).stack_size(STACK_BYTES).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    };
    let cancelled = thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(alone)).collect();
        let ends: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
        ends.into_iter().find_map(Result::err)
    });
    if let Some(payload) = cancelled {
        // Who cancels unwinds from `progress`.
        resume_unwind(payload);
    }
    if let Some(error) = lock(&ended).take() {
        return Err(error);
    }
    run.failed = std::mem::take(&mut lock(&failed));
    run.failed.sort_unstable();
    run.done = missing.len() - run.failed.len();
    run.seconds = start.elapsed().as_secs_f64();
    Ok(run)
}

struct Batch<'a> {
    plan: &'a Plan,
    keys: &'a [String],
    store: &'a Store,
    options: &'a BatchOptions,
    shared: SharedModels,
}

impl Batch<'_> {
    /// Does a run; the reason where it failed.
    fn carry_out(&self, row: usize) -> Result<Option<String>, JobError> {
        let key = &self.keys[row];
        let reason = match catch_unwind(AssertUnwindSafe(|| self.files(row))) {
            Ok(Ok(files)) => return self.store.put(key, &files).map(|()| None).map_err(JobError::from),
            Ok(Err(error)) => error.to_string(),
            Err(_) => "internal error".to_owned(),
        };
        let mut failure = self.plan.json(row, key);
        failure["error"] = json!(reason);
        self.store.fail(key, &failure)?;
        Ok(Some(reason))
    }

    /// The results of a run, and its row.
    fn files(&self, row: usize) -> Result<Vec<File>, JobError> {
        let start = Instant::now();
        let overrides = Overrides { reduced: self.options.reduced.clone(), ..Overrides::default() };
        let case_file = self.plan.case(row)?;
        let text = |bytes: &[u8]| self.plan.text(row, bytes);
        let case = load_edited(&case_file, text, &overrides, &self.shared)?;
        let options =
            RunOptions { error_map: Some(0), memory_bytes: self.options.memory_bytes, keep_reduced: None };
        let computed = compute(case, options, start.elapsed().as_secs_f64(), &|_, _| {})?;
        let (mut files, _) = result_files(&computed, Pictures::default(), &case_file)?;
        let plan = self.plan.json(row, &self.keys[row]);
        files.push(File::new("plan.json", format!("{plan:#}\n")));
        Ok(files)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
