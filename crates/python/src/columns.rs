//! What came out, as arrays: the columns of `identified.csv`, NaN where a cell is empty.

use frfit::c64;
use frfit::diagnostics::Diagnosis;
use frfit::identify::{Calibration, Direction, Identifiability, Line, LineValue, Variation};
use frfit_workflow::check::{faults_text, finding_texts};
use frfit_workflow::job::Computed;
use frfit_workflow::load::{Case, IdentifyCase};
use frfit_workflow::output::{coordinate, laws_json, not_identifiable, smooth_json};
use numpy::{Element, IntoPyArray, PyArray2, PyArrayMethods};
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
    let identify = case.identify.as_ref().expect("what was computed has something to identify");
    let found = lines(py, &run.found.lines)?;
    let unknowns = (0..identify.unknowns.len()).map(|j| estimate(py, computed, identify, j));
    found.set_item("unknowns", PyList::new(py, unknowns.collect::<PyResult<Vec<_>>>()?)?)?;
    responses(&found, computed, identify)?;
    sensors(&found, computed)?;
    search(&found, computed)?;
    identifiability(&found, computed, identify)?;
    found.set_item("title", &case.title)?;
    let diagnosis = computed.diagnosis.as_ref();
    found.set_item("findings", findings(py, case, diagnosis)?)?;
    found.set_item("other_explanations", other_explanations(case, diagnosis))?;
    let parsed = |json: Option<serde_json::Value>| {
        json.map(|json| py.import("json")?.call_method1("loads", (json.to_string(),))).transpose()
    };
    let laws = identify.is_law().then(|| laws_json(&run.found.laws, identify.units[0], case.units));
    found.set_item("laws", parsed(laws)?)?;
    found.set_item("smooth", parsed(run.found.curve.as_ref().map(smooth_json))?)?;
    Ok(found)
}

/// A column of real numbers.
pub(crate) fn reals<'py>(
    found: &Bound<'py, PyDict>,
    name: &str,
    column: impl Iterator<Item = Option<f64>>,
) -> PyResult<()> {
    let column: Vec<f64> = column.map(|value| value.unwrap_or(f64::NAN)).collect();
    found.set_item(name, column.into_pyarray(found.py()))
}

/// What a frequency has.
fn lines<'py>(py: Python<'py>, lines: &[Line]) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let real = |name: &str, of: fn(&Line) -> Option<f64>| reals(&found, name, lines.iter().map(of));
    real("frequency_hz", |line| Some(line.frequency_hz))?;
    real("error", |line| line.error)?;
    real("spectral_radius", |line| line.spectral_radius)?;
    real("convergence_radius", |line| line.convergence_radius())?;
    real("required_order", |line| line.required_order.map(|order| order as f64))?;
    real("reduction_error", |line| line.reduction_error)?;
    real("chi2", |line| line.chi_squared)?;
    let count = |of: fn(&Line) -> usize| {
        let column: Result<Vec<i64>, _> = lines.iter().map(|line| i64::try_from(of(line))).collect();
        column.map(|column| column.into_pyarray(py))
    };
    found.set_item("order", count(|line| line.order)?)?;
    found.set_item("candidate_count", count(Line::candidate_count)?)?;
    found.set_item("status", lines.iter().map(|line| line.status.name()).collect::<Vec<_>>())?;
    Ok(found)
}

/// Everything that `frfit.Estimate` is made of: what was found of the j-th unknown.
fn estimate<'py>(
    py: Python<'py>,
    computed: &Computed,
    identify: &IdentifyCase,
    j: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (one, run) = (&identify.unknowns[j], &computed.run.found);
    let found = PyDict::new(py);
    let laws = match &one.varies {
        Variation::Law(laws) => laws.as_slice(),
        _ => &[],
    };
    found.set_item("name", &one.name)?;
    found.set_item("matrices", identify.matrices(&computed.case.model, j))?;
    found.set_item("varies", identify.varies(j))?;
    found.set_item("law", laws.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    found.set_item("real", one.real)?;
    let values = || run.lines.iter().map(|line| &line.values[j]);
    let complex = |name: &str, of: fn(&LineValue) -> Option<c64>| {
        let column: Vec<c64> = values().map(|value| of(value).unwrap_or(NOTHING)).collect();
        found.set_item(name, column.into_pyarray(py))
    };
    complex("factor", |value| value.value)?;
    complex("nominal", |value| Some(value.nominal))?;
    complex("correction", |value| value.correction)?;
    let real = |name: &str, of: fn(&LineValue) -> Option<f64>| reals(&found, name, values().map(of));
    real("storage", LineValue::storage)?;
    real("loss_factor", LineValue::loss_factor)?;
    real("storage_std", |value| Some(value.uncertainty?.storage_std))?;
    real("loss_factor_std", |value| value.uncertainty?.loss_factor_std)?;
    real("storage_loss_correlation", |value| value.uncertainty?.correlation)?;
    real("storage_std_noise", |value| Some(value.uncertainty?.contributions.noise))?;
    real("storage_std_model", |value| Some(value.uncertainty?.contributions.model))?;
    real("storage_std_known_factors", |value| Some(value.uncertainty?.contributions.known_factors))?;
    let rivals =
        |line: &Line| line.rivals.iter().map(|rival| rival[j]).collect::<Vec<c64>>().into_pyarray(py);
    found.set_item("alternatives", run.lines.iter().map(rivals).collect::<Vec<_>>())?;
    let band = run.constants.iter().find(|value| value.unknowns == j);
    let numbers: Vec<(&str, f64, f64)> = (band.into_iter().flat_map(|band| &band.numbers))
        .map(|number| (number.name.as_str(), number.value, number.std.unwrap_or(f64::NAN)))
        .collect();
    found.set_item("numbers", numbers)?;
    found.set_item("status", band.map(|band| band.status.name()))?;
    Ok(found)
}

