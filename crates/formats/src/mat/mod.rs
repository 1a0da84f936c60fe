//! MATLAB's files of variables (.mat), versions 5, 6 and 7.
//!
//! A file is a header of 128 bytes and then one data element for each variable: a tag (type, number of bytes) and
//! the data, of version 7 compressed. A matrix is an element of elements: flags, dimensions, name, and then the values
//! of a full matrix by columns, or rows, column pointers and values of a sparse one; imaginary parts are apart. Values are stored
//! as the smallest type that holds them.
//!
//! [`write()`] writes sparse matrices as version 5 has them.
//!
//! # Limits
//! Read are full and sparse numeric matrices, real and complex, and those in the fields of a structure, as
//! `model.K`. Whole numbers beyond 2⁵³ are rounded. Whatever else a variable is (a text, a cell array, an object, an
//! array of structures, one in another) is refused by its name. Files of version 7.3 are HDF5 and are refused with the remedy; those of
//! version 4 are not known.
//!
//! # Source
//! The MathWorks, "MAT-File Format" (R2019a), chapter 1: Level 5 MAT-files.

mod head;
mod matrix;
mod stream;
mod variable;
mod write;

use std::io::Read;

use flate2::read::ZlibDecoder;

use crate::inflated::Allowance;
use crate::uff::Endian;
use crate::{FormatError, NamedMatrix};
use stream::{Kind, Stream};
pub use write::write;

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
/// one whose parts contradict each other, is refused alone.
///
/// # Limits
/// Memory is bounded by the numbers that are there, not by what tags say. A compressed variable is inflated as far as its
/// tag declares. What is kept of full matrices (entries that are not zero, 16 bytes each, and no matrix counts more than it
/// declares) may take 16 × the size of the file + 1 MB, the vectors of sparse matrices 128 × + 1 MB: what is beyond is
/// refused, and is read where it is saved uncompressed (`-v6`).
pub fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let endian = match version(bytes) {
        Some((endian, 0x100)) => endian,
        Some(_) => {
            let found = "one of version 7.3 (HDF5): save it with save('file.mat', ..., '-v7')";
            return Err(FormatError::whole("a MATLAB file of version 5, 6 or 7", found));
        }
        None => return Err(FormatError::whole("a MATLAB file of version 5, 6 or 7", "no header of one")),
    };
    let mut allowance = Allowance::of(bytes.len());
    let mut matrices = Vec::new();
    let mut at = HEADER;
    while at < bytes.len() {
        let mut input = &bytes[at..];
        let range = [at as u64, bytes.len() as u64];
        let mut stream = Stream::new(&mut input, range, endian, &mut allowance);
        let tag = stream.tag("a variable")?;
        match tag.kind {
            Kind::Compressed => {
                let place = stream.place();
                let end = place + usize::try_from(tag.length).unwrap_or(usize::MAX);
                inflated(&bytes[place..end], place, endian, &mut allowance, &mut matrices)
                    .map_err(|error| at_variable(place, error))?;
                at = end;
            }
            kind => {
                stream.inside(tag, |inside| match kind {
                    Kind::Matrix => variable::read(inside, &mut matrices),
                    // Elements of other kinds are no variables.
                    _ => Ok(()),
                })?;
                at = stream.place();
            }
        }
    }
    Ok(matrices)
}

/// Reads a variable from what its bytes inflate to, as far as it is needed.
fn inflated(
    packed: &[u8],
    place: usize,
    endian: Endian,
    allowance: &mut Allowance,
    matrices: &mut Vec<NamedMatrix>,
) -> Result<(), FormatError> {
    const TAG: u64 = 8;
    let mut input = ZlibDecoder::new(packed);
    let tag = Stream::new(&mut (&mut input).take(TAG), [0, u64::MAX], endian, allowance).tag("a variable")?;
    if tag.kind != Kind::Matrix {
        return Ok(());
    }
    let first = matrices.len();
    let mut stream = Stream::new(&mut input, [TAG, TAG + tag.length], endian, allowance);
    variable::read(&mut stream, matrices)?;
    // Places within what was unpacked mean nothing to whoever has the file.
    let mut is_sound = true;
    for named in &mut matrices[first..] {
        named.matrix = std::mem::replace(&mut named.matrix, Err(FormatError::whole("", "")))
            .map_err(|error| at_variable(place, error));
        is_sound &= named.matrix.is_ok();
    }
    // What is refused need not be inflated to its end.
    if is_sound { stream.ends() } else { Ok(()) }
}

/// An error with the place of the compressed variable.
fn at_variable(place: usize, error: FormatError) -> FormatError {
    match error.position {
        crate::Position::File => error,
        _ => FormatError { position: crate::Position::Byte(place), ..error },
    }
}
