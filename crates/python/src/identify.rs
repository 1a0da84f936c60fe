//! Identification from arrays.

use crate::background::in_background;
use crate::columns::identification;
use crate::errors::{arrays, input, job, raise};
use crate::model::Model;
use frfit::identify::{CoarserMesh, ErrorSizes, ModelErrors};
use frfit::laws::LawKind;
use frfit::model::{DynamicStiffness, Experiment, Sensor};
use frfit::quantity::Quantity;
use frfit::roots::Bounds;
use frfit_workflow::case::RandomWindow;
use frfit_workflow::job::compute;
use frfit_workflow::load::{Case, Frf, MeasuredFrf, Wanted, WantedUnknown, case_of_arrays};
use frfit_workflow::run::RunOptions;
use numpy::{Complex64, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::sync::Arc;

/// The fields of `frfit.Measurement`, arrays made contiguous.
#[derive(FromPyObject)]
pub(crate) struct Measured<'py> {
    row: usize,
    sign: f64,
    quantity: String,
    frequency_hz: PyReadonlyArray1<'py, f64>,
    response: PyReadonlyArray1<'py, Complex64>,
    std: Option<PyReadonlyArray1<'py, f64>>,
    coherence: Option<PyReadonlyArray1<'py, f64>>,
    averages: Option<usize>,
    scale: Option<f64>,
    delay_s: Option<f64>,
    decay_per_s: f64,
    window: Option<String>,
    record_s: Option<f64>,
}

/// The options of `frfit.identify`, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options<'py> {
    unknowns: Vec<Unknown>,
    band_hz: Option<[f64; 2]>,
    exclude_hz: Vec<[f64; 2]>,
    max_lines: Option<i64>,
    method: Option<String>,
    selection: Option<String>,
    reduction: Option<String>,
    order: Option<usize>,
    start_at_bounds: bool,
    reject_outliers: Option<bool>,
    model_error: Option<KnownErrors>,
    coarser_mesh: Option<Coarser<'py>>,
    check: bool,
    memory_bytes: Option<u64>,
}

/// The fields of `frfit.CoarserMesh`, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Coarser<'py> {
    model: PyRef<'py, Model>,
    load: PyReadonlyArray1<'py, Complex64>,
    sensors: Vec<(usize, f64)>,
    element_ratio: f64,
    order: f64,
}

impl Coarser<'_> {
    fn mesh(self) -> CoarserMesh {
        let sensors = self.sensors.into_iter().map(|(row, sign)| Sensor { row, sign }).collect();
        CoarserMesh {
            model: DynamicStiffness::clone(&self.model.0),
            experiment: Experiment { load: self.load.as_array().to_vec(), sensors },
            element_ratio: self.element_ratio,
            order: self.order,
        }
    }
}

/// The fields of `frfit.Unknown`, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Unknown {
    name: Option<String>,
    matrices: Vec<String>,
    powers: Vec<(String, i32)>,
    nominal: Option<f64>,
    varies: Option<String>,
    laws: Vec<String>,
    storage: Option<[f64; 2]>,
    loss_factor: Option<[f64; 2]>,
    real: bool,
}

impl Unknown {
    fn wanted(self, py: Python<'_>) -> PyResult<WantedUnknown> {
        let laws = self.laws.iter().map(|word| word.parse::<LawKind>()).collect::<Result<Vec<_>, _>>();
        Ok(WantedUnknown {
            name: self.name,
            matrices: self.matrices,
            powers: self.powers,
            nominal: self.nominal,
            varies: self.varies,
            laws: laws.map_err(|error| raise(py, "OptionsError", &format!("law: {error}")))?,
            bounds: Bounds { storage: self.storage, loss_factor: self.loss_factor },
            real: self.real,
        })
    }
}

/// `"estimated"`, `"none"`, the size of the errors of natural frequencies, or sizes by their names.
#[derive(FromPyObject)]
enum KnownErrors {
    Word(String),
    Frequency(f64),
    Sizes(HashMap<String, f64>),
}

