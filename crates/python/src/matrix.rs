//! Sparse matrices: compressed columns of SciPy in, positions and values of files out.

use crate::background::at_once;
use crate::errors::{input, raise};
use frfit_formats::{CoordinateMatrix, Entries, Symmetry};
use frfit_linalg::sparse::SymmetricMatrix;
use frfit_workflow::Reads;
use frfit_workflow::load::{load_bytes, load_matrix, powers_of_arrays, symmetric_matrix};
use numpy::{Complex64, IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Row indices and column pointers: SciPy has them in 32 bits where that is enough.
#[derive(FromPyObject)]
pub(crate) enum Indices<'py> {
    #[pyo3(transparent)]
    Short(PyReadonlyArray1<'py, i32>),
    #[pyo3(transparent)]
    Long(PyReadonlyArray1<'py, i64>),
}

impl Indices<'_> {
    fn to_vec(&self) -> Option<Vec<usize>> {
        match self {
            Self::Short(indices) => indices.as_array().iter().map(|&i| usize::try_from(i).ok()).collect(),
            Self::Long(indices) => indices.as_array().iter().map(|&i| usize::try_from(i).ok()).collect(),
        }
    }
}

/// Values, real or complex.
#[derive(FromPyObject)]
pub(crate) enum Data<'py> {
    #[pyo3(transparent)]
    Real(PyReadonlyArray1<'py, f64>),
    #[pyo3(transparent)]
    Complex(PyReadonlyArray1<'py, Complex64>),
}

/// The symmetric matrix of compressed columns, both triangles or the lower one; refused as a file with these entries would be.
pub(crate) fn symmetric(
    py: Python<'_>,
    name: &str,
    symmetry: Symmetry,
    [nrows, ncols]: [usize; 2],
    data: &Data<'_>,
    indices: &Indices<'_>,
    indptr: &Indices<'_>,
) -> PyResult<SymmetricMatrix> {
    let refuse = |text: String| raise(py, "MatrixError", &format!("matrix {name:?}: {text}"));
    let negative = || refuse("expected indices that are not negative".into());
    let rows = indices.to_vec().ok_or_else(negative)?;
    let ends = indptr.to_vec().ok_or_else(negative)?;
    let is_sound = ends.first() == Some(&0) && ends.last() == Some(&rows.len()) && ends.is_sorted();
    if !is_sound || Some(ends.len()) != ncols.checked_add(1) {
        return Err(refuse("expected column pointers that ascend from 0 to the number of entries".into()));
    }
    let cols =
        ends.windows(2).enumerate().flat_map(|(col, w)| std::iter::repeat_n(col, w[1] - w[0])).collect();
    let entries = match data {
        Data::Real(values) => Entries::Real(values.as_array().to_vec()),
        Data::Complex(values) => Entries::Complex(values.as_array().to_vec()),
    };
    let matrix = CoordinateMatrix { nrows, ncols, symmetry, rows, cols, entries, title: String::new() };
    let made = at_once(py, || matrix.validate().and_then(|()| symmetric_matrix(&matrix)))?;
    made.map_err(|error| refuse(format!("expected {}, found {}", error.expected, error.found)))
}

/// Refuses a path at which there is no file that can be read, in the words of the command line.
#[pyfunction]
pub(crate) fn readable(py: Python<'_>, path: PathBuf) -> PyResult<()> {
    at_once(py, || load_bytes(&path, &mut Reads::default()).map(drop))?.map_err(|error| input(py, &error))
}

/// A matrix of a file as positions and values.
#[pyfunction]
pub(crate) fn read_matrix(
    py: Python<'_>,
    path: PathBuf,
    name: Option<String>,
) -> PyResult<Bound<'_, PyDict>> {
    let matrix = at_once(py, || load_matrix(&path, name.as_deref()))?.map_err(|error| input(py, &error))?;
    let found = PyDict::new(py);
    found.set_item("shape", (matrix.nrows, matrix.ncols))?;
    found.set_item("title", &matrix.title)?;
    let symmetry = match matrix.symmetry {
        Symmetry::General => "general",
        Symmetry::Symmetric => "symmetric",
        Symmetry::SkewSymmetric => "skew-symmetric",
        Symmetry::Hermitian => "hermitian",
    };
    found.set_item("symmetry", symmetry)?;
    match matrix.entries {
        Entries::Pattern => found.set_item("values", vec![1.0; matrix.rows.len()].into_pyarray(py))?,
        Entries::Real(values) => found.set_item("values", values.into_pyarray(py))?,
        Entries::Complex(values) => found.set_item("values", values.into_pyarray(py))?,
    }
    found.set_item("rows", signed(py, matrix.rows)?)?;
    found.set_item("cols", signed(py, matrix.cols)?)?;
    Ok(found)
}

/// Indices in the 64 bits that SciPy takes.
fn signed(py: Python<'_>, indices: Vec<usize>) -> PyResult<Bound<'_, PyArray1<i64>>> {
    let indices: Result<Vec<i64>, _> = indices.into_iter().map(i64::try_from).collect();
    Ok(indices?.into_pyarray(py))
}

/// Value of a dimension, name, shape, data, indices, column pointers.
type Sample<'py> = (f64, String, [usize; 2], Data<'py>, Indices<'py>, Indices<'py>);

/// Positions of the lower triangle, and values.
type Part<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f64>>);

/// A matrix at several values of a dimension by the powers of it.
#[pyfunction]
pub(crate) fn powers_of<'py>(
    py: Python<'py>,
    matrices: Vec<Sample<'py>>,
    powers: Option<Vec<i32>>,
) -> PyResult<Vec<(i32, Part<'py>)>> {
    let sample = |(value, name, shape, data, indices, indptr): Sample<'py>| {
        Ok((value, symmetric(py, &name, Symmetry::General, shape, &data, &indices, &indptr)?))
    };
    let samples = matrices.into_iter().map(sample).collect::<PyResult<Vec<_>>>()?;
    let parts = at_once(py, || powers_of_arrays(&samples, powers))?.map_err(|error| input(py, &error))?;
    let part = |(power, matrix): (i32, SymmetricMatrix)| {
        let (rows, cols) = matrix.pattern().positions().unzip();
        let values = matrix.real_values().unwrap_or_default().to_vec();
        Ok((power, (signed(py, rows)?, signed(py, cols)?, values.into_pyarray(py))))
    };
    parts.into_iter().map(part).collect()
}
