//! Universal files: mapped into memory, listed without being read, read function by function.

use crate::background::at_once;
use crate::errors::{input, raise};
use frfit_formats::FormatError;
use frfit_formats::uff::{
    Axis, DataType, Dof, Endian, Entry, File, Form, Function, FunctionHeader, FunctionType, Quantity,
    Spacing, Summary, Values, scan, write,
};
use frfit_workflow::Reads;
use frfit_workflow::error::InputError;
use frfit_workflow::load::{Frf, read_frfs};
use frfit_workflow::output;
use numpy::{Complex64, IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

/// The bytes of a file, owned by an array of NumPy (a map of the file), and where its datasets are.
#[pyclass(frozen, module = "frfit._frfit")]
pub(crate) struct UffFile {
    path: PathBuf,
    bytes: Py<PyArray1<u8>>,
    entries: Vec<Entry>,
}

impl UffFile {
    /// Calls something with the file, the GIL free.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        call: impl FnOnce(&File<'_>) -> Result<T, FormatError> + Send,
    ) -> PyResult<T> {
        let bytes = self.bytes.bind(py).readonly();
        let bytes = bytes.as_slice()?;
        let file = File::with_entries(bytes, &self.entries);
        at_once(py, || call(&file))?.map_err(|error| self.refuse(py, error))
    }

    fn refuse(&self, py: Python<'_>, error: FormatError) -> PyErr {
        input(py, &InputError::in_file(&self.path, error))
    }
}

#[pymethods]
impl UffFile {
    #[new]
    fn new(py: Python<'_>, path: PathBuf, bytes: Bound<'_, PyArray1<u8>>) -> PyResult<Self> {
        let entries = {
            let bytes = bytes.readonly();
            let bytes = bytes.as_slice()?;
            at_once(py, || scan(bytes))?
        };
        let entries = entries.map_err(|error| input(py, &InputError::in_file(&path, error)))?;
        Ok(Self { path, bytes: bytes.unbind(), entries })
    }

    fn __len__(&self) -> usize {
        self.entries.len()
    }

    /// A list of dictionaries, one a dataset, in the words of `frfit inspect`.
    fn summaries<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let count = self.entries.len();
        let all = self.with(py, |file| {
            (0..count).map(|index| file.summary(index)).collect::<Result<Vec<Summary>, _>>()
        })?;
        let list = PyList::empty(py);
        for Summary { dataset, binary, line, function } in all {
            let one = PyDict::new(py);
            one.set_item("dataset", dataset)?;
            one.set_item("binary", binary)?;
            one.set_item("line", line)?;
            one.set_item("is_function", function.is_some())?;
            if let Some(function) = function {
                let quantities: [String; 3] = function.quantities.map(str::to_owned);
                one.set_item("id", function.id)?;
                one.set_item("function_type", function.function_type)?;
                one.set_item("response_dof", function.response)?;
                one.set_item("reference_dof", function.reference)?;
                one.set_item("points", function.points)?;
                one.set_item("even", function.even)?;
                one.set_item("range", function.range)?;
                one.set_item("data_type", function.data_type)?;
                one.set_item("quantities", quantities)?;
                one.set_item("units", function.units)?;
            }
            list.append(one)?;
        }
        Ok(list)
    }

    /// The FRFs with these numbers, from 1, as a case file gets them: values in SI units, with their noise.
    fn frfs<'py>(&self, py: Python<'py>, records: Vec<i64>) -> PyResult<Bound<'py, PyList>> {
        let bytes = self.bytes.bind(py).readonly();
        let bytes = bytes.as_slice()?;
        let frfs = at_once(py, || read_frfs(bytes, &records))?.map_err(|error| self.refuse(py, error))?;
        let list = PyList::empty(py);
        for Frf { frequency_hz, response, coherence, std, quantity, decay_per_s, .. } in frfs {
            let one = PyDict::new(py);
            one.set_item("frequency_hz", frequency_hz.into_pyarray(py))?;
            one.set_item("response", response.into_pyarray(py))?;
            one.set_item("coherence", coherence.map(|values| values.into_pyarray(py)))?;
            one.set_item("std", std.map(|values| values.into_pyarray(py)))?;
            one.set_item("quantity", quantity.map(|quantity| quantity.name()))?;
            one.set_item("decay_per_s", decay_per_s)?;
            list.append(one)?;
        }
        Ok(list)
    }

    /// The fields of `frfit.UffFunction`.
    fn function<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let function = self.with(py, |file| file.function(index))?;
        let found = PyDict::new(py);
        let missing = function.missing_points();
        let Function { header, abscissa, values } = function;
        let dof = |dof: &Dof| (dof.entity.clone(), dof.node, dof.direction);
        found.set_item("id", header.id.to_vec())?;
        found.set_item("function_type", header.function_type.number())?;
        found.set_item("response_dof", dof(&header.response))?;
        found.set_item("reference_dof", dof(&header.reference))?;
        found.set_item("double_precision", header.data_type.is_double())?;
        found.set_item("missing_points", missing)?;
        found.set_item("load_case", header.load_case)?;
        found.set_item("z_value", header.z_value)?;
        let even = match header.spacing {
            Spacing::Even { minimum, increment } => Some((minimum, increment)),
            Spacing::Uneven => None,
        };
        found.set_item("even", even)?;
        let axis = |axis: &Axis| (axis.quantity.number(), axis.label.clone(), axis.unit.clone());
        found
            .set_item("axes", [&header.abscissa, &header.ordinate, &header.denominator].map(axis).to_vec())?;
        found.set_item("abscissa", abscissa.into_pyarray(py))?;
        match values {
            Values::Real(values) => found.set_item("values", values.into_pyarray(py))?,
            Values::Complex(values) => found.set_item("values", values.into_pyarray(py))?,
        }
        Ok(found)
    }
}

