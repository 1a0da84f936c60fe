//! A model in memory.

use crate::background::in_background;
use crate::errors::raise;
use crate::law::Law;
use crate::matrix::{Data, Indices, symmetric};
use frfit::model::{DynamicStiffness, FactorStd, ModelError, Role, Term};
use frfit_formats::Symmetry;
use frfit_linalg::sparse::Values;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use std::sync::Arc;

/// D(ω), analysed once, shared by all calls.
#[pyclass(frozen, module = "frfit._frfit")]
pub(crate) struct Model(pub(crate) Arc<DynamicStiffness>);

/// Name, role, factor, standard deviations of it (relative of the storage, absolute of the loss factor), shape, data, indices, column pointers.
type TermOf<'py> = (String, String, Law, StdOf, [usize; 2], Data<'py>, Indices<'py>, Indices<'py>);

type StdOf = (Option<f64>, Option<f64>);

/// Terms as one model, its pattern analysed: so that no two threads, nor a forked child, find that half done.
fn model(py: Python<'_>, terms: Vec<TermOf<'_>>, symmetry: Symmetry) -> PyResult<Model> {
    let term =
        |(name, role, Law(factor), (storage, loss_factor), shape, data, indices, indptr): TermOf<'_>| {
            let matrix = symmetric(py, &name, symmetry, shape, &data, &indices, &indptr)?;
            let term = Term { role: role_of(py, &name, &role)?, name, matrix, factor };
            Ok((term, FactorStd { storage, loss_factor }))
        };
    let terms = terms.into_iter().map(term).collect::<PyResult<Vec<_>>>()?;
    let (terms, known): (Vec<Term>, Vec<FactorStd>) = terms.into_iter().unzip();
    let model = in_background(py, None, move |_| {
        let model = DynamicStiffness::new(terms)?.with_threads(rayon::current_num_threads());
        let with_std = |model: DynamicStiffness, (term, std)| model.with_factor_std(term, std);
        let model = known.into_iter().enumerate().fold(model, with_std);
        // Too large for this computer is said where it is asked for something.
        let _ = model.analysis().factor_memory::<f64>();
        Ok(model)
    })?;
    model.map(|model| Model(Arc::new(model))).map_err(|error: ModelError| raise(py, "ModelError", &error))
}

/// A model of what one was pickled as: names, roles and factors, the positions of its lower triangle, and values of each term.
#[pyfunction]
pub(crate) fn restored_model<'py>(
    py: Python<'py>,
    terms: Vec<(String, String, Law, StdOf, Data<'py>)>,
    indices: Bound<'py, PyAny>,
    indptr: Bound<'py, PyAny>,
) -> PyResult<Model> {
    let dim = indptr.len()?.saturating_sub(1);
    let term = |(name, role, law, std, data)| -> PyResult<TermOf<'py>> {
        Ok((name, role, law, std, [dim, dim], data, indices.extract()?, indptr.extract()?))
    };
    let terms = terms.into_iter().map(term).collect::<PyResult<Vec<_>>>()?;
    model(py, terms, Symmetry::Symmetric)
}

#[pymethods]
impl Model {
    #[new]
    fn new(py: Python<'_>, terms: Vec<TermOf<'_>>) -> PyResult<Self> {
        model(py, terms, Symmetry::General)
    }

    #[getter]
    fn dim(&self) -> usize {
        self.0.dim()
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.0.terms().iter().map(|term| term.name.clone()).collect()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let terms = PyList::empty(py);
        for (k, term) in self.0.terms().iter().enumerate() {
            let FactorStd { storage, loss_factor } = self.0.factor_std(k);
            let values = match term.matrix.values() {
                Values::Real(values) => values.clone().into_pyarray(py).into_any(),
                Values::Complex(values) => values.clone().into_pyarray(py).into_any(),
            };
            let role = match term.role {
                Role::Stiffness => "stiffness",
                Role::Viscous => "viscous",
                Role::Mass => "mass",
            };
            terms.append((&term.name, role, Law(term.factor.clone()), (storage, loss_factor), values))?;
        }
        // All terms are on one pattern, and a model has one at least.
        let pattern = self.0.terms()[0].matrix.pattern();
        // Rows of a model are fewer than 2³¹.
        let rows: Result<Vec<i32>, _> = pattern.row_idx().iter().map(|&row| i32::try_from(row)).collect();
        let ends: Result<Vec<i64>, _> = pattern.col_ptr().iter().map(|&end| i64::try_from(end)).collect();
        let parts = (terms, rows?.into_pyarray(py), ends?.into_pyarray(py)).into_pyobject(py)?;
        Ok((py.import("frfit._restore")?.getattr("model")?, parts))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// Nothing of it ever changes.
    fn __deepcopy__(slf: Py<Self>, _memo: Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

fn role_of(py: Python<'_>, name: &str, role: &str) -> PyResult<Role> {
    match role {
        "stiffness" => Ok(Role::Stiffness),
        "viscous" => Ok(Role::Viscous),
        "mass" => Ok(Role::Mass),
        _ => {
            let text = format!(
                "matrix {name:?}: role: expected \"stiffness\", \"viscous\" or \"mass\", found {role:?}"
            );
            Err(raise(py, "ModelError", &text))
        }
    }
}
