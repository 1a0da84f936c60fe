//! A matrix from a dense array.

use num_complex::Complex64 as c64;

use super::array::Array;
use crate::assemble::{Duplicates, Value};
use crate::gather::Gather;
use crate::{CoordinateMatrix, FormatError, Position};

/// An array of two dimensions; its zeros are not stored.
pub(super) fn matrix(array: &Array<'_>, name: &str) -> Result<CoordinateMatrix, FormatError> {
    let refuse = |found: String| Err(FormatError::whole("an array of numbers with rows and columns", found));
    match *array.shape() {
        _ if array.is_text() => refuse("an array of texts".into()),
        [nrows, ncols] if array.is_complex() => of::<c64>(array, nrows, ncols, name),
        [nrows, ncols] => of::<f64>(array, nrows, ncols, name),
        _ => refuse(array.header.described()),
    }
}

fn of<V: Value>(
    array: &Array<'_>,
    nrows: u64,
    ncols: u64,
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let mut gather = Gather::<V>::new(nrows, ncols);
    for k in 0..array.count() {
        let value = array.value(k);
        let (row, col) = match array.header.is_fortran {
            true => (k as u64 % nrows, k as u64 / nrows),
            false => (k as u64 / ncols, k as u64 % ncols),
        };
        if value != c64::default() {
            gather.push(row, col, V::from_numbers([value.re, value.im]), Position::File);
        }
    }
    gather.finish(Duplicates::Refuse, name)
}
