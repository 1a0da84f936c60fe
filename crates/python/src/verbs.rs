//! The other verbs of the command line: each returns the text that `--json` prints there, so that no number is another.

use crate::background::{at_once, in_background};
use crate::columns::{findings, other_explanations, table};
use crate::errors::{input, job, raise};
use crate::identify::{Measured, Options as ArrayOptions, case_of};
use crate::law::Law;
use crate::model::Model;
use crate::respond::sensors;
use crate::signal::How;
use frfit::c64;
use frfit::laws::{LawFit, LawKind};
use frfit::signal::Options;
use frfit_workflow::Reads;
use frfit_workflow::check::{CheckJob, check_case, check_loaded, not_judged};
use frfit_workflow::convert::{ConvertOptions, convert as converted};
use frfit_workflow::export::{ExportOptions, export as exported};
use frfit_workflow::fit::fit_table;
use frfit_workflow::inspect::{inspect as inspected, modes_json, natural_frequencies as lowest};
use frfit_workflow::job::{JobError, frf_of_records, respond_case as responded};
use frfit_workflow::load::{Overrides, sensitivities_of_arrays};
use frfit_workflow::output::{File, write_one, write_unedited};
use frfit_workflow::records::ChannelOptions;
use frfit_workflow::sensitivities::{SensitivityOptions, sensitivities_case, sensitivities_loaded};
use numpy::{Complex64, IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

/// What `frfit.Check` is made of, and what `frfit check --json` prints.
#[pyfunction]
pub(crate) fn check<'py>(
    py: Python<'py>,
    path: PathBuf,
    band_hz: Option<[f64; 2]>,
    reduced: Option<PathBuf>,
    memory_bytes: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides = Overrides { band_hz, reduced, ..Overrides::default() };
    let done = in_background(py, None, move |_| check_case(&path, &overrides, memory_bytes))?;
    checked(py, &done.map_err(|error| job(py, &error))?)
}

/// The same from arrays.
#[pyfunction]
pub(crate) fn check_of_arrays<'py>(
    py: Python<'py>,
    model: &Model,
    load: PyReadonlyArray1<'py, Complex64>,
    measurements: Vec<Measured<'py>>,
    options: ArrayOptions<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (case, memory_bytes) = case_of(py, model, &load, measurements, options)?;
    let done = in_background(py, None, move |_| check_loaded(case, memory_bytes))?;
    checked(py, &done.map_err(|error| job(py, &error))?)
}

fn checked<'py>(py: Python<'py>, done: &CheckJob) -> PyResult<Bound<'py, PyDict>> {
    let (case, diagnosis) = (&done.case, &done.diagnosis);
    let found = PyDict::new(py);
    found.set_item("title", &case.title)?;
    found.set_item("findings", findings(py, case, Some(diagnosis))?)?;
    found.set_item("other_explanations", other_explanations(case, Some(diagnosis)))?;
    found.set_item("misfit", diagnosis.misfit)?;
    found.set_item("not_judged", diagnosis.not_judged.map(not_judged))?;
    found.set_item("frequencies", diagnosis.frequencies)?;
    found.set_item("summary", done.json().to_string())?;
    Ok(found)
}

/// What `frfit sensitivities --json` prints; with `out` its files too.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the command line")]
pub(crate) fn sensitivities(
    py: Python<'_>,
    path: PathBuf,
    out: Option<PathBuf>,
    band_hz: Option<[f64; 2]>,
    noise: Option<f64>,
    candidates: &str,
    reduced: Option<PathBuf>,
    memory_bytes: Option<u64>,
) -> PyResult<String> {
    let candidates = word(py, "candidates", candidates)?;
    let overrides = Overrides { band_hz, reduced, ..Overrides::default() };
    let options = SensitivityOptions { noise, candidates, memory_bytes };
    let found =
        in_background(py, None, move |_| sensitivities_case(&path, &overrides, &options, out.as_deref()))?;
    Ok(found.map_err(|error| job(py, &error))?.summary.to_string())
}

