//! The data of a dataset 58 or 58b.

use crate::FormatError;

use super::binary;
use super::data_lines;
use super::data_type::DataType;
use super::entry::Entry;
use super::function::Function;
use super::function_header::{FunctionHeader, Spacing};
use super::read_header::function_header;

/// Reads header and data of the function at this place of the file.
pub(super) fn function(file: &[u8], entry: &Entry) -> Result<Function, FormatError> {
    let mut lines = entry.lines(file);
    let header = function_header(&mut lines)?;
    let numbers = match entry.binary {
        None => {
            let wanted = header.points.saturating_mul(header.numbers_per_point());
            data_lines::numbers(lines, field_widths(&header), wanted)?
        }
        Some(form) => {
            let data = lines.rest();
            binary::numbers(&header, form, data, entry.body.end.saturating_sub(data.len()))?
        }
    };
    Ok(Function::from_numbers(header, numbers))
}

/// Record 12: 6E13.5 in single precision, 4E20.12 in double; the abscissa is always E13.5.
pub(super) fn field_widths(header: &FunctionHeader) -> &'static [usize] {
    match (header.data_type, header.spacing) {
        (DataType::RealSingle | DataType::ComplexSingle, _) => &[13],
        (DataType::RealDouble | DataType::ComplexDouble, Spacing::Even { .. }) => &[20],
        (DataType::RealDouble, Spacing::Uneven) => &[13, 20],
        (DataType::ComplexDouble, Spacing::Uneven) => &[13, 20, 20],
    }
}
