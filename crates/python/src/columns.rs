//! What came out, as arrays: the columns of `identified.csv`, NaN where a cell is empty.

use frfit::c64;
use frfit::identify::{Calibrated, Calibration, Line, Variation};
use frfit_workflow::job::Computed;
use frfit_workflow::output::{laws_json, smooth_json};
use frfit_workflow::units::FactorUnit;
use numpy::{Complex64, Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// No number.
pub(crate) const NOTHING: c64 = c64::new(f64::NAN, f64::NAN);

/// Rows of equal length as an array of two dimensions.
pub(crate) fn table<T: Element + Clone>(
    py: Python<'_>,
    rows: impl Iterator<Item = Vec<T>>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let flat: Vec<T> = rows.flatten().collect();
    let count = flat.len().checked_div(columns).unwrap_or(0);
    flat.into_pyarray(py).reshape([count, columns])
}

/// Everything that `frfit.Identification` is made of.
pub(crate) fn identification<'py>(py: Python<'py>, computed: &Computed) -> PyResult<Bound<'py, PyDict>> {
    let (case, run) = (&computed.case, &computed.run);
    let found = outcomes(py, &run.found.lines)?;
    let sensors = case.sensors.len();
    let response = |of: fn(&Line) -> &Vec<c64>| {
        let rows = run.found.lines.iter().map(|outcome| match of(outcome) {
            values if values.len() == sensors => values.clone(),
            _ => vec![NOTHING; sensors],
        });
        table(py, rows, sensors)
    };
    found.set_item("nominal_response", response(|outcome| &outcome.nominal_response)?)?;
    found.set_item("updated_response", response(|outcome| &outcome.updated_response)?)?;
    if let Some(identify) = &case.identify {
        let rows = identify.frequency_hz.iter().zip(&identify.measured);
        let measured = rows.map(|(&frequency_hz, row)| run.measured(frequency_hz, row));
        found.set_item("measured_response", table(py, measured, sensors)?)?;
        found.set_item("matrices", identify.matrices(&case.model))?;
    }
    let labels: Vec<&str> = case.sensors.iter().map(|sensor| sensor.label.as_str()).collect();
    found.set_item("sensors", labels)?;
    found.set_item("title", &case.title)?;
    found.set_item("noise", run.found.noise.level)?;
    found.set_item("noise_source", run.found.noise.source.name())?;
    found.set_item("explored", run.found.search.explored)?;
    found.set_item("subspace_size", run.found.search.reduced_size)?;
    found.set_item("factorisations", run.found.search.work.factorisations)?;
    found.set_item("solves", run.found.search.work.solves)?;
    found.set_item("seconds", run.seconds.identify())?;
    found.set_item("explained", run.found.fit.map(|fit| fit.verdict.name()))?;
    let misfit: Vec<f64> = run.found.sensors.iter().map(|fit| fit.misfit.unwrap_or(f64::NAN)).collect();
    found.set_item("sensor_misfit", misfit.into_pyarray(py))?;
    let left_out: Vec<bool> = run.found.sensors.iter().map(|fit| fit.left_out).collect();
    found.set_item("sensor_left_out", left_out.into_pyarray(py))?;
    let calibrated = |name: &str, of: &dyn Fn(&Calibration) -> Option<f64>| {
        let column: Vec<f64> =
            run.found.channels.iter().map(|channel| of(channel).unwrap_or(f64::NAN)).collect();
        found.set_item(name, column.into_pyarray(py))
    };
    let value = |found: Calibrated| found.value;
    calibrated("sensor_scale", &|channel| channel.scale.map(value))?;
    calibrated("sensor_scale_std", &|channel| channel.scale?.std)?;
    calibrated("sensor_delay_s", &|channel| channel.delay_s.map(value))?;
    calibrated("sensor_delay_s_std", &|channel| channel.delay_s?.std)?;
    let told = PyList::empty(py);
    let diagnosis = computed.diagnosis.as_ref();
    for finding in diagnosis.map(|d| frfit_workflow::check::told(case, d)).unwrap_or_default() {
        let one = PyDict::new(py);
        one.set_item("kind", finding.kind)?;
        one.set_item("sensors", finding.sensors)?;
        one.set_item("what", finding.what)?;
        one.set_item("evidence", finding.evidence)?;
        one.set_item("change", finding.change)?;
        told.append(one)?;
    }
    found.set_item("findings", told)?;
    let parsed = |json: Option<serde_json::Value>| {
        json.map(|json| py.import("json")?.call_method1("loads", (json.to_string(),))).transpose()
    };
    let unit = case.identify.as_ref().map_or(FactorUnit::Other, |identify| identify.units[0]);
    let by_law = case
        .identify
        .as_ref()
        .is_some_and(|identify| matches!(identify.unknowns[0].varies, Variation::Law(_)));
    found.set_item("laws", parsed(by_law.then(|| laws_json(&run.found.laws, unit, case.units)))?)?;
    found.set_item("smooth", parsed(run.found.curve.as_ref().map(smooth_json))?)?;
    Ok(found)
}

fn outcomes<'py>(py: Python<'py>, outcomes: &[Line]) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let real = |name: &str, of: &dyn Fn(&Line) -> Option<f64>| {
        let column: Vec<f64> = outcomes.iter().map(|outcome| of(outcome).unwrap_or(f64::NAN)).collect();
        found.set_item(name, column.into_pyarray(py))
    };
    let complex = |of: &dyn Fn(&Line) -> Option<c64>| -> Bound<'py, PyArray1<Complex64>> {
        let column: Vec<c64> = outcomes.iter().map(|outcome| of(outcome).unwrap_or(NOTHING)).collect();
        column.into_pyarray(py)
    };
    real("frequency_hz", &|o| Some(o.frequency_hz))?;
    real("storage", &|o| o.storage())?;
    real("loss_factor", &|o| o.loss_factor())?;
    found.set_item("factor", complex(&|o| o.factor()))?;
    found.set_item("nominal", complex(&|o| Some(o.nominal())))?;
    found.set_item("correction", complex(&|o| o.correction()))?;
    real("error", &|o| o.error)?;
    real("spectral_radius", &|o| o.spectral_radius)?;
    real("convergence_radius", &|o| o.convergence_radius())?;
    real("required_order", &|o| o.required_order.map(|order| order as f64))?;
    real("reduction_error", &|o| o.reduction_error)?;
    real("storage_std", &|o| o.uncertainty().map(|bars| bars.storage_std))?;
    real("loss_factor_std", &|o| o.uncertainty().and_then(|bars| bars.loss_factor_std))?;
    real("storage_loss_correlation", &|o| o.uncertainty().and_then(|bars| bars.correlation))?;
    real("chi2", &|o| o.chi_squared)?;
    let count = |of: &dyn Fn(&Line) -> usize| {
        let column: Result<Vec<i64>, _> = outcomes.iter().map(|o| i64::try_from(of(o))).collect();
        column.map(|column| column.into_pyarray(py))
    };
    found.set_item("order", count(&|o| o.order)?)?;
    found.set_item("candidate_count", count(&|o| o.candidate_count())?)?;
    let status: Vec<&str> = outcomes.iter().map(|outcome| outcome.status.name()).collect();
    found.set_item("status", status)?;
    let alternatives: Vec<_> = outcomes
        .iter()
        .map(|o| o.rivals.iter().map(|rival| rival[0]).collect::<Vec<c64>>().into_pyarray(py))
        .collect();
    found.set_item("alternatives", alternatives)?;
    Ok(found)
}