/// What `frfit sensitivities --json` prints, of arrays.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the command line, and the arrays")]
pub(crate) fn sensitivities_of_model(
    py: Python<'_>,
    model: &Model,
    load: PyReadonlyArray1<'_, Complex64>,
    rows: Vec<usize>,
    signs: Vec<f64>,
    frequency_hz: PyReadonlyArray1<'_, f64>,
    noise: Option<f64>,
    candidates: &str,
    memory_bytes: Option<u64>,
) -> PyResult<String> {
    let candidates = word(py, "candidates", candidates)?;
    let (load, hz) = (load.as_array().to_vec(), frequency_hz.as_array().to_vec());
    let case = sensitivities_of_arrays(Arc::clone(&model.0), load, sensors(&rows, &signs), hz);
    let case = case.map_err(|error| input(py, &error))?;
    let options = SensitivityOptions { noise, candidates, memory_bytes };
    let found = in_background(py, None, move |_| sensitivities_loaded(case, &options))?;
    Ok(found.map_err(|error| job(py, &error))?.summary.to_string())
}

/// A law and the names of its parameters.
type Fitted = (Law, Vec<String>);

/// What `frfit fit --json` prints, and the law of each fit with the names of its parameters; with `out` its files too.
/// Without laws all are compared.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    table: PathBuf,
    laws: Vec<String>,
    only: Option<(String, String)>,
    out: Option<PathBuf>,
) -> PyResult<(String, Vec<Fitted>)> {
    let kinds = laws.iter().map(|name| word(py, "laws", name)).collect::<PyResult<Vec<LawKind>>>()?;
    let found = in_background(py, None, move |_| {
        let only = only.as_ref().map(|(column, value)| (column.as_str(), value.as_str()));
        fit_table(&table, only, &kinds, out.as_deref())
    })?;
    let found = found.map_err(|error| job(py, &error))?;
    let law = |fit: LawFit| {
        let names = fit.parameters.iter().map(|parameter| parameter.name.to_string()).collect();
        (Law(fit.law), names)
    };
    Ok((found.summary.to_string(), found.fits.into_iter().map(law).collect()))
}

/// What `frfit.export` takes, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Exported {
    unit_system: Option<String>,
    poisson: Option<f64>,
    density: Option<f64>,
    modulus: Option<f64>,
    law: Option<PathBuf>,
    id: u32,
    name: String,
    all_rows: bool,
    unknown: Option<String>,
}

/// The file that `frfit export` writes, as text; with `out` it is written too.
#[pyfunction]
pub(crate) fn export(
    py: Python<'_>,
    target: &str,
    table: PathBuf,
    out: Option<PathBuf>,
    how: Exported,
) -> PyResult<String> {
    let options = ExportOptions {
        target: word(py, "target", target)?,
        units: how.unit_system.map(|units| word(py, "unit_system", &units)).transpose()?,
        poisson: how.poisson,
        density: how.density,
        modulus: how.modulus,
        id: how.id,
        name: how.name,
        all: how.all_rows,
        unknown: how.unknown,
    };
    let written = move || {
        let mut reads = Reads::default();
        let done = exported(&table, how.law.as_deref(), &options, &mut reads)?;
        if let Some(out) = out {
            write_one(&out, done.text.as_bytes().to_vec(), &reads)?;
        }
        Ok(done.text)
    };
    at_once(py, written)?.map_err(|error: JobError| job(py, &error))
}

/// What `frfit inspect --json` prints of a file.
#[pyfunction]
pub(crate) fn inspect(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    let found = at_once(py, || inspected(&path))?.map_err(|error| input(py, &error))?;
    Ok(found.json().to_string())
}

/// What `frfit inspect K M --modes COUNT --json` prints of natural frequencies.
#[pyfunction]
pub(crate) fn natural_frequencies(py: Python<'_>, k: PathBuf, m: PathBuf, count: usize) -> PyResult<String> {
    let found = in_background(py, None, move |_| lowest(&k, &m, count))?;
    Ok(modes_json(&found.map_err(|error| input(py, &error))?).to_string())
}

/// What `frfit.convert` takes, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Converted {
    to: Option<String>,
    name: Option<String>,
    records: Vec<i64>,
    columns: Option<Vec<String>>,
    quantity: Option<String>,
    response: Option<String>,
    reference: Option<String>,
    binary: bool,
}

/// Writes what `frfit convert` writes.
#[pyfunction]
pub(crate) fn convert(py: Python<'_>, source: PathBuf, target: PathBuf, how: Converted) -> PyResult<()> {
    let options = ConvertOptions {
        name: how.name,
        records: how.records,
        columns: how.columns,
        quantity: how.quantity.map(|quantity| word(py, "quantity", &quantity)).transpose()?,
        response: how.response.map(|dof| word(py, "response", &dof)).transpose()?,
        reference: how.reference.map(|dof| word(py, "reference", &dof)).transpose()?,
        to: how.to,
        binary: how.binary,
    };
    let written = move || {
        let mut reads = Reads::default();
        let bytes = converted(&source, &target, &options, &mut reads)?;
        Ok(write_one(&target, bytes, &reads)?)
    };
    at_once(py, written)?.map_err(|error: JobError| job(py, &error))
}

