//! From the records of a hammer test to an FRF.

use crate::background::in_background;
use crate::columns::table;
use crate::errors::raise;
use frfit::signal::{Options, Recording, Windows, estimate_frf};
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The fields of `frfit.Recording`, arrays made contiguous.
#[derive(FromPyObject)]
pub(crate) struct Recorded<'py> {
    step_s: f64,
    force: PyReadonlyArray1<'py, f64>,
    responses: PyReadonlyArray2<'py, f64>,
}

/// The options of `frfit.frf`, by their names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct How {
    estimator: String,
    trigger_n: Option<f64>,
    pre_trigger_s: Option<f64>,
    length_s: Option<f64>,
    double_impact: f64,
    drift: f64,
    force_window_s: Option<f64>,
    exponential_window_s: Option<f64>,
    keep: Vec<usize>,
}

impl How {
    /// As the library takes them.
    pub(crate) fn options(self, py: Python<'_>) -> PyResult<Options> {
        let estimator = self.estimator.parse();
        let windows = Windows::default()
            .with_force_s(self.force_window_s)
            .with_exponential_s(self.exponential_window_s);
        let refuse = |error| raise(py, "OptionsError", &format!("estimator: {error}"));
        Ok(Options::default()
            .with_estimator(estimator.map_err(refuse)?)
            .with_trigger_n(self.trigger_n)
            .with_pre_trigger_s(self.pre_trigger_s)
            .with_length_s(self.length_s)
            .with_double_impact(self.double_impact)
            .with_drift(self.drift)
            .with_windows(windows)
            .with_keep(self.keep))
    }
}

/// What `frfit.MeasuredFrf` is made of.
#[pyfunction]
pub(crate) fn frf<'py>(
    py: Python<'py>,
    recordings: Vec<Recorded<'py>>,
    how: How,
) -> PyResult<Bound<'py, PyDict>> {
    let recording = |one: Recorded<'_>| Recording {
        step_s: one.step_s,
        force: one.force.as_array().to_vec(),
        responses: one.responses.as_array().rows().into_iter().map(|row| row.to_vec()).collect(),
    };
    let recordings: Vec<Recording> = recordings.into_iter().map(recording).collect();
    let options = how.options(py)?;
    let measured = in_background(py, None, move |_| estimate_frf(&recordings, &options))?;
    let measured = measured.map_err(|error| raise(py, "SignalError", &error))?;
    let found = PyDict::new(py);
    found.set_item("averages", measured.averages())?;
    found.set_item("decay_per_s", measured.added_decay_per_s.unwrap_or(0.0))?;
    let points = measured.frequency_hz.len();
    let column = |of: &dyn Fn(&frfit::signal::Frf) -> Option<Vec<f64>>| {
        let rows: Option<Vec<Vec<f64>>> = measured.frfs.iter().map(of).collect();
        rows.map(|rows| table(py, rows.into_iter(), points)).transpose()
    };
    found.set_item("coherence", column(&|frf| frf.coherence.clone())?)?;
    // Of real and imaginary part each; a measurement's standard deviation is that of the complex value.
    let std = |variance: &Vec<f64>| variance.iter().map(|v| (2.0 * v).sqrt()).collect();
    found.set_item("std", column(&|frf| frf.variance.as_ref().map(std))?)?;
    let impacts = PyList::empty(py);
    for impact in &measured.impacts {
        let one = PyDict::new(py);
        one.set_item("recording", impact.recording)?;
        one.set_item("first", impact.range.start)?;
        one.set_item("end", impact.range.end)?;
        one.set_item("peak_n", impact.peak_n)?;
        one.set_item("contact_s", impact.contact_s(measured.step_s))?;
        one.set_item("kept", impact.is_kept())?;
        one.set_item("faults", impact.faults.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        impacts.append(one)?;
    }
    found.set_item("impacts", impacts)?;
    found.set_item("response", table(py, measured.frfs.into_iter().map(|frf| frf.response), points)?)?;
    found.set_item("frequency_hz", measured.frequency_hz.into_pyarray(py))?;
    found.set_item("force", measured.force.into_pyarray(py))?;
    Ok(found)
}
