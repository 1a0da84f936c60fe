//! Nastran OUTPUT4: matrices with names, in text or binary, dense or sparse.
//!
//! A file is one matrix after the other: a header (columns, rows, form, type, name), then the columns that are not
//! zero, and a column beyond the last one as the end. A dense column runs from its first to its last entry; a sparse
//! one is cut into strings of consecutive rows, each with its length in words and its first row, packed into one number
//! (IS = row + 65536 (L + 1)) or, with BIGMAT (the number of rows is negative, or above 65535), in two.
//!
//! # Limits
//! Read are types 1 to 4 (real and complex, single and double); text with any E or D format; binary in Fortran
//! records of both byte orders, with integers of 4 or 8 bytes. Form 6 (symmetric) is one triangle of the result where both
//! triangles of the file are the same, or only one is there. Form 8 (identity), which may store nothing, is refused.
//! The single numbers of a file are taken as they are: 0.1 in single precision is 0.10000000149.
//!
//! # Source
//! NX Nastran DMAP Programmer's Guide, module OUTPUT4, remarks 1 to 11; MSC Nastran DMAP Programmer's Guide, the same.
//! Integers of 16 columns in the header (`|I16`) and of 8 bytes are as pyYeti's `nastran.op4` reads them.

mod ascii;
mod binary;
mod header;
mod write;

use crate::{FormatError, NamedMatrix};

pub use write::write;

/// Reads all matrices of a file.
///
/// # Errors
/// Where the file is not what its headers say. A matrix with a value that is not finite, a position outside of it
/// or one that is there twice is refused alone.
///
/// # Limits
/// Memory is bounded by the bytes that are there, not by what headers say.
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    match binary::Layout::of(bytes) {
        Some(layout) => binary::read(bytes, layout),
        None => ascii::read(bytes),
    }
}

/// Whether the file begins as one of OUTPUT4 does.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    binary::Layout::of(bytes).is_some() || ascii::is_first_line(bytes)
}
