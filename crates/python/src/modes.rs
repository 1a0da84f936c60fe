//! Natural frequencies, damping and shapes of a case, as `frfit modes` finds them.

use crate::background::in_background;
use crate::columns::{reals, table};
use crate::errors::{input, job};
use crate::identify::{Measured, Options, case_of};
use crate::model::Model;
use crate::respond::sensors;
use frfit::quantity::Quantity;
use frfit_workflow::error::Place;
use frfit_workflow::load::{Case, Overrides, response_of_arrays};
use frfit_workflow::modes::{ModesJob, ModesOptions, modes_case, modes_loaded};
use numpy::{Complex64, IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// What `frfit.Modes` is made of; with `out` the files of `frfit modes` too.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the command line")]
pub(crate) fn modes<'py>(
    py: Python<'py>,
    path: PathBuf,
    out: Option<PathBuf>,
    band_hz: Option<[f64; 2]>,
    identified: Option<PathBuf>,
    reduced: Option<PathBuf>,
    max_order: Option<usize>,
    memory_bytes: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides = Overrides { band_hz, identified, reduced, ..Overrides::default() };
    let options = ModesOptions { max_order, memory_bytes };
    let found = in_background(py, None, move |_| modes_case(&path, &overrides, &options, out.as_deref()))?
        .map_err(|error| job(py, &error))?;
    columns(py, &found)
}

/// What `frfit.Modes` is made of, from arrays.
#[pyfunction]
pub(crate) fn modes_of_arrays<'py>(
    py: Python<'py>,
    model: &Model,
    load: PyReadonlyArray1<'py, Complex64>,
    measurements: Vec<Measured<'py>>,
    options: Options<'py>,
    max_order: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let (case, memory_bytes) = case_of(py, model, &load, measurements, options)?;
    of_loaded(py, case.with_modes(), ModesOptions { max_order, memory_bytes })
}

/// The same of a model alone.
#[pyfunction]
pub(crate) fn modes_of_model<'py>(
    py: Python<'py>,
    model: &Model,
    load: PyReadonlyArray1<'py, Complex64>,
    rows: Vec<usize>,
    signs: Vec<f64>,
    band_hz: [f64; 2],
    memory_bytes: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let (load, quantity) = (load.as_array().to_vec(), Quantity::Receptance);
    let hz = band_hz.to_vec();
    let case = response_of_arrays(Arc::clone(&model.0), load, sensors(&rows, &signs), quantity, hz);
    let case = case.map_err(|error| input(py, &error))?.with_modes_of_the_model(band_hz);
    of_loaded(py, case, ModesOptions { max_order: None, memory_bytes })
}

fn of_loaded(py: Python<'_>, case: Case, options: ModesOptions) -> PyResult<Bound<'_, PyDict>> {
    let place = Place::option("model");
    let found = in_background(py, None, move |_| modes_loaded(case, &place, &options))?;
    columns(py, &found.map_err(|error| job(py, &error))?)
}

fn columns<'py>(py: Python<'py>, job: &ModesJob) -> PyResult<Bound<'py, PyDict>> {
    let (case, run) = (&job.case, &job.run);
    let found = PyDict::new(py);
    found.set_item("title", &case.title)?;
    found.set_item("sensors", case.sensors.iter().map(|sensor| &sensor.label).collect::<Vec<_>>())?;
    let shown: Vec<usize> = run.shown().collect();
    let model = || shown.iter().map(|&i| &run.model.modes[i]);
    reals(&found, "frequency_hz", model().map(|mode| Some(mode.frequency_hz())))?;
    reals(&found, "damping_ratio", model().map(|mode| Some(mode.damping_ratio())))?;
    found.set_item("is_rigid_body", model().map(|mode| mode.is_rigid_body()).collect::<Vec<_>>())?;
    found.set_item("shape", table(py, model().map(|mode| mode.sensors.clone()), case.sensors.len())?)?;
    let measured = run.measured.as_ref();
    let modes = || measured.iter().flat_map(|measured| &measured.modes.modes);
    reals(&found, "measured_frequency_hz", modes().map(|mode| Some(mode.frequency_hz())))?;
    reals(&found, "measured_frequency_std_hz", modes().map(|mode| mode.frequency_std_hz))?;
    reals(&found, "measured_damping_ratio", modes().map(|mode| Some(mode.damping_ratio())))?;
    reals(&found, "measured_damping_ratio_std", modes().map(|mode| mode.damping_ratio_std))?;
    found.set_item(
        "measured_shape",
        table(py, modes().map(|mode| mode.residues.clone()), case.sensors.len())?,
    )?;
    // Every mode with a partner is shown.
    let row = |i: usize| shown.iter().position(|&own| own == i).unwrap_or_default();
    let pairs = || measured.iter().flat_map(|measured| &measured.pairing.pairs);
    found.set_item("pairs", table(py, pairs().map(|pair| vec![row(pair.model), pair.measured]), 2)?)?;
    reals(&found, "frequency_difference", pairs().map(|pair| Some(pair.frequency_difference)))?;
    reals(&found, "mac", pairs().map(|pair| pair.assurance))?;
    found.set_item("is_crossing", pairs().map(|pair| pair.is_crossing).collect::<Vec<_>>())?;
    found.set_item("stiffness_factor", measured.map(|measured| measured.pairing.stiffness_factor))?;
    for (name, of_sensors) in [
        ("frac", measured.map(|measured| &measured.frac)),
        ("comac", measured.map(|measured| &measured.comac)),
    ] {
        reals(&found, name, of_sensors.into_iter().flatten().copied())?;
    }
    let line_hz = measured.map_or_else(Vec::new, |measured| measured.band.frequency_hz.clone());
    found.set_item("line_hz", line_hz.into_pyarray(py))?;
    reals(&found, "csac", measured.into_iter().flat_map(|measured| measured.csac.iter().copied()))?;
    reals(&found, "csf", measured.into_iter().flat_map(|measured| measured.csf.iter().copied()))?;
    Ok(found)
}
