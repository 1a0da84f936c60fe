//! The binary form: Fortran records, each with its length before and after it.

use num_complex::Complex64 as c64;

use super::header::{HEAD, Header, ROW, StringHead};
use crate::assemble::Value;
use crate::bytes::{Cursor, Storage};
use crate::gather::Gather;
use crate::uff::Endian;
use crate::{FormatError, NamedMatrix, Position};

/// Order and width of the integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    endian: Endian,
    /// Integers and words of 8 bytes.
    is_wide: bool,
}

impl Layout {
    /// By the first record, whose length is known; `None` where that is no record of OUTPUT4.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let layouts =
            [(Endian::Little, false), (Endian::Big, false), (Endian::Little, true), (Endian::Big, true)];
        layouts.into_iter().map(|(endian, is_wide)| Self { endian, is_wide }).find(|layout| {
            let mut cursor = Cursor::new(bytes, 0, layout.endian);
            layout.record(&mut cursor).is_ok_and(|mut record| layout.header(&mut record).is_some())
        })
    }

    /// Bytes of a word.
    fn word(self) -> u64 {
        if self.is_wide { 8 } else { 4 }
    }

    fn whole(self, cursor: &mut Cursor<'_>, name: &str) -> Result<i64, FormatError> {
        if self.is_wide { cursor.i64(name) } else { cursor.i32(name).map(i64::from) }
    }

    fn record<'a>(self, cursor: &mut Cursor<'a>) -> Result<Cursor<'a>, FormatError> {
        let length = cursor.u32("the length of a record")?;
        let record = cursor.part(length.into(), "a record")?;
        let end = cursor.place();
        match cursor.u32("the length of a record behind it")? {
            again if again == length => Ok(record),
            again => {
                let expected = format!("{length}, the length of the record that ends here");
                Err(FormatError::byte(end, expected, again.to_string()))
            }
        }
    }

    /// Of a record that is a header; it holds four integers and a name of two words.
    fn header(self, record: &mut Cursor<'_>) -> Option<Header> {
        if record.left() as u64 != 6 * self.word() {
            return None;
        }
        let mut numbers = [0; 4];
        for value in &mut numbers {
            *value = self.whole(record, "a size").ok()?;
        }
        let name = record.take(2 * self.word(), "a name").ok()?;
        let is_name = name.iter().all(|byte| byte.is_ascii_graphic() || b" \0".contains(byte));
        if is_name { Header::new(numbers, name) } else { None }
    }
}

pub(super) fn read(bytes: &[u8], layout: Layout) -> Result<Vec<NamedMatrix>, FormatError> {
    let mut cursor = Cursor::new(bytes, 0, layout.endian);
    let mut matrices = Vec::new();
    while cursor.left() > 0 {
        let place = cursor.place();
        let mut record = layout.record(&mut cursor)?;
        let header = layout.header(&mut record).ok_or_else(|| {
            let expected = "the header of a matrix: columns, rows, form, type (1 to 4), name";
            FormatError::byte(place, expected, "another record")
        })?;
        matrices.push(match header.is_complex() {
            true => matrix::<c64>(&header, layout, &mut cursor)?,
            false => matrix::<f64>(&header, layout, &mut cursor)?,
        });
    }
    Ok(matrices)
}

fn matrix<V: Value>(
    header: &Header,
    layout: Layout,
    cursor: &mut Cursor<'_>,
) -> Result<NamedMatrix, FormatError> {
    let mut gather = Gather::<V>::new(header.nrows, header.ncols);
    loop {
        let mut record = layout.record(cursor)?;
        let place = record.place();
        let positive = |record: &mut Cursor<'_>, least: i64, name: &str| {
            let value = layout.whole(record, name)?;
            let refuse = || FormatError::byte(place, format!("{name} from {least}"), value.to_string());
            u64::try_from(value).ok().filter(|_| value >= least).ok_or_else(refuse)
        };
        let col = positive(&mut record, 1, "a column")?;
        let row = positive(&mut record, 0, "a first row")?;
        let words = positive(&mut record, 0, "a number of words")?;
        if col > header.ncols {
            return Ok(header.named(gather));
        }
        let (at, mut values) = (record.place(), Values { header, layout, col, gather: &mut gather });
        if row > 0 {
            values.take(&mut record, row, words, at)?;
            continue;
        }
        let mut left = words;
        while left > 0 {
            let at = record.place();
            let first = layout.whole(&mut record, HEAD)?;
            let head = match header.is_bigmat {
                true => StringHead::of_two(first, layout.whole(&mut record, HEAD)?),
                false => StringHead::of_one(first),
            };
            let head = head.ok_or_else(|| FormatError::byte(at, HEAD, first.to_string()))?;
            let row = head.row().ok_or_else(|| FormatError::byte(at, ROW, head.row.to_string()))?;
            left = head.leaves(left).ok_or_else(|| {
                let expected = format!("a string within the {words} words of its column");
                FormatError::byte(at, expected, head.words.to_string())
            })?;
            values.take(&mut record, row, head.words, at)?;
        }
    }
}

/// The values of a column on their way.
struct Values<'h, 'g, V> {
    header: &'h Header,
    layout: Layout,
    col: u64,
    gather: &'g mut Gather<V>,
}

impl<V: Value> Values<'_, '_, V> {
    /// So many words from a row (from 1) on. `at` is where their number is written.
    fn take(&mut self, record: &mut Cursor<'_>, row: u64, words: u64, at: usize) -> Result<(), FormatError> {
        let Layout { endian, is_wide } = self.layout;
        // With words of 8 bytes both precisions are one word.
        let number = Storage::Float(if self.header.is_double() || is_wide { 8 } else { 4 });
        let size = number.size() * V::NUMBERS;
        let words_a_value = size as u64 / self.layout.word();
        if !words.is_multiple_of(words_a_value) {
            let expected = format!("{words_a_value} words for each value");
            return Err(FormatError::byte(at, expected, format!("{words} words")));
        }
        let start = record.place();
        let bytes = record.take(words.saturating_mul(self.layout.word()), "the values of a column")?;
        for (k, value) in bytes.chunks_exact(size).enumerate() {
            let mut parts = [0.0; 2];
            for (part, bytes) in parts.iter_mut().zip(value.chunks_exact(number.size())) {
                *part = number.value(bytes, endian);
            }
            // A dense column stores its zeros too.
            if parts != [0.0; 2] {
                let place = Position::Byte(start + k * size);
                self.gather.push(
                    (row - 1).saturating_add(k as u64),
                    self.col - 1,
                    V::from_numbers(parts),
                    place,
                );
            }
        }
        Ok(())
    }
}