fn responses(found: &Bound<'_, PyDict>, computed: &Computed, identify: &IdentifyCase) -> PyResult<()> {
    let (py, run, sensors) = (found.py(), &computed.run, computed.case.sensors.len());
    let response = |of: fn(&Line) -> &Vec<c64>| {
        let rows = run.found.lines.iter().map(|line| match of(line) {
            values if values.len() == sensors => values.clone(),
            _ => vec![NOTHING; sensors],
        });
        table(py, rows, sensors)
    };
    found.set_item("nominal_response", response(|line| &line.nominal_response)?)?;
    found.set_item("updated_response", response(|line| &line.updated_response)?)?;
    let rows = identify.frequency_hz.iter().zip(&identify.measured);
    let measured = rows.map(|(&frequency_hz, row)| run.measured(frequency_hz, row));
    found.set_item("measured_response", table(py, measured, sensors)?)
}

fn sensors(found: &Bound<'_, PyDict>, computed: &Computed) -> PyResult<()> {
    let run = &computed.run.found;
    let labels: Vec<&str> = computed.case.sensors.iter().map(|sensor| sensor.label.as_str()).collect();
    found.set_item("sensors", labels)?;
    reals(found, "sensor_misfit", run.sensors.iter().map(|fit| fit.misfit))?;
    let left_out: Vec<bool> = run.sensors.iter().map(|fit| fit.left_out).collect();
    found.set_item("sensor_left_out", left_out.into_pyarray(found.py()))?;
    let calibrated =
        |name: &str, of: fn(&Calibration) -> Option<f64>| reals(found, name, run.channels.iter().map(of));
    calibrated("sensor_scale", |channel| Some(channel.scale?.value))?;
    calibrated("sensor_scale_std", |channel| channel.scale?.std)?;
    calibrated("sensor_delay_s", |channel| Some(channel.delay_s?.value))?;
    calibrated("sensor_delay_s_std", |channel| channel.delay_s?.std)
}

fn search(found: &Bound<'_, PyDict>, computed: &Computed) -> PyResult<()> {
    let run = &computed.run.found;
    found.set_item("noise", run.noise.level)?;
    found.set_item("noise_source", run.noise.source.name())?;
    found.set_item("explained", run.fit.map(|fit| fit.verdict.name()))?;
    found.set_item("is_trusted", run.is_trusted())?;
    found.set_item("converged", run.search.converged)?;
    found.set_item("starts", run.search.starts)?;
    found.set_item("agreeing", run.search.agreeing)?;
    found.set_item("search_about", run.search.about.clone())?;
    found.set_item("explored", run.search.explored)?;
    found.set_item("subspace_size", run.search.reduced_size)?;
    found.set_item("factorisations", run.search.work.factorisations)?;
    found.set_item("solves", run.search.work.solves)?;
    found.set_item("seconds", computed.run.seconds.identify())
}

fn identifiability(found: &Bound<'_, PyDict>, computed: &Computed, identify: &IdentifyCase) -> PyResult<()> {
    let (py, run) = (found.py(), &computed.run.found);
    let Identifiability { coordinates, correlation, directions, profile } = &run.identifiability;
    let name = |c: usize| coordinate(identify, run, c);
    found.set_item("coordinates", (0..coordinates.len()).map(name).collect::<Vec<_>>())?;
    found.set_item("correlation", table(py, correlation.iter().cloned(), coordinates.len())?)?;
    let direction = |one: &Direction| {
        let weights: Vec<(String, f64)> = one.weights.iter().map(|&(c, weight)| (name(c), weight)).collect();
        (one.std, weights)
    };
    found.set_item("directions", directions.iter().map(direction).collect::<Vec<_>>())?;
    found.set_item("not_identifiable", not_identifiable(identify, run))?;
    let profile = profile.as_ref().map_or(&[][..], |profile| &profile.points);
    found.set_item("profile", table(py, profile.iter().map(|&(x, y)| vec![x, y]), 2)?)
}

/// Faults in words, misfit and nats of each explanation between which the data do not decide.
pub(crate) fn other_explanations(case: &Case, diagnosis: Option<&Diagnosis>) -> Vec<(Vec<String>, f64, f64)> {
    let others = diagnosis.map_or(&[][..], |diagnosis| &diagnosis.others);
    others.iter().map(|other| (faults_text(case, other), other.misfit, other.nats_behind)).collect()
}

/// Everything that `frfit.Finding` is made of.
pub(crate) fn findings<'py>(
    py: Python<'py>,
    case: &Case,
    diagnosis: Option<&Diagnosis>,
) -> PyResult<Bound<'py, PyList>> {
    let findings = PyList::empty(py);
    for finding in diagnosis.map(|diagnosis| finding_texts(case, diagnosis)).unwrap_or_default() {
        let one = PyDict::new(py);
        one.set_item("kind", finding.kind)?;
        one.set_item("sensors", finding.sensors)?;
        one.set_item("what", finding.what)?;
        one.set_item("evidence", finding.evidence)?;
        one.set_item("change", finding.change)?;
        findings.append(one)?;
    }
    Ok(findings)
}
