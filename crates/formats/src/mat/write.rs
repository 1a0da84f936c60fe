//! The writer: sparse matrices of version 5, uncompressed.

use super::HEADER;
use crate::columns::CompressedColumns;
use crate::{CoordinateMatrix, FormatError};

const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const SPARSE: u32 = 5;
const COMPLEX: u32 = 0x800;
/// The longest name that MATLAB takes.
const MAX_NAME: usize = 63;

/// Writes matrices with names as sparse variables of doubles, both triangles of a symmetric one. MATLAB 5 and later, Octave and SciPy read them.
///
/// # Errors
/// A name that is not a letter and up to 62 letters, digits and underscores; a matrix that breaks [`CoordinateMatrix::validate`],
/// is a pattern, or has rows or entries beyond 32 bits; a variable beyond 4 GB.
pub fn write(matrices: &[(&str, &CoordinateMatrix)]) -> Result<Vec<u8>, FormatError> {
    let mut out = b"MATLAB 5.0 MAT-file, written by frfit".to_vec();
    out.resize(HEADER - 12, b' ');
    // No data of subsystems; version 1; the order of the bytes.
    out.extend([0; 8]);
    out.extend([0x00, 0x01, b'I', b'M']);
    for (name, matrix) in matrices {
        let is_name = name.len() <= MAX_NAME
            && name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name {
            let expected = "a name of a letter and up to 62 letters, digits and underscores";
            return Err(FormatError::whole(expected, format!("{name:?}")));
        }
        let variable = variable(name, matrix)?;
        let too_large =
            || FormatError::whole("a matrix of less than 4 GB", format!("{} bytes", variable.len()));
        let length = u32::try_from(variable.len()).map_err(|_| too_large())?;
        tag(&mut out, MATRIX, length);
        out.extend(variable);
    }
    Ok(out)
}

fn variable(name: &str, matrix: &CoordinateMatrix) -> Result<Vec<u8>, FormatError> {
    let CompressedColumns { rows, ends, re, im } = CompressedColumns::of(matrix)?;
    // A number of entries of 0 is read by few programs.
    let room = u32::try_from(rows.len().max(1)).unwrap_or(u32::MAX);
    let flags = SPARSE | if im.is_some() { COMPLEX } else { 0 };
    let mut out = Vec::new();
    element(&mut out, UINT32, &[flags, room].map(u32::to_le_bytes).concat());
    let sizes = [matrix.nrows as i32, matrix.ncols as i32];
    element(&mut out, INT32, &sizes.map(i32::to_le_bytes).concat());
    element(&mut out, INT8, name.as_bytes());
    let wholes = |values: &[i32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let numbers = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    element(&mut out, INT32, &wholes(&rows));
    element(&mut out, INT32, &wholes(&ends));
    element(&mut out, DOUBLE, &numbers(&re));
    if let Some(im) = im {
        element(&mut out, DOUBLE, &numbers(&im));
    }
    Ok(out)
}

fn tag(out: &mut Vec<u8>, kind: u32, length: u32) {
    out.extend(kind.to_le_bytes());
    out.extend(length.to_le_bytes());
}

/// Data with their tag, filled up to eight bytes; a length beyond 32 bits is refused with the whole variable.
fn element(out: &mut Vec<u8>, kind: u32, data: &[u8]) {
    tag(out, kind, u32::try_from(data.len()).unwrap_or(u32::MAX));
    out.extend_from_slice(data);
    out.resize(out.len().next_multiple_of(8), 0);
}
