//! The reader.

use super::Lvm;
use super::fields::is_empty;
use super::file_header::file_header;
use super::rows::rows;
use super::segment_header::segment_header;
use crate::FormatError;
use crate::text::Lines;

/// Reads a LabVIEW measurement file.
///
/// # Errors
/// No first line `LabVIEW Measurement`; a header without its end; a segment without channels, without a line of
/// names, without a `Delta_X` where there is no column of X; a cell that is no finite number with the file's
/// decimal sign; fewer samples than a header says; no segment.
///
/// # Limits
/// A file whose names are not UTF-8 is read with � in them. `X_Columns` that is missing counts as `No`.
pub fn read(bytes: &[u8]) -> Result<Lvm, FormatError> {
    let mut lines = Lines::new(bytes);
    let (mut file, x_columns) = file_header(&mut lines)?;
    let separator = file.separator.byte();
    while let Some(first) = lines.find(|line| !is_empty(line, separator)) {
        let announced = segment_header(first, &mut lines, &file, x_columns)?;
        let segment = rows(announced, &mut lines, &file, x_columns)?;
        file.segments.push(segment);
    }
    match file.segments.is_empty() {
        true => Err(FormatError::whole("a segment with channels", "the file's header alone")),
        false => Ok(file),
    }
}
