//! Forward responses.

use crate::background::in_background;
use crate::columns::table;
use crate::errors::{input, outside_table};
use crate::model::Model;
use frfit::c64;
use frfit::model::Sensor;
use frfit::quantity::Quantity;
use frfit_workflow::load::response_of_arrays;
use numpy::{Complex64, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use std::sync::Arc;

/// Rows and signs as sensors.
pub(crate) fn sensors(rows: &[usize], signs: &[f64]) -> Vec<Sensor> {
    rows.iter().zip(signs).map(|(&row, &sign)| Sensor { row, sign }).collect()
}

/// Receptance at the sensors, (frequencies, sensors); NaN where the system cannot be solved.
#[pyfunction]
pub(crate) fn respond<'py>(
    py: Python<'py>,
    model: &Model,
    load: PyReadonlyArray1<'py, Complex64>,
    rows: Vec<usize>,
    signs: Vec<f64>,
    frequency_hz: PyReadonlyArray1<'py, f64>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
    let (load, hz) = (load.as_array().to_vec(), frequency_hz.as_array().to_vec());
    let sensors = sensors(&rows, &signs);
    let count = sensors.len();
    let case = response_of_arrays(Arc::clone(&model.0), load, sensors, Quantity::Receptance, hz);
    let case = case.map_err(|error| input(py, &error))?;
    let run = in_background(py, progress, move |watch| {
        frfit_workflow::run::respond(&case, &|done, total| watch.progress(done, total))
    })?;
    let run = run.map_err(|error| outside_table(py, &error))?;
    let missing = vec![c64::new(f64::NAN, f64::NAN); count];
    let rows = run.receptance.into_iter().map(|row| row.unwrap_or_else(|_| missing.clone()));
    table(py, rows, count)
}
