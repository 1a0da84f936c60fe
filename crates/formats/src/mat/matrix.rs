//! The values of a matrix.

use num_complex::Complex64 as c64;

use super::element::Element;
use super::variable::Head;
use crate::assemble::{Duplicates, Value};
use crate::bytes::Cursor;
use crate::gather::Gather;
use crate::{CoordinateMatrix, FormatError, Position};

/// Real and imaginary parts of all values; without imaginary ones zeros.
struct Parts {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Parts {
    fn read(head: &Head, cursor: &mut Cursor<'_>) -> Result<Self, FormatError> {
        let re = Element::read(cursor, "the values of a matrix")?.values();
        let im = match head.is_complex {
            true => Element::read(cursor, "the imaginary parts of a matrix")?.values(),
            false => Vec::new(),
        };
        if head.is_complex && re.len() != im.len() {
            let expected = format!("{} imaginary parts, as there are real ones", re.len());
            return Err(FormatError::byte(cursor.place(), expected, im.len().to_string()));
        }
        Ok(Self { re, im })
    }

    fn get(&self, k: usize) -> [f64; 2] {
        [self.re[k], self.im.get(k).copied().unwrap_or(0.0)]
    }
}

/// The matrix of entries: row, column (both from 0), real and imaginary part.
fn gathered(
    head: &Head,
    entries: impl Iterator<Item = (u64, u64, [f64; 2])>,
    size: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    fn of<V: Value>(
        entries: impl Iterator<Item = (u64, u64, [f64; 2])>,
        [nrows, ncols]: [u64; 2],
        name: &str,
    ) -> Result<CoordinateMatrix, FormatError> {
        let mut gather = Gather::<V>::new(nrows, ncols);
        for (row, col, parts) in entries {
            gather.push(row, col, V::from_numbers(parts), Position::File);
        }
        gather.finish(Duplicates::Refuse, name)
    }
    if head.is_complex { of::<c64>(entries, size, name) } else { of::<f64>(entries, size, name) }
}

/// A full matrix, column by column; its zeros are not stored.
pub(super) fn full(
    head: &Head,
    mut cursor: Cursor<'_>,
    size: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let place = cursor.place();
    let parts = Parts::read(head, &mut cursor)?;
    if size[0].checked_mul(size[1]) != Some(parts.re.len() as u64) {
        let expected = format!("{} x {} values", size[0], size[1]);
        return Err(FormatError::byte(place, expected, parts.re.len().to_string()));
    }
    let all = (0..parts.re.len()).filter(|&k| parts.get(k) != [0.0; 2]);
    let entries = all.map(|k| (k as u64 % size[0], k as u64 / size[0], parts.get(k)));
    gathered(head, entries, size, name)
}

/// A sparse matrix: rows, column pointers, values. Rows and values may be longer than the last pointer says.
pub(super) fn sparse(
    head: &Head,
    mut cursor: Cursor<'_>,
    size: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let place = cursor.place();
    let rows = Element::read(&mut cursor, "the rows of a sparse matrix")?.wholes().unwrap_or_default();
    let ends =
        Element::read(&mut cursor, "the column pointers of a sparse matrix")?.wholes().unwrap_or_default();
    let parts = Parts::read(head, &mut cursor)?;
    let last = ends.last().copied().unwrap_or(0);
    let is_sound = size[1].checked_add(1) == Some(ends.len() as u64)
        && ends.first() == Some(&0)
        && ends.is_sorted()
        && last <= rows.len() as u64
        && last <= parts.re.len() as u64;
    if !is_sound {
        let expected = format!(
            "{} column pointers that ascend from 0 to the number of entries",
            size[1].saturating_add(1)
        );
        let found =
            format!("{} up to {last}, with {} rows and {} values", ends.len(), rows.len(), parts.re.len());
        return Err(FormatError::byte(place, expected, found));
    }
    let columns = ends.windows(2).map(|range| range[0] as usize..range[1] as usize).enumerate();
    let entries = columns.flat_map(|(col, range)| range.map(move |k| (k, col as u64)));
    gathered(head, entries.map(|(k, col)| (rows[k], col, parts.get(k))), size, name)
}
