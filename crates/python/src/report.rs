//! The results of an identification as one HTML page.

use crate::background::at_once;
use crate::errors::job;
use frfit_workflow::Reads;
use frfit_workflow::job::JobError;
use frfit_workflow::report::report_of_folder;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The page that `frfit report FOLDER` writes.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    let page = at_once(py, || report_of_folder(&folder, &mut Reads::default()))?
        .map_err(|error| job(py, &JobError::Input(error)))?;
    // It is made of strings.
    Ok(String::from_utf8_lossy(&page.bytes).into_owned())
}
