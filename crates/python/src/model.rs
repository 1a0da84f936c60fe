//! A model in memory.

use crate::errors::raise;
use crate::law::Law;
use crate::matrix::{Data, Indices, symmetric};
use frfit::model::{DynamicStiffness, Role, Term};
use pyo3::prelude::*;
use std::sync::Arc;

/// D(ω), analysed once, shared by all calls.
#[pyclass(frozen, module = "frfit._frfit")]
pub(crate) struct Model(pub(crate) Arc<DynamicStiffness>);

/// Name, role, factor, shape, data, indices, column pointers.
type TermOf<'py> = (String, String, Law, [usize; 2], Data<'py>, Indices<'py>, Indices<'py>);

#[pymethods]
impl Model {
    #[new]
    fn new(py: Python<'_>, terms: Vec<TermOf<'_>>) -> PyResult<Self> {
        let term = |(name, role, Law(factor), shape, data, indices, indptr): TermOf<'_>| {
            let matrix = symmetric(py, &name, shape, &data, &indices, &indptr)?;
            Ok(Term { role: role_of(py, &name, &role)?, name, matrix, factor })
        };
        let terms = terms.into_iter().map(term).collect::<PyResult<Vec<Term>>>()?;
        let model = py.detach(|| DynamicStiffness::new(terms));
        let model = model.map_err(|error| raise(py, "ModelError", &error))?;
        Ok(Self(Arc::new(model.with_threads(rayon::current_num_threads()))))
    }

    #[getter]
    fn dim(&self) -> usize {
        self.0.dim()
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.0.terms().iter().map(|term| term.name.clone()).collect()
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
