//! What came out of several unknowns, as arrays: the columns of `identified.csv`, NaN where a cell is empty.

use crate::columns::{NOTHING, table};
use frfit::c64;
use frfit::identify::{Line, Uncertainty};
use frfit_workflow::job::Computed;
use frfit_workflow::load::IdentifyCase;
use frfit_workflow::output::{coordinate, not_told, varies};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Everything that `frfit.SeveralIdentification` is made of.
pub(crate) fn several<'py>(py: Python<'py>, computed: &Computed) -> PyResult<Bound<'py, PyDict>> {
    let (case, run) = (&computed.case, &computed.run);
    let (outcome, found) = (&run.found, PyDict::new(py));
    let Some(wanted) = &case.identify else { return Ok(found) };
    let real = |name: &str, of: &dyn Fn(&Line) -> Option<f64>| {
        let column: Vec<f64> = outcome.lines.iter().map(|at| of(at).unwrap_or(f64::NAN)).collect();
        found.set_item(name, column.into_pyarray(py))
    };
    real("frequency_hz", &|at| Some(at.frequency_hz))?;
    real("error", &|at| at.error)?;
    real("chi2", &|at| at.chi_squared)?;
    real("reduction_error", &|at| at.reduction_error)?;
    found.set_item("status", outcome.lines.iter().map(|at| at.status.name()).collect::<Vec<_>>())?;
    let unknowns = (0..wanted.unknowns.len()).map(|j| unknown(py, wanted, computed, j));
    found.set_item("unknowns", PyList::new(py, unknowns.collect::<PyResult<Vec<_>>>()?)?)?;
    let sensors = case.sensors.len();
    let response = |of: &dyn Fn(&Line) -> Vec<c64>| {
        let rows = outcome.lines.iter().map(|at| match of(at) {
            values if values.len() == sensors => values,
            _ => vec![NOTHING; sensors],
        });
        table(py, rows, sensors)
    };
    found.set_item("nominal_response", response(&|at| at.nominal_response.clone())?)?;
    found.set_item("updated_response", response(&|at| at.updated_response.clone())?)?;
    found.set_item("measured_response", table(py, wanted.measured.iter().cloned(), sensors)?)?;
    let count = outcome.identifiability.coordinates.len();
    let names: Vec<String> = (0..count).map(|c| coordinate(wanted, outcome, c)).collect();
    found.set_item("coordinates", names)?;
    found.set_item("correlation", table(py, outcome.identifiability.correlation.iter().cloned(), count)?)?;
    let directions: Vec<(f64, Vec<(String, f64)>)> = outcome
        .identifiability
        .directions
        .iter()
        .map(|direction| {
            let weights = direction.weights.iter().map(|&(c, w)| (coordinate(wanted, outcome, c), w));
            (direction.std, weights.collect())
        })
        .collect();
    found.set_item("directions", directions)?;
    found.set_item("not_told", not_told(wanted, outcome))?;
    let profile = outcome.identifiability.profile.as_ref().map_or(&[][..], |profile| &profile.points);
    found.set_item("profile", table(py, profile.iter().map(|&(x, y)| vec![x, y]), 2)?)?;
    found.set_item("sensors", case.sensors.iter().map(|sensor| sensor.label.as_str()).collect::<Vec<_>>())?;
    found.set_item("title", &case.title)?;
    found.set_item("noise", outcome.noise.level)?;
    found.set_item("noise_source", outcome.noise.source.name())?;
    found.set_item("explained", outcome.fit.map(|fit| fit.verdict.name()))?;
    found.set_item("is_trusted", outcome.is_trusted())?;
    found.set_item("converged", outcome.search.converged)?;
    found.set_item("starts", outcome.search.starts)?;
    found.set_item("agreeing", outcome.search.agreeing)?;
    found.set_item("subspace_size", outcome.search.reduced_size.unwrap_or(0))?;
    found.set_item("factorisations", outcome.search.work.factorisations)?;
    found.set_item("solves", outcome.search.work.solves)?;
    found.set_item("seconds", run.seconds.identify())?;
    Ok(found)
}

fn unknown<'py>(
    py: Python<'py>,
    wanted: &IdentifyCase,
    computed: &Computed,
    j: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (one, outcome) = (&wanted.unknowns[j], &computed.run.found);
    let found = PyDict::new(py);
    found.set_item("name", &one.name)?;
    found.set_item("varies", varies(one))?;
    found.set_item("is_real", one.real)?;
    let value: Vec<c64> = outcome.lines.iter().map(|at| at.values[j].value.unwrap_or(NOTHING)).collect();
    found.set_item("value", value.into_pyarray(py))?;
    let nominal: Vec<c64> = outcome.lines.iter().map(|at| at.values[j].nominal).collect();
    found.set_item("nominal", nominal.into_pyarray(py))?;
    let real = |name: &str, of: &dyn Fn(Uncertainty) -> Option<f64>| {
        let column = outcome.lines.iter().map(|at| at.values[j].uncertainty.and_then(of).unwrap_or(f64::NAN));
        found.set_item(name, column.collect::<Vec<f64>>().into_pyarray(py))
    };
    real("storage_std", &|v| Some(v.storage_std))?;
    real("loss_factor_std", &|v| v.loss_factor_std)?;
    real("storage_loss_correlation", &|v| v.correlation)?;
    let band = outcome.constants.iter().find(|value| value.unknowns == j);
    let numbers: Vec<(&str, f64, f64)> = band
        .into_iter()
        .flat_map(|band| &band.numbers)
        .map(|number| (number.name.as_str(), number.value, number.std.unwrap_or(f64::NAN)))
        .collect();
    found.set_item("numbers", numbers)?;
    found.set_item("status", band.map(|band| band.status.name()))?;
    Ok(found)
}