/// Ordinates, real or complex.
#[derive(FromPyObject)]
enum Ordinates<'py> {
    #[pyo3(transparent)]
    Real(PyReadonlyArray1<'py, f64>),
    #[pyo3(transparent)]
    Complex(PyReadonlyArray1<'py, Complex64>),
}

/// The fields of `frfit.UffFunction`, arrays made contiguous.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Written<'py> {
    id: [String; 5],
    function_type: i32,
    response_dof: (String, i64, i32),
    reference_dof: (String, i64, i32),
    double_precision: bool,
    load_case: i64,
    z_value: f64,
    even: Option<(f64, f64)>,
    axes: [(i32, String, String); 3],
    abscissa: PyReadonlyArray1<'py, f64>,
    values: Ordinates<'py>,
}

impl Written<'_> {
    fn function(self) -> Function {
        let dof = |(entity, node, direction): (String, i64, i32)| Dof { entity, node, direction };
        let [abscissa, ordinate, denominator] = self.axes.map(|(quantity, label, unit)| Axis {
            quantity: Quantity::from_number(quantity),
            label,
            unit,
            ..Axis::default()
        });
        let header = FunctionHeader {
            id: self.id,
            function_type: FunctionType::from_number(self.function_type),
            load_case: self.load_case,
            response: dof(self.response_dof),
            reference: dof(self.reference_dof),
            data_type: if self.double_precision { DataType::RealDouble } else { DataType::RealSingle },
            spacing: match self.even {
                Some((minimum, increment)) => Spacing::Even { minimum, increment },
                None => Spacing::Uneven,
            },
            z_value: self.z_value,
            abscissa,
            ordinate,
            denominator,
            ..FunctionHeader::default()
        };
        let values = match self.values {
            Ordinates::Real(values) => Values::Real(values.as_array().to_vec()),
            Ordinates::Complex(values) => Values::Complex(values.as_array().to_vec()),
        };
        Function::new(header, self.abscissa.as_array().to_vec(), values)
    }
}

/// Writes functions as one file: complete, or not at all.
#[pyfunction]
pub(crate) fn write_uff(
    py: Python<'_>,
    path: PathBuf,
    functions: Vec<Written<'_>>,
    binary: bool,
) -> PyResult<()> {
    let form = if binary { Form::Binary { endian: Endian::Little } } else { Form::Ascii };
    let mut bytes = Vec::new();
    for function in functions.into_iter().map(Written::function) {
        let written = at_once(py, || write::function(&function, form))?;
        bytes.extend(written.map_err(|error| input(py, &InputError::in_file(&path, error)))?);
    }
    // What is written is no matter of files that were read.
    output::write_one(&path, bytes, &Reads::default()).map_err(|error| raise(py, "WriteError", &error))
}
