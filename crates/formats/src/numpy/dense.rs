//! A matrix from a dense array.

use std::io::Read;

use num_complex::Complex64 as c64;

use super::header::{Element, Header};
use crate::assemble::{Duplicates, Value};
use crate::gather::Gather;
use crate::inflated::{Allowance, fill};
use crate::{CoordinateMatrix, FormatError, Position};

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 16;

/// An array of two dimensions whose elements are read from `input` as they come; its zeros are not stored.
///
/// `name` is that of the array, for errors.
pub(super) fn matrix(
    header: &Header,
    input: &mut dyn Read,
    allowance: &mut Allowance,
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let refuse = |found: String| Err(FormatError::whole("an array of numbers with rows and columns", found));
    match *header.shape {
        _ if matches!(header.element, Element::Text { .. }) => refuse("an array of texts".into()),
        [nrows, ncols] if matches!(header.element, Element::Complex(_)) => {
            of::<c64>(header, input, allowance, [nrows, ncols], name)
        }
        [nrows, ncols] => of::<f64>(header, input, allowance, [nrows, ncols], name),
        _ => refuse(header.described()),
    }
}

fn of<V: Value>(
    header: &Header,
    input: &mut dyn Read,
    allowance: &mut Allowance,
    [nrows, ncols]: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let declared = header.declared(name)?;
    allowance.inflate(declared)?;
    let broken = |error: std::io::Error| {
        FormatError::whole(format!("an array {name:?} in the archive"), error.to_string())
    };
    let mut left = declared;
    let mut gather = Gather::<V>::new(nrows, ncols);
    let size = header.element.size();
    // A whole number of elements, since their sizes are powers of two.
    let mut chunk = [0; CHUNK];
    let mut at = 0;
    while at < declared {
        let wanted = (declared - at).min(CHUNK as u64) as usize;
        let got = fill(input, &mut chunk[..wanted]).map_err(broken)?;
        if got < wanted {
            return Err(header.wrong_length(declared, &(at + got as u64).to_string(), name));
        }
        let first = at / size as u64;
        for (k, bytes) in (first..).zip(chunk[..got].chunks_exact(size)) {
            let value = header.value(bytes);
            if value == c64::default() {
                continue;
            }
            let (row, col) = match header.is_fortran {
                true => (k % nrows, k / nrows),
                false => (k / ncols, k % ncols),
            };
            allowance.entry(&mut left)?;
            gather.push(row, col, V::from_numbers([value.re, value.im]), Position::File);
        }
        at += got as u64;
    }
    // The end is read too: there an archive compares its checksum.
    if fill(input, &mut chunk[..1]).map_err(broken)? > 0 {
        return Err(header.wrong_length(declared, "more", name));
    }
    gather.finish(Duplicates::Refuse, name)
}
