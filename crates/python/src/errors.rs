//! One exception for each kind of error, with the text that the command line prints.
//!
//! The classes are in `frfit/_errors.py`, where a class may have two bases.

use frfit::identify::ProblemError;
use frfit::material::OutsideTable;
use frfit_formats::Position;
use frfit_workflow::error::{InputError, Place};
use frfit_workflow::job::JobError;
use frfit_workflow::load::ArraysError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Display;

/// An exception of `frfit._errors`, by the name of its class.
pub(crate) fn raise(py: Python<'_>, class: &str, error: &impl Display) -> PyErr {
    with(py, class, error, |_| Ok(()))
}

/// The same with attributes.
fn with(
    py: Python<'_>,
    class: &str,
    error: &impl Display,
    attributes: impl FnOnce(&Bound<'_, PyDict>) -> PyResult<()>,
) -> PyErr {
    let made = || -> PyResult<PyErr> {
        let known = PyDict::new(py);
        attributes(&known)?;
        let exception = py.import("frfit._errors")?.getattr(class)?.call1((error.to_string(),))?;
        for (name, value) in known.iter() {
            exception.setattr(name.extract::<String>()?, value)?;
        }
        Ok(PyErr::from_value(exception))
    };
    made().unwrap_or_else(|failed| failed)
}

/// What the user has to put right, and where.
pub(crate) fn input(py: Python<'_>, error: &InputError) -> PyErr {
    with(py, "InputError", error, |known| {
        let (line, column) = match error.place.position {
            Position::Line { line, column } => (Some(line), column),
            Position::File | Position::Byte(_) => (None, None),
        };
        let file = error.place.file.as_ref().map(|file| file.display().to_string());
        known.set_item("file", file)?;
        known.set_item("line", line)?;
        known.set_item("column", column)?;
        known.set_item("key", &error.place.key)?;
        known.set_item("expected", &error.expected)?;
        known.set_item("found", &error.found)
    })
}

/// A frequency that no table reaches.
pub(crate) fn outside_table(py: Python<'_>, error: &OutsideTable) -> PyErr {
    raise(py, "OutsideTableError", error)
}

/// Why a job was not done.
pub(crate) fn job(py: Python<'_>, error: &JobError) -> PyErr {
    match error {
        JobError::Input(error) => input(py, error),
        JobError::OutsideTable(error) | JobError::Problem(ProblemError::Table(error)) => {
            outside_table(py, error)
        }
        JobError::Problem(error) => raise(py, "ModelError", error),
        JobError::Memory(error) => raise(py, "ModelMemoryError", error),
        JobError::Write(error) => raise(py, "WriteError", error),
        JobError::Figure(_) | JobError::Report(_) => raise(py, "InternalError", error),
    }
}

/// Why arrays make no case.
pub(crate) fn arrays(py: Python<'_>, error: &ArraysError) -> PyErr {
    match error {
        ArraysError::Input(error) => input(py, error),
        ArraysError::Model(error) => raise(py, "ModelError", error),
        ArraysError::Options(error) => raise(py, "OptionsError", error),
        ArraysError::Bounds(error) => raise(py, "OptionsError", error),
    }
}

/// A fault of this program: a panic, whose words Rust has written to standard error.
pub(crate) fn internal(py: Python<'_>) -> PyErr {
    let text = "a fault of frfit, not of what it was given: please report it with what is on standard error";
    raise(py, "InternalError", &text)
}

/// An argument that is not as it has to be.
pub(crate) fn argument(py: Python<'_>, name: &str, expected: &str, found: &impl Display) -> PyErr {
    input(py, &InputError::at(&Place::option(name), expected, found.to_string()))
}

/// The system gave no thread.
pub(crate) fn no_thread(error: &impl Display) -> PyErr {
    PyRuntimeError::new_err(format!("no thread could be started: {error}"))
}
