//! Datasets 58 and 58b.

use crate::FormatError;
use crate::uff::binary::Endian;
use crate::uff::data_type::DataType;
use crate::uff::function::{Function, Values};
use crate::uff::function_header::{Axis, Dof, FunctionHeader, Spacing};

use super::fixed::{exact_real, integer, real, spaced_text, text};
use super::{DELIMITER, Form};

/// A function as dataset 58 or 58b, in the precision of its data type.
///
/// The number of points is that of the values, whatever the header says; it and the data type agree with them
/// in a function made by [`Function::new`]. An evenly spaced abscissa is written as minimum and increment, with
/// all digits that 13 columns hold.
///
/// # Errors
///
/// Abscissa and values have different lengths, the data type is not that of the values, minimum, increment or
/// third coordinate is not finite, or a header field does not fit its columns.
pub fn function(function: &Function, form: Form) -> Result<Vec<u8>, FormatError> {
    check(function)?;
    let numbers = numbers(function);
    let data = match form {
        Form::Ascii => lines(function, &numbers).into_bytes(),
        Form::Binary { endian } => binary(function, &numbers, endian),
    };
    let mut bytes = DELIMITER.as_bytes().to_vec();
    bytes.extend(title(form, data.len()).into_bytes());
    bytes.extend(header(&function.header, function.values.len())?.into_bytes());
    bytes.extend(data);
    bytes.extend(DELIMITER.as_bytes());
    Ok(bytes)
}

fn check(function: &Function) -> Result<(), FormatError> {
    let Function { header, abscissa, values } = function;
    if abscissa.len() != values.len() {
        let expected = format!("as many abscissae as values ({})", values.len());
        return Err(FormatError::whole(expected, abscissa.len().to_string()));
    }
    if header.data_type.is_complex() != matches!(values, Values::Complex(_)) {
        let found = if header.data_type.is_complex() { "real values" } else { "complex values" };
        return Err(FormatError::whole(
            format!("values of the data type ({})", header.data_type.name()),
            found,
        ));
    }
    let (minimum, increment) = minimum_and_increment(header);
    match [minimum, increment, header.z_value].into_iter().find(|value| !value.is_finite()) {
        Some(value) => Err(FormatError::whole("a finite abscissa and third coordinate", value.to_string())),
        None => Ok(()),
    }
}

/// The numbers in the order of the file.
fn numbers(function: &Function) -> Vec<f64> {
    let is_stored = function.header.spacing == Spacing::Uneven;
    let abscissa = |k: usize| function.abscissa.get(k).copied().filter(|_| is_stored);
    match &function.values {
        Values::Real(values) => {
            values.iter().enumerate().flat_map(|(k, &y)| abscissa(k).into_iter().chain([y])).collect()
        }
        Values::Complex(values) => {
            values.iter().enumerate().flat_map(|(k, y)| abscissa(k).into_iter().chain([y.re, y.im])).collect()
        }
    }
}

/// Number of the dataset and, for a 58b, FORMAT(I6,1A1,I6,I6,I12,I12,I6,I6,I12,I12).
fn title(form: Form, length: usize) -> String {
    let byte_order = match form {
        Form::Ascii => return format!("{:6}\n", 58),
        Form::Binary { endian: Endian::Little } => 1,
        Form::Binary { endian: Endian::Big } => 2,
    };
    let (ieee, header_lines) = (2, 11);
    format!("{:6}b{byte_order:6}{ieee:6}{header_lines:12}{length:12}{:6}{:6}{:12}{:12}\n", 58, 0, 0, 0, 0)
}

/// Records 1–11.
fn header(header: &FunctionHeader, points: usize) -> Result<String, FormatError> {
    let mut lines = String::new();
    for id in &header.id {
        lines += &text(id, 80, "an ID line")?;
        lines += "\n";
    }
    lines += &integer(header.function_type.number().into(), 5, "a function type")?;
    lines += &integer(header.function_id, 10, "a function identification number")?;
    lines += &integer(header.version.into(), 5, "a version number")?;
    lines += &integer(header.load_case, 10, "a load case number")?;
    lines += &dof(&header.response)?;
    lines += &dof(&header.reference)?;
    lines += "\n";
    let (minimum, increment) = minimum_and_increment(header);
    lines += &integer(header.data_type.number(), 10, "a data type")?;
    lines += &integer(i64::try_from(points).unwrap_or(i64::MAX), 10, "a number of points")?;
    lines += &integer((header.spacing != Spacing::Uneven).into(), 10, "an abscissa spacing")?;
    lines += &[minimum, increment, header.z_value].map(exact_real).concat();
    lines += "\n";
    for axis_of in [&header.abscissa, &header.ordinate, &header.denominator, &header.z_axis] {
        lines += &axis(axis_of)?;
    }
    Ok(lines)
}

fn minimum_and_increment(header: &FunctionHeader) -> (f64, f64) {
    match header.spacing {
        Spacing::Even { minimum, increment } => (minimum, increment),
        Spacing::Uneven => (0.0, 0.0),
    }
}

/// Half of record 6: FORMAT(1X,10A1,I10,I4).
fn dof(dof: &Dof) -> Result<String, FormatError> {
    let entity = spaced_text(&dof.entity, 10, "an entity name")?;
    let node = integer(dof.node, 10, "a node label")?;
    Ok(entity + &node + &integer(dof.direction.into(), 4, "a direction")?)
}

/// Records 8–11: FORMAT(I10,3I5,2(1X,20A1)).
fn axis(axis: &Axis) -> Result<String, FormatError> {
    let mut line = integer(axis.quantity.number().into(), 10, "a specific data type")?;
    for exponent in [axis.length_exponent, axis.force_exponent, axis.temperature_exponent] {
        line += &integer(exponent.into(), 5, "a unit exponent")?;
    }
    line += &spaced_text(&axis.label, 20, "an axis label")?;
    line += &spaced_text(&axis.unit, 20, "a unit label")?;
    Ok(line + "\n")
}

/// Record 12 as text.
fn lines(function: &Function, numbers: &[f64]) -> String {
    let single: fn(f64) -> String = |value| real(value, 13, 5);
    let double: fn(f64) -> String = |value| real(value, 20, 12);
    let (data_type, spacing) = (function.header.data_type, function.header.spacing);
    let fields: &[fn(f64) -> String] = match (data_type, spacing) {
        (DataType::RealSingle | DataType::ComplexSingle, _) => &[single; 6],
        (DataType::RealDouble | DataType::ComplexDouble, Spacing::Even { .. }) => &[double; 4],
        (DataType::RealDouble, Spacing::Uneven) => &[single, double, single, double],
        (DataType::ComplexDouble, Spacing::Uneven) => &[single, double, double],
    };
    let line = |numbers: &[f64]| -> String {
        let written = numbers.iter().zip(fields).map(|(&number, field)| field(number));
        written.chain(["\n".to_owned()]).collect()
    };
    numbers.chunks(fields.len()).map(line).collect()
}

/// Record 12 as IEEE 754 numbers.
fn binary(function: &Function, numbers: &[f64], endian: Endian) -> Vec<u8> {
    let is_double = function.header.data_type.is_double();
    match (is_double, endian) {
        (true, Endian::Little) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
        (true, Endian::Big) => numbers.iter().flat_map(|number| number.to_be_bytes()).collect(),
        (false, Endian::Little) => numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect(),
        (false, Endian::Big) => numbers.iter().flat_map(|&number| (number as f32).to_be_bytes()).collect(),
    }
}
