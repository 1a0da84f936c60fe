//! Case files, as the command line runs them.

use crate::background::in_background;
use crate::columns::identification;
use crate::errors::job;
use frfit_workflow::job::{Computed, IdentifyJob, compute_case, identify_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// What `frfit.Identification` is made of; with `out` the files of `frfit identify` too.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the command line")]
pub(crate) fn run_case<'py>(
    py: Python<'py>,
    path: PathBuf,
    out: Option<PathBuf>,
    method: Option<String>,
    order: Option<usize>,
    band_hz: Option<[f64; 2]>,
    selection: Option<String>,
    reduction: Option<String>,
    reduced: Option<PathBuf>,
    keep_reduced: Option<PathBuf>,
    memory_bytes: Option<u64>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides =
        Overrides { method, order, band_hz, selection, reduction, reduced, ..Overrides::default() };
    let error_map = if out.is_some() { None } else { Some(0) };
    let options = RunOptions { error_map, memory_bytes, keep_reduced };
    let ran = in_background(py, progress, move |watch| {
        let progress = |done: usize, total: usize| watch.progress(done, total);
        let computed = match out {
            None => compute_case(&path, &overrides, options, &progress)?,
            Some(out) => {
                let job = identify_case(&path, &overrides, options, &out, &progress)?;
                let IdentifyJob { case, diagnosis, run, .. } = job;
                Computed { case, diagnosis, run }
            }
        };
        Ok(computed)
    })?;
    let computed = ran.map_err(|error| job(py, &error))?;
    identification(py, &computed)
}
