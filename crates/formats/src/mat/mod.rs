//! MATLAB's files of variables (.mat), versions 5, 6 and 7.
//!
//! A file is a header of 128 bytes and then one data element for each variable: a tag (type, number of bytes) and
//! the data, of version 7 compressed. A matrix is an element of elements: flags, dimensions, name, and then the values
//! of a full matrix by columns, or rows, column pointers and values of a sparse one; imaginary parts are apart. Values are stored
//! as the smallest type that holds them.
//!
//! # Limits
//! Read are full and sparse numeric matrices, real and complex, and those in the fields of a structure, as
//! `model.K`. Whole numbers beyond 2⁵³ are rounded. Whatever else a variable is (a text, a cell array, an object, an
//! array of structures, one in another) is refused by its name. Files of version 7.3 are HDF5 and are refused with what to do; those of
//! version 4 are not known.
//!
//! # Source
//! The MathWorks, "MAT-File Format" (R2019a), chapter 1: Level 5 MAT-files.

mod element;
mod matrix;
mod variable;

use std::io::Read;

use flate2::read::ZlibDecoder;

use crate::bytes::Cursor;
use crate::uff::Endian;
use crate::{FormatError, NamedMatrix};
use element::{Element, Kind};

const HEADER: usize = 128;

/// The order of the bytes and the version, which are at the end of the header.
fn version(bytes: &[u8]) -> Option<(Endian, u16)> {
    let (endian, version) = match *bytes.get(HEADER - 4..HEADER)? {
        [low, high, b'I', b'M'] => (Endian::Little, u16::from_le_bytes([low, high])),
        [high, low, b'M', b'I'] => (Endian::Big, u16::from_be_bytes([high, low])),
        _ => return None,
    };
    matches!(version, 0x100 | 0x200).then_some((endian, version))
}

/// Whether the file has the header of version 5 or of 7.3.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    version(bytes).is_some()
}

/// Reads all variables of a file, each field of a structure as one of its own.
///
/// # Errors
/// A file of version 7.3; an element that ends beyond the file or cannot be unpacked. A variable that is no matrix, or
/// one whose parts contradict each other, is refused by itself.
///
/// # Limits
/// Memory is bounded by the numbers that are there (of version 7: once they are unpacked), not by what tags say.
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let endian = match version(bytes) {
        Some((endian, 0x100)) => endian,
        Some(_) => {
            let found = "one of version 7.3 (HDF5): save it with save('file.mat', ..., '-v7')";
            return Err(FormatError::whole("a MATLAB file of version 5, 6 or 7", found));
        }
        None => return Err(FormatError::whole("a MATLAB file of version 5, 6 or 7", "no header of one")),
    };
    let mut cursor = Cursor::new(&bytes[HEADER..], HEADER, endian);
    let mut matrices = Vec::new();
    while cursor.left() > 0 {
        let place = cursor.place();
        let element = Element::read(&mut cursor, "a variable")?;
        match element.kind {
            Kind::Matrix => variable::read(element.data, &mut matrices)?,
            Kind::Compressed => {
                let bytes = unpacked(element.data)?;
                let mut inside = Cursor::new(&bytes, 0, endian);
                // Places within what was unpacked mean nothing to whoever has the file.
                let element = Element::read(&mut inside, "a variable").map_err(|error| at(place, error))?;
                if element.kind == Kind::Matrix {
                    let first = matrices.len();
                    variable::read(element.data, &mut matrices).map_err(|error| at(place, error))?;
                    for named in &mut matrices[first..] {
                        named.matrix = std::mem::replace(&mut named.matrix, Err(FormatError::whole("", "")))
                            .map_err(|error| at(place, error));
                    }
                }
            }
            // Elements of other kinds are no variables.
            Kind::Numbers(_) | Kind::Other(_) => {}
        }
    }
    Ok(matrices)
}

/// An error with the place of the compressed variable.
fn at(place: usize, error: FormatError) -> FormatError {
    match error.position {
        crate::Position::File => error,
        _ => FormatError { position: crate::Position::Byte(place), ..error },
    }
}

fn unpacked(mut packed: Cursor<'_>) -> Result<Vec<u8>, FormatError> {
    let place = packed.place();
    let mut bytes = Vec::new();
    let data = packed.take(packed.left() as u64, "a compressed variable")?;
    ZlibDecoder::new(data)
        .read_to_end(&mut bytes)
        .map_err(|error| FormatError::byte(place, "a compressed variable", error.to_string()))?;
    Ok(bytes)
}