/// Names and summaries of the examples.
#[pyfunction]
pub(crate) fn examples() -> Vec<(&'static str, &'static str)> {
    frfit_examples::list().iter().map(|example| (example.name, example.summary)).collect()
}

/// Writes an example, as `frfit example` does, and returns the names of its files.
#[pyfunction]
pub(crate) fn example(py: Python<'_>, name: &str, folder: PathBuf) -> PyResult<Vec<String>> {
    let files = frfit_examples::generate(name).map_err(|error| raise(py, "OptionsError", &error))?;
    let names = files.iter().map(|file| file.path.clone()).collect();
    let files: Vec<File> = files.into_iter().map(|file| File::new(file.path, file.bytes)).collect();
    let written = at_once(py, || write_unedited(&folder, files, &Reads::default()))?;
    written.map_err(|error| job(py, &JobError::Write(error)))?;
    Ok(names)
}

/// Frequencies, receptances (frequencies, sensors) and sensors of a case's forward response; with `out` the files of `frfit respond` too.
#[pyfunction]
pub(crate) fn respond_case<'py>(
    py: Python<'py>,
    path: PathBuf,
    out: Option<PathBuf>,
    band_hz: Option<[f64; 2]>,
    memory_bytes: Option<u64>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides = Overrides { band_hz, ..Overrides::default() };
    let done = in_background(py, progress, move |watch| {
        responded(&path, &overrides, memory_bytes, out.as_deref(), &|done, total| watch.progress(done, total))
    })?;
    let (case, run) = done.map_err(|error| job(py, &error))?;
    let found = PyDict::new(py);
    let count = case.sensors.len();
    let missing = vec![c64::new(f64::NAN, f64::NAN); count];
    let rows = run.receptance.into_iter().map(|row| row.unwrap_or_else(|_| missing.clone()));
    found.set_item("title", &case.title)?;
    found.set_item("sensors", case.sensors.iter().map(|sensor| &sensor.label).collect::<Vec<_>>())?;
    found.set_item("receptance", table(py, rows, count)?)?;
    found.set_item("frequency_hz", run.frequency_hz.into_pyarray(py))?;
    Ok(found)
}

/// What `frfit.frf_of_records` takes, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Channels {
    to: Option<String>,
    force: Option<String>,
    responses: Vec<String>,
    force_unit: Option<String>,
    response_unit: Option<String>,
    force_sensitivity: Option<String>,
    response_sensitivity: Option<String>,
    force_dof: Option<String>,
    response_dofs: Vec<String>,
}

/// What `frfit frf --json` prints, beside the files that it writes.
#[pyfunction]
pub(crate) fn frf_of_files(
    py: Python<'_>,
    records: Vec<PathBuf>,
    out: PathBuf,
    channels: Channels,
    how: How,
) -> PyResult<String> {
    let dofs = channels.response_dofs.iter().map(|dof| word(py, "response_dofs", dof));
    let of_channels = ChannelOptions {
        force: channels.force,
        responses: channels.responses,
        force_unit: optional(py, "force_unit", channels.force_unit)?,
        response_unit: optional(py, "response_unit", channels.response_unit)?,
        force_sensitivity: optional(py, "force_sensitivity", channels.force_sensitivity)?,
        response_sensitivity: optional(py, "response_sensitivity", channels.response_sensitivity)?,
        force_dof: optional(py, "force_dof", channels.force_dof)?,
        response_dofs: dofs.collect::<PyResult<_>>()?,
    };
    let options: Options = how.options(py)?;
    let done = in_background(py, None, move |_| {
        frf_of_records(&records, &of_channels, &options, &out, channels.to.as_deref())
    })?;
    Ok(done.map_err(|error| job(py, &error))?.summary.to_string())
}

/// A word that the command line would take.
fn word<T: FromStr>(py: Python<'_>, name: &str, text: &str) -> PyResult<T>
where
    T::Err: Display,
{
    text.parse().map_err(|error: T::Err| raise(py, "OptionsError", &format!("{name}: {error}")))
}

fn optional<T: FromStr>(py: Python<'_>, name: &str, text: Option<String>) -> PyResult<Option<T>>
where
    T::Err: Display,
{
    text.map(|text| word(py, name, &text)).transpose()
}
