//! Trained models and batches, as `frfit train` and `frfit batch` make them.

use crate::background::in_background;
use crate::errors::{input, job};
use frfit_workflow::batch::{
    BatchOptions, Detail, Plan, Retry, Shard, batch_status as status_of, collect, run_batch,
};
use frfit_workflow::job::{JobError, train_case};
use frfit_workflow::load::Overrides;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Trains the reduced model of a case; vectors, factorisations, solves, bytes and seconds.
#[pyfunction]
pub(crate) fn train<'py>(
    py: Python<'py>,
    path: PathBuf,
    out: PathBuf,
    band_hz: Option<[f64; 2]>,
    reduced: Option<PathBuf>,
    memory_bytes: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides = Overrides { band_hz, reduced, ..Overrides::default() };
    let done = in_background(py, None, move |_| train_case(&path, &overrides, memory_bytes, &out))?
        .map_err(|error| job(py, &error))?;
    let found = PyDict::new(py);
    found.set_item("vectors", done.vectors)?;
    found.set_item("factorisations", done.work.factorisations)?;
    found.set_item("solves", done.work.solves)?;
    found.set_item("bytes", done.bytes)?;
    found.set_item("seconds", done.seconds)?;
    Ok(found)
}

/// Does what is missing of a plan; counts, and row and reason of each run that failed.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the command line")]
pub(crate) fn batch<'py>(
    py: Python<'py>,
    plan: PathBuf,
    out: PathBuf,
    reduced: Option<PathBuf>,
    shard: (usize, usize),
    jobs: Option<usize>,
    retry_failed: bool,
    memory_bytes: Option<u64>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = BatchOptions {
        shard: Shard { index: shard.0, count: shard.1 },
        jobs,
        retry: if retry_failed { Retry::Failed } else { Retry::Nothing },
        reduced,
        memory_bytes,
    };
    let done = in_background(py, progress, move |watch| {
        let plan = Plan::read(&plan)?;
        run_batch(&plan, &out, &options, &|done, total| watch.progress(done, total))
    })?
    .map_err(|error: JobError| job(py, &error))?;
    let found = PyDict::new(py);
    found.set_item("rows", done.rows)?;
    found.set_item("kept", done.kept)?;
    found.set_item("done", done.done)?;
    found.set_item("left_failed", done.left_failed)?;
    found.set_item("failed", done.failed)?;
    found.set_item("seconds", done.seconds)?;
    Ok(found)
}

/// Rows, runs that are done, and runs that failed.
#[pyfunction]
pub(crate) fn batch_status(
    py: Python<'_>,
    plan: PathBuf,
    out: PathBuf,
    reduced: Option<PathBuf>,
) -> PyResult<(usize, usize, usize)> {
    let status = py.detach(|| Plan::read(&plan).and_then(|plan| status_of(&plan, &out, reduced.as_deref())));
    let status = status.map_err(|error| input(py, &error))?;
    Ok((status.rows, status.done, status.failed))
}

/// The table of all runs, as text.
#[pyfunction]
pub(crate) fn batch_table(py: Python<'_>, store: PathBuf, lines: bool) -> PyResult<String> {
    let detail = if lines { Detail::Lines } else { Detail::Runs };
    let table = py.detach(|| collect(&store, detail)).map_err(|error| input(py, &error))?;
    Ok(table.csv)
}
