//! Laws of a factor over frequency.

use crate::errors::{outside_table, raise};
use frfit::c64;
use frfit::material::{self, Branch, Table};
use numpy::{Complex64, IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

/// A factor's dependence on frequency.
#[pyclass(frozen, eq, from_py_object, module = "frfit")]
#[derive(Clone, PartialEq)]
pub(crate) struct Law(pub(crate) material::Law);

#[pymethods]
impl Law {
    /// The same number at every frequency: a real or complex modulus, in Pa.
    #[staticmethod]
    fn constant(value: Complex64) -> Self {
        Self(material::Law::Constant(value))
    }

    /// E' (1 + i eta) at every frequency: `storage` E' in Pa, `loss_factor` eta.
    #[staticmethod]
    #[pyo3(signature = (storage, loss_factor = 0.0))]
    fn complex_modulus(storage: f64, loss_factor: f64) -> Self {
        Self(material::Law::complex_modulus(storage, loss_factor))
    }

    /// E0 + E1 (i omega)^alpha: `e0` in Pa, `e1` in Pa s^alpha, `alpha` from 0 to 1.
    #[staticmethod]
    fn fractional(e0: f64, e1: f64, alpha: f64) -> Self {
        Self(material::Law::Fractional { e0, e1, alpha })
    }

    /// (E0 + Einf (i omega tau)^alpha) / (1 + (i omega tau)^alpha): moduli in Pa, `tau_s` in s.
    #[staticmethod]
    fn zener(e0: f64, e_infinity: f64, tau_s: f64, alpha: f64) -> Self {
        Self(material::Law::FractionalZener { e0, e_infinity, tau_s, alpha })
    }

    /// E0 + sum Ek i omega tauk / (1 + i omega tauk): `branches` are pairs (Ek in Pa, tauk in s).
    #[staticmethod]
    fn maxwell(e0: f64, branches: Vec<(f64, f64)>) -> Self {
        let branches = branches.into_iter().map(|(modulus, tau_s)| Branch { modulus, tau_s }).collect();
        Self(material::Law::Maxwell { e0, branches })
    }

    /// Values (f,), complex128, at frequencies (f,) in Hz, ascending; linear over log frequency in between, never beyond.
    #[staticmethod]
    fn table(
        py: Python<'_>,
        frequency_hz: PyReadonlyArray1<'_, f64>,
        values: PyReadonlyArray1<'_, Complex64>,
    ) -> PyResult<Self> {
        let values = values.as_array().to_vec();
        let table = Table::new(frequency_hz.as_array().to_vec(), values);
        table.map(|table| Self(material::Law::Table(table))).map_err(|error| raise(py, "TableError", &error))
    }

    /// The factor (f,), complex, at frequencies (f,) in Hz.
    fn at<'py>(
        &self,
        py: Python<'py>,
        frequency_hz: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let values = frequency_hz.as_array().iter().map(|&f| self.0.at(f)).collect::<Result<Vec<c64>, _>>();
        values.map(|values| values.into_pyarray(py)).map_err(|error| outside_table(py, &error))
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            material::Law::Constant(value) => format!("Law.constant({} + {}j)", value.re, value.im),
            material::Law::Fractional { e0, e1, alpha } => {
                format!("Law.fractional(e0={e0}, e1={e1}, alpha={alpha})")
            }
            material::Law::FractionalZener { e0, e_infinity, tau_s, alpha } => {
                format!("Law.zener(e0={e0}, e_infinity={e_infinity}, tau_s={tau_s}, alpha={alpha})")
            }
            material::Law::Maxwell { e0, branches } => {
                let pairs: Vec<String> =
                    branches.iter().map(|b| format!("({}, {})", b.modulus, b.tau_s)).collect();
                format!("Law.maxwell(e0={e0}, branches=[{}])", pairs.join(", "))
            }
            material::Law::Table(table) => format!("<Law.table of {} rows>", table.frequency_hz().len()),
        }
    }
}