fn known_errors(py: Python<'_>, known: Option<KnownErrors>) -> PyResult<ModelErrors> {
    let sizes = match known {
        None => return Ok(ModelErrors::default()),
        Some(KnownErrors::Word(word)) => {
            let refuse = |expected| format!("model_error: expected {expected}, found {word:?}");
            let known = word.parse::<ModelErrors>();
            return known.map_err(|error| raise(py, "OptionsError", &refuse(error.expected)));
        }
        Some(KnownErrors::Frequency(size)) => ErrorSizes::default().with_frequency(Some(size)),
        Some(KnownErrors::Sizes(sizes)) => {
            let of = |name: &str| sizes.get(name).copied();
            ErrorSizes::default()
                .with_frequency(of("frequency"))
                .with_shape(of("shape"))
                .with_calibration(of("calibration"))
        }
    };
    Ok(ModelErrors::Given(sizes))
}

impl Measured<'_> {
    fn frf(self, py: Python<'_>) -> PyResult<MeasuredFrf> {
        let numbers = |array: PyReadonlyArray1<'_, f64>| array.as_array().to_vec();
        let quantity = self.quantity.parse::<Quantity>();
        let window = self.window.as_deref().map(str::parse::<RandomWindow>).transpose();
        let frf = Frf {
            frequency_hz: numbers(self.frequency_hz),
            response: self.response.as_array().to_vec(),
            coherence: self.coherence.map(numbers),
            std: self.std.map(numbers),
            quantity: None,
            measured_at: None,
            driven_at: None,
            decay_per_s: Some(self.decay_per_s),
        };
        Ok(MeasuredFrf {
            sensor: Sensor { row: self.row, sign: self.sign },
            quantity: quantity.map_err(|error| raise(py, "OptionsError", &format!("quantity: {error}")))?,
            frf,
            scale: self.scale,
            delay_s: self.delay_s,
            averages: self.averages,
            window: window.map_err(|error| raise(py, "OptionsError", &format!("window: {error}")))?,
            record_s: self.record_s,
        })
    }
}

/// Refuses a measurement that no model could be held against; `name` is what errors call it.
#[pyfunction]
pub(crate) fn check_measurement(py: Python<'_>, name: &str, measurement: Measured<'_>) -> PyResult<()> {
    let measured = measurement.frf(py)?;
    measured.check(name).map_err(|error| input(py, &error))
}

/// A case made of the arguments of `frfit.identify`, and the memory that may be used.
pub(crate) fn case_of<'py>(
    py: Python<'py>,
    model: &Model,
    load: &PyReadonlyArray1<'py, Complex64>,
    measurements: Vec<Measured<'py>>,
    options: Options<'py>,
) -> PyResult<(Case, Option<u64>)> {
    let measured = measurements.into_iter().map(|one| one.frf(py)).collect::<PyResult<Vec<_>>>()?;
    let unknowns = options.unknowns.into_iter().map(|one| one.wanted(py)).collect::<PyResult<Vec<_>>>()?;
    let wanted = Wanted {
        unknowns,
        band_hz: options.band_hz,
        exclude_hz: options.exclude_hz,
        max_lines: options.max_lines,
        method: options.method,
        selection: options.selection,
        reduction: options.reduction,
        order: options.order,
        start_at_bounds: options.start_at_bounds,
        reject_outliers: options.reject_outliers,
        model_errors: known_errors(py, options.model_error)?,
        check: options.check,
    };
    let case = case_of_arrays(Arc::clone(&model.0), load.as_array().to_vec(), measured, &wanted);
    let mut case = case.map_err(|error| arrays(py, &error))?;
    case.coarser_mesh = options.coarser_mesh.map(Coarser::mesh);
    Ok((case, options.memory_bytes))
}

/// What `frfit.Identification` is made of.
#[pyfunction]
pub(crate) fn identify<'py>(
    py: Python<'py>,
    model: &Model,
    load: PyReadonlyArray1<'py, Complex64>,
    measurements: Vec<Measured<'py>>,
    options: Options<'py>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (case, memory_bytes) = case_of(py, model, &load, measurements, options)?;
    // A map of the error over the orders is for figures of files.
    let run = RunOptions { error_map: Some(0), memory_bytes, ..RunOptions::default() };
    let computed = in_background(py, progress, move |watch| {
        compute(case, run, 0.0, &|done, total| watch.progress(done, total))
    })?;
    identification(py, &computed.map_err(|error| job(py, &error))?)
}
