//! The values of a matrix.

use std::iter::Peekable;
use std::vec::IntoIter;

use num_complex::Complex64 as c64;

use super::head::Head;
use super::stream::{Stream, Tag};
use crate::assemble::{Duplicates, Value};
use crate::gather::Gather;
use crate::{CoordinateMatrix, FormatError, Position};

/// How many imaginary parts there have to be.
fn check_parts(place: usize, real: u64, imaginary: u64) -> Result<(), FormatError> {
    if real == imaginary {
        return Ok(());
    }
    let expected = format!("{real} imaginary parts, as there are real ones");
    Err(FormatError::byte(place, expected, imaginary.to_string()))
}

/// Calls something with those of an element's numbers that are not zero, each with its place among them.
fn each_not_zero(
    stream: &mut Stream<'_>,
    tag: Tag,
    mut call: impl FnMut(u64, f64),
) -> Result<(), FormatError> {
    let (value, mut left) = (stream.reader(tag), tag.length);
    stream.each_number(tag, |k, bytes, allowance| {
        let value = value(bytes);
        if value != 0.0 {
            allowance.entry(&mut left)?;
            call(k, value);
        }
        Ok(())
    })
}

/// A full matrix, column by column; its zeros are not stored.
pub(super) fn full(
    head: &Head,
    stream: &mut Stream<'_>,
    size: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let place = stream.place();
    let tag = stream.tag("the values of a matrix")?;
    if size[0].checked_mul(size[1]) != Some(tag.count()) {
        let expected = format!("{} x {} values", size[0], size[1]);
        return Err(FormatError::byte(place, expected, tag.count().to_string()));
    }
    let [nrows, ncols] = size;
    if !head.is_complex {
        let mut gather = Gather::<f64>::new(nrows, ncols);
        let push = |k, value| gather.push(k % nrows, k / nrows, value, Position::File);
        each_not_zero(stream, tag, push)?;
        return gather.finish(Duplicates::Refuse, name);
    }
    let (mut re, mut im) = (Vec::new(), Vec::new());
    each_not_zero(stream, tag, |k, value| re.push((k, value)))?;
    let tag_im = stream.tag("the imaginary parts of a matrix")?;
    check_parts(stream.place(), tag.count(), tag_im.count())?;
    each_not_zero(stream, tag_im, |k, value| im.push((k, value)))?;
    let (mut re, mut im) = (re.into_iter().peekable(), im.into_iter().peekable());
    let mut gather = Gather::<c64>::new(nrows, ncols);
    while let Some(k) = [re.peek(), im.peek()].into_iter().flatten().map(|&(k, _)| k).min() {
        let at = |parts: &mut Peekable<IntoIter<(u64, f64)>>| {
            parts.next_if(|&(place, _)| place == k).map_or(0.0, |(_, value)| value)
        };
        gather.push(k % nrows, k / nrows, c64::new(at(&mut re), at(&mut im)), Position::File);
    }
    gather.finish(Duplicates::Refuse, name)
}

/// A sparse matrix: rows, column pointers, values. Rows and values may be longer than the last pointer says.
pub(super) fn sparse(
    head: &Head,
    stream: &mut Stream<'_>,
    size: [u64; 2],
    name: &str,
) -> Result<CoordinateMatrix, FormatError> {
    let place = stream.place();
    let rows = stream.wholes("the rows of a sparse matrix")?.unwrap_or_default();
    let ends = stream.wholes("the column pointers of a sparse matrix")?.unwrap_or_default();
    let tag = stream.tag("the values of a matrix")?;
    let re = stream.values(tag)?;
    let mut im = Vec::new();
    if head.is_complex {
        let tag_im = stream.tag("the imaginary parts of a matrix")?;
        check_parts(stream.place(), tag.count(), tag_im.count())?;
        im = stream.values(tag_im)?;
    }
    let last = ends.last().copied().unwrap_or(0);
    let is_sound = size[1].checked_add(1) == Some(ends.len() as u64)
        && ends.first() == Some(&0)
        && ends.is_sorted()
        && last <= rows.len() as u64
        && last <= re.len() as u64;
    if !is_sound {
        let expected = format!(
            "{} column pointers that ascend from 0 to the number of entries",
            size[1].saturating_add(1)
        );
        let found = format!("{} up to {last}, with {} rows and {} values", ends.len(), rows.len(), re.len());
        return Err(FormatError::byte(place, expected, found));
    }
    fn of<V: Value>(
        [nrows, ncols]: [u64; 2],
        ends: &[u64],
        entry: impl Fn(usize) -> (u64, [f64; 2]),
        name: &str,
    ) -> Result<CoordinateMatrix, FormatError> {
        let mut gather = Gather::<V>::new(nrows, ncols);
        for (col, range) in (0..).zip(ends.windows(2)) {
            for k in range[0] as usize..range[1] as usize {
                let (row, parts) = entry(k);
                gather.push(row, col, V::from_numbers(parts), Position::File);
            }
        }
        gather.finish(Duplicates::Refuse, name)
    }
    let entry = |k: usize| (rows[k], [re[k], im.get(k).copied().unwrap_or(0.0)]);
    if head.is_complex { of::<c64>(size, &ends, entry, name) } else { of::<f64>(size, &ends, entry, name) }
}
