//! Laws of a factor over frequency.

use crate::errors::{argument, outside_table, raise};
use frfit::c64;
use frfit::laws::{LawKind, Parameter, ParameterKind, UnknownLawKind};
use frfit::material::{self, Branch, Table};
use frfit_workflow::case::law_keys;
use numpy::{Complex64, IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A factor's dependence on frequency.
#[pyclass(frozen, eq, from_py_object, module = "frfit")]
#[derive(Clone, PartialEq)]
pub(crate) struct Law(pub(crate) material::Law);

#[pymethods]
impl Law {
    /// The same number at every frequency: a real or complex modulus, in Pa.
    #[staticmethod]
    fn constant(py: Python<'_>, value: Complex64) -> PyResult<Self> {
        finite(py, "value", value)?;
        Ok(Self(material::Law::Constant(value)))
    }

    /// E' (1 + i eta) at every frequency: `storage` E' in Pa, `loss_factor` eta.
    #[staticmethod]
    #[pyo3(signature = (storage, loss_factor = 0.0))]
    fn complex_modulus(py: Python<'_>, storage: f64, loss_factor: f64) -> PyResult<Self> {
        finite(py, "storage", storage)?;
        finite(py, "loss_factor", loss_factor)?;
        finite(py, "storage * loss_factor", storage * loss_factor)?;
        Ok(Self(material::Law::complex_modulus(storage, loss_factor)))
    }

    /// E0 + E1 (i omega)^alpha: `e0` in Pa, `e1` in Pa s^alpha, `alpha` from 0 to 1.
    #[staticmethod]
    fn fractional(py: Python<'_>, e0: f64, e1: f64, alpha: f64) -> PyResult<Self> {
        made(py, LawKind::Fractional, &[e0, e1, alpha])
    }

    /// (E0 + Einf (i omega tau)^alpha) / (1 + (i omega tau)^alpha): moduli in Pa, `tau_s` in s.
    #[staticmethod]
    fn zener(py: Python<'_>, e0: f64, e_infinity: f64, tau_s: f64, alpha: f64) -> PyResult<Self> {
        made(py, LawKind::FractionalZener, &[e0, e_infinity, tau_s, alpha])
    }

    /// E0 + sum Ek i omega tauk / (1 + i omega tauk): `branches` are pairs (Ek in Pa, tauk in s).
    #[staticmethod]
    fn maxwell(py: Python<'_>, e0: f64, branches: Vec<(f64, f64)>) -> PyResult<Self> {
        finite(py, "e0", e0)?;
        for &(modulus, tau_s) in &branches {
            finite(py, "branches", modulus)?;
            allowed(py, "branches", ParameterKind::Time, tau_s)?;
        }
        let branches = branches.into_iter().map(|(modulus, tau_s)| Branch { modulus, tau_s }).collect();
        Ok(Self(material::Law::Maxwell { e0, branches }))
    }

    /// Any law by its word in a case file, `"zener"`, and its parameters in their order.
    #[staticmethod]
    #[pyo3(signature = (law, *parameters))]
    fn named(py: Python<'_>, law: &str, parameters: Vec<f64>) -> PyResult<Self> {
        let kind = law.parse::<LawKind>();
        let kind = kind.map_err(|unknown| argument(py, "law", UnknownLawKind::EXPECTED, &unknown.found))?;
        if let (LawKind::Constant, &[storage, loss_factor]) = (kind, &parameters[..]) {
            return Self::complex_modulus(py, storage, loss_factor);
        }
        if parameters.len() != kind.count() {
            let names: Vec<String> = kind.parameters().iter().map(name_of).collect();
            return Err(argument(
                py,
                "parameters",
                &names.join(", "),
                &format!("{} numbers", parameters.len()),
            ));
        }
        made(py, kind, &parameters)
    }

    /// Values (f,), complex, at frequencies (f,) in Hz, ascending; linear over log frequency in between, never beyond.
    #[staticmethod]
    fn table(py: Python<'_>, frequency_hz: Bound<'_, PyAny>, values: Bound<'_, PyAny>) -> PyResult<Self> {
        let frequency_hz = reals(&frequency_hz, "frequency_hz")?.as_array().to_vec();
        let values = values.py().import("frfit._arrays")?.getattr("complex_")?.call1((values, "values"))?;
        let values: PyReadonlyArray1<'_, Complex64> = values.extract()?;
        let table = Table::new(frequency_hz, values.as_array().to_vec());
        table.map(|table| Self(material::Law::Table(table))).map_err(|error| raise(py, "TableError", &error))
    }

    /// The factor (f,), complex, at frequencies (f,) in Hz.
    fn at<'py>(
        &self,
        py: Python<'py>,
        frequency_hz: Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let frequency_hz = reals(&frequency_hz, "frequency_hz")?;
        let values = frequency_hz.as_array().iter().map(|&f| self.0.at(f)).collect::<Result<Vec<c64>, _>>();
        values.map(|values| values.into_pyarray(py)).map_err(|error| outside_table(py, &error))
    }

    /// The keys of the law in a case file, each as `key = value`; none of a table, which has a file.
    fn _case_file_keys(&self) -> Vec<String> {
        law_keys(&self.0)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let parts = match &self.0 {
            material::Law::Constant(value) => ("constant", *value).into_pyobject(py)?,
            material::Law::Maxwell { e0, branches } => {
                let pairs: Vec<(f64, f64)> = branches.iter().map(|b| (b.modulus, b.tau_s)).collect();
                ("maxwell", *e0, pairs).into_pyobject(py)?
            }
            material::Law::Table(table) => {
                let hz = table.frequency_hz().to_vec().into_pyarray(py);
                ("table", hz, table.values().to_vec().into_pyarray(py)).into_pyobject(py)?
            }
            law => {
                let (word, p) = LawKind::of(law).map(|(kind, p)| (kind.word(), p)).unwrap_or_default();
                let words = ["named", word].into_iter().map(|word| word.into_py_any(py));
                let numbers = p.into_iter().map(|value| value.into_py_any(py));
                PyTuple::new(py, words.chain(numbers).collect::<PyResult<Vec<_>>>()?)?
            }
        };
        Ok((py.import("frfit._restore")?.getattr("law")?, parts))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Nothing of it ever changes.
    fn __deepcopy__(slf: Py<Self>, _memo: Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        match &self.0 {
            material::Law::Constant(value) => format!("Law.constant({} + {}j)", value.re, value.im),
            material::Law::Maxwell { e0, branches } => {
                let pairs: Vec<String> =
                    branches.iter().map(|b| format!("({}, {})", b.modulus, b.tau_s)).collect();
                format!("Law.maxwell(e0={e0}, branches=[{}])", pairs.join(", "))
            }
            material::Law::Table(table) => format!("<Law.table of {} rows>", table.frequency_hz().len()),
            law => {
                let Some((kind, p)) = LawKind::of(law) else { return String::new() };
                let parameters = kind.parameters();
                let named = parameters.iter().zip(&p).map(|(of, value)| format!("{}={value}", name_of(of)));
                format!("Law.{}({})", kind.word(), named.collect::<Vec<_>>().join(", "))
            }
        }
    }
}

/// Numbers in whatever form the package takes them.
fn reals<'py>(values: &Bound<'py, PyAny>, name: &str) -> PyResult<PyReadonlyArray1<'py, f64>> {
    let real = values.py().import("frfit._arrays")?.getattr("real")?;
    real.call1((values, name))?.extract()
}

fn finite(py: Python<'_>, name: &str, value: impl Into<Complex64>) -> PyResult<()> {
    let value = value.into();
    match value.is_finite() {
        true => Ok(()),
        false => Err(argument(py, name, "a finite number", &value)),
    }
}

/// The name of a parameter as an argument: a time says that it is in seconds.
fn name_of(parameter: &Parameter) -> String {
    let unit = if parameter.kind == ParameterKind::Time { "_s" } else { "" };
    format!("{}{unit}", parameter.name)
}

fn allowed(py: Python<'_>, name: &str, kind: ParameterKind, value: f64) -> PyResult<()> {
    match kind.allows(value) {
        true => Ok(()),
        false => Err(argument(py, name, kind.expected(), &value)),
    }
}

/// A law of parameters that it allows.
fn made(py: Python<'_>, kind: LawKind, p: &[f64]) -> PyResult<Law> {
    for (parameter, &value) in kind.parameters().iter().zip(p) {
        allowed(py, &name_of(parameter), parameter.kind, value)?;
    }
    Ok(Law(kind.law(p)))
}
