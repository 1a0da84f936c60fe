//! A sparse matrix as `scipy.sparse.save_npz` lays it out.

use std::collections::BTreeMap;

use num_complex::Complex64 as c64;

use super::array::Array;
use super::{ArchiveWriter, Files};
use crate::assemble::{Duplicates, Value};
use crate::columns::CompressedColumns;
use crate::gather::Gather;
use crate::{CoordinateMatrix, FormatError, Position};

/// Writes a matrix as `scipy.sparse.save_npz` does one in compressed columns, both triangles of a symmetric one; `scipy.sparse.load_npz` reads it.
///
/// # Errors
/// A matrix that breaks [`CoordinateMatrix::validate`], is a pattern, or has rows or entries beyond 32 bits.
pub fn write(matrix: &CoordinateMatrix) -> Result<Vec<u8>, FormatError> {
    let CompressedColumns { rows, ends, re, im } = CompressedColumns::of(matrix)?;
    let mut archive = ArchiveWriter::default();
    archive.text("format", "csc")?;
    archive.whole("shape", &[matrix.nrows as i32, matrix.ncols as i32])?;
    archive.whole("indices", &rows)?;
    archive.whole("indptr", &ends)?;
    match im {
        None => archive.real("data", &[re.len()], &re)?,
        Some(im) => archive.complex("data", &re, &im)?,
    }
    archive.finish()
}

/// Whether these are the arrays of a sparse matrix.
pub(super) fn is_one(names: &BTreeMap<String, usize>) -> bool {
    ["format", "shape", "data"].iter().all(|name| names.contains_key(*name))
}

/// The matrix; entries at one position are summed.
pub(super) fn matrix(files: &mut Files<'_>) -> Result<CoordinateMatrix, FormatError> {
    let format = files.array("format")?.text().unwrap_or_default();
    let data = files.array("data")?;
    if data.is_complex() { read::<c64>(files, &format, &data) } else { read::<f64>(files, &format, &data) }
}

fn read<V: Value>(
    files: &mut Files<'_>,
    format: &str,
    data: &Array,
) -> Result<CoordinateMatrix, FormatError> {
    let size = wholes(&files.array("shape")?, "shape")?;
    let &[nrows, ncols] = size.as_slice() else {
        return Err(FormatError::whole("a shape of rows and columns", format!("{size:?}")));
    };
    let mut gather = Gather::<V>::new(nrows, ncols);
    let mut push = |row: u64, col: u64, k: usize| {
        let value = data.value(k);
        gather.push(row, col, V::from_numbers([value.re, value.im]), Position::File);
    };
    match format {
        "csr" | "csc" | "bsr" => {
            let major = if format == "csc" { ncols } else { nrows };
            let blocks = match (format, data.shape()) {
                ("bsr", &[count, rows, cols]) if rows > 0 && cols > 0 => {
                    Some((count, [rows as usize, cols as usize]))
                }
                ("csr" | "csc", &[count]) => Some((count, [1, 1])),
                _ => None,
            };
            let (count, [rows, cols]) = blocks.ok_or_else(|| contradiction(format, "data", data))?;
            let (indices, pointers) = (files.array("indices")?, files.array("indptr")?);
            let (minors, ends) = (wholes(&indices, "indices")?, wholes(&pointers, "indptr")?);
            // Beyond the last pointer arrays may be longer.
            let is_sound = ends.first() == Some(&0)
                && Some(ends.len() as u64) == (major / rows as u64).checked_add(1)
                && ends.is_sorted()
                && ends.last().is_some_and(|&last| last <= count && last <= minors.len() as u64);
            if !is_sound {
                return Err(contradiction(format, "indptr", &pointers));
            }
            for (k, range) in ends.windows(2).enumerate() {
                let (start, end) = (range[0] as usize, range[1] as usize);
                for (entry, &minor) in (start..end).zip(&minors[start..end]) {
                    let major = k as u64;
                    match format {
                        "csc" => push(minor, major, entry),
                        "csr" => push(major, minor, entry),
                        _ => (0..rows).flat_map(|i| (0..cols).map(move |j| (i, j))).for_each(|(i, j)| {
                            let row = major * rows as u64 + i as u64;
                            let col = minor.saturating_mul(cols as u64).saturating_add(j as u64);
                            let k = data.at(&[entry, i, j]);
                            // A block stores its zeros too.
                            if data.value(k) != c64::default() {
                                push(row, col, k);
                            }
                        }),
                    }
                }
            }
        }
        "coo" => {
            let (rows, cols) = match files.names.contains_key("row") {
                true => (wholes(&files.array("row")?, "row")?, wholes(&files.array("col")?, "col")?),
                false => coordinates(&files.array("coords")?)?,
            };
            if rows.len() != data.count() || cols.len() != data.count() || data.shape().len() != 1 {
                return Err(contradiction(format, "data", data));
            }
            rows.iter().zip(&cols).enumerate().for_each(|(k, (&row, &col))| push(row, col, k));
        }
        "dia" => {
            let offsets = files.array("offsets")?;
            let &[diagonals, length] = data.shape() else { return Err(contradiction(format, "data", data)) };
            if offsets.shape() != [diagonals] {
                return Err(contradiction(format, "offsets", &offsets));
            }
            for diagonal in 0..diagonals as usize {
                let offset =
                    offsets.whole(diagonal).ok_or_else(|| contradiction(format, "offsets", &offsets))?;
                // Column j of a diagonal is in row j - offset; what is outside of the matrix does not count.
                for col in 0..length.min(ncols) {
                    let row = i128::from(col) - i128::from(offset);
                    if let Some(row) = u64::try_from(row).ok().filter(|row| *row < nrows) {
                        let k = data.at(&[diagonal, col as usize]);
                        if data.value(k) != c64::default() {
                            push(row, col, k);
                        }
                    }
                }
            }
        }
        _ => {
            let expected = "a sparse matrix of format csr, csc, coo, bsr or dia";
            return Err(FormatError::whole(expected, format!("{format:?}")));
        }
    }
    gather.finish(Duplicates::Sum, "")
}

/// The numbers of a vector, each whole and not negative.
fn wholes(array: &Array, name: &str) -> Result<Vec<u64>, FormatError> {
    let refuse =
        |found: String| FormatError::whole(format!("whole numbers from 0 in the vector {name:?}"), found);
    if array.shape().len() != 1 {
        return Err(refuse(array.header.described()));
    }
    let whole = |k| array.whole(k).and_then(|number| u64::try_from(number).ok());
    (0..array.count()).map(|k| whole(k).ok_or_else(|| refuse(format!("another at {k}")))).collect()
}

/// Rows and columns of an array of two rows.
fn coordinates(array: &Array) -> Result<(Vec<u64>, Vec<u64>), FormatError> {
    let refuse =
        || FormatError::whole("whole numbers from 0 in two rows of \"coords\"", array.header.described());
    let &[2, count] = array.shape() else { return Err(refuse()) };
    let whole = |row, k| array.whole(array.at(&[row, k])).and_then(|number| u64::try_from(number).ok());
    let line = |row| (0..count as usize).map(|k| whole(row, k).ok_or_else(refuse)).collect::<Result<_, _>>();
    Ok((line(0)?, line(1)?))
}

fn contradiction(format: &str, name: &str, array: &Array) -> FormatError {
    let expected = format!("an array {name:?} that fits to the others of a matrix of format {format}");
    FormatError::whole(expected, array.header.described())
}
