//! The Neumann series at one frequency.

use crate::background::in_background;
use crate::columns::table;
use crate::errors::{argument, arrays, input, outside_table, raise};
use crate::model::Model;
use crate::respond::sensors;
use frfit::identify::{MAX_ORDER, OptionsError};
use frfit::model::Parameter;
use frfit::quantity::Quantity;
use frfit::response::FullModel;
use frfit::series::{ConvergenceRadius, NeumannSeries, convergence_radius};
use frfit_workflow::load::{ArraysError, response_of_arrays};
use numpy::{Complex64, IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::Arc;

/// Taylor coefficients of the response in one factor, and how far they converge.
#[pyclass(frozen, module = "frfit")]
pub(crate) struct Series {
    series: NeumannSeries,
    radius: ConvergenceRadius,
    nominal: Complex64,
}

#[pymethods]
impl Series {
    /// Order n.
    #[getter]
    fn order(&self) -> usize {
        self.series.order()
    }

    /// s in z = c/s, in the unit of the factor.
    #[getter]
    fn scale(&self) -> f64 {
        self.series.scale()
    }

    /// The nominal factor; the correction c is counted from it.
    #[getter]
    fn nominal(&self) -> Complex64 {
        self.nominal
    }

    /// (sensors, order + 1), complex, m/N: the response as a polynomial in z = c/scale.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let sensors = (0..self.series.sensors()).map(|m| self.series.coefficients(m).to_vec());
        table(py, sensors, self.series.order() + 1)
    }

    /// Receptance (sensors,), m/N, with the correction c, cut after `order` terms.
    #[pyo3(signature = (correction, order = None))]
    fn respond<'py>(
        &self,
        py: Python<'py>,
        correction: Complex64,
        order: Option<usize>,
    ) -> Bound<'py, PyArray1<Complex64>> {
        self.series.respond(correction, order.unwrap_or(self.series.order())).into_pyarray(py)
    }

    /// The k-th derivative (sensors,) of the receptance with respect to the factor, at its nominal value.
    fn derivative<'py>(&self, py: Python<'py>, k: usize) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let values = self
            .series
            .derivative(k)
            .ok_or_else(|| argument(py, "k", &format!("0 to {}", self.series.order()), &k))?;
        Ok(values.into_pyarray(py))
    }

    /// rho at the correction c: the series converges where this is below 1.
    fn spectral_radius(&self, correction: Complex64) -> f64 {
        self.radius.at(correction)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let ConvergenceRadius { per_unit, residual, converged } = self.radius;
        let radius = (per_unit, residual, converged);
        let parts = (self.scale(), self.nominal, self.coefficients(py)?, radius).into_pyobject(py)?;
        Ok((py.import("frfit._restore")?.getattr("series")?, parts))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Nothing of it ever changes.
    fn __deepcopy__(slf: Py<Self>, _memo: Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

/// A series of what one was pickled as.
#[pyfunction]
pub(crate) fn restored_series(
    py: Python<'_>,
    scale: f64,
    nominal: Complex64,
    coefficients: PyReadonlyArray2<'_, Complex64>,
    radius: (f64, f64, bool),
) -> PyResult<Series> {
    let (per_unit, residual, converged) = radius;
    let terms = coefficients.as_array().rows().into_iter().map(|row| row.to_vec()).collect();
    let series = NeumannSeries::from_coefficients(scale, terms).ok_or_else(|| {
        argument(py, "coefficients", "at least one for each sensor, and a scale above 0", &"others")
    })?;
    Ok(Series { series, radius: ConvergenceRadius { per_unit, residual, converged }, nominal })
}

/// The series about the nominal factor of the named matrices.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "those of the function of Python")]
pub(crate) fn series(
    py: Python<'_>,
    model: &Model,
    load: PyReadonlyArray1<'_, Complex64>,
    rows: Vec<usize>,
    signs: Vec<f64>,
    frequency_hz: f64,
    matrices: Vec<String>,
    order: usize,
) -> PyResult<Series> {
    if !(1..=MAX_ORDER).contains(&order) {
        return Err(arrays(py, &ArraysError::Options(OptionsError::Order(order))));
    }
    let sensors = sensors(&rows, &signs);
    let load = load.as_array().to_vec();
    let case =
        response_of_arrays(Arc::clone(&model.0), load, sensors, Quantity::Receptance, vec![frequency_hz]);
    let case = case.map_err(|error| input(py, &error))?;
    let names: Vec<&str> = matrices.iter().map(String::as_str).collect();
    let parameter = Parameter::factor_of(&model.0, &names).map_err(|e| arrays(py, &ArraysError::Model(e)))?;
    let done = in_background(py, None, move |_| {
        let at = case.model.at(frequency_hz, std::slice::from_ref(&parameter)).map_err(Failed::Outside)?;
        let nominal = at.parameters[0].nominal;
        let system = FullModel::new(at, &case.experiment).map_err(Failed::Breakdown)?;
        let series = NeumannSeries::new(&system, 0, order).map_err(Failed::Breakdown)?;
        let radius = convergence_radius(&system, 0).map_err(Failed::Breakdown)?;
        Ok(Series { series, radius, nominal })
    })?;
    done.map_err(|failed| match failed {
        Failed::Outside(error) => outside_table(py, &error),
        Failed::Breakdown(error) => raise(py, "SolveError", &format!("at {frequency_hz} Hz: {error}")),
    })
}

enum Failed {
    Outside(frfit::material::OutsideTable),
    Breakdown(frfit_linalg::solve::Breakdown),
}
