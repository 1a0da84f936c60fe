//! The text form: columns of 8 characters for whole numbers, a Fortran format for the others.

use num_complex::Complex64 as c64;

use super::header::{HEAD, Header, ROW, StringHead};
use crate::assemble::Value;
use crate::gather::Gather;
use crate::text::{FINITE, Line, Lines, number, quoted};
use crate::{FormatError, NamedMatrix, Position};

/// Characters of a whole number.
const WIDTH: usize = 8;
/// The mark behind a header whose sizes have twice as many.
const WIDE: &[u8] = b"|I16";

const HEADER: &str =
    "the header of a matrix: columns, rows, form, type (1 to 4), name, format such as 1P,3E23.16";

pub(super) fn is_first_line(bytes: &[u8]) -> bool {
    Lines::new(bytes).find(|line| !line.is_blank()).is_some_and(|line| header(line).is_some())
}

pub(super) fn read(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let mut lines = Lines::new(bytes);
    let mut matrices = Vec::new();
    while let Some(line) = lines.find(|line| !line.is_blank()) {
        let (header, fields) = header(line).ok_or_else(|| line.error(0, HEADER, quoted(line.bytes)))?;
        let mut body = Body { lines, fields };
        matrices.push(match header.is_complex() {
            true => matrix::<c64>(&header, &mut body)?,
            false => matrix::<f64>(&header, &mut body)?,
        });
        lines = body.lines;
    }
    Ok(matrices)
}

/// How numbers stand in a line: so many, each so wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fields {
    in_line: usize,
    width: usize,
}

impl Fields {
    /// From a format such as `1P,3E23.16`; without one it is `5E16.9`.
    fn parse(format: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(format).ok()?.trim().to_ascii_uppercase();
        if text.is_empty() {
            return Some(Self { in_line: 5, width: 16 });
        }
        let descriptor = text.split_once('P').map_or(text.as_str(), |(_, rest)| rest.trim_start_matches(','));
        let (count, width) = descriptor.split_once(['E', 'D'])?;
        let (in_line, width) = (count.trim().parse().ok()?, width.split('.').next()?.trim().parse().ok()?);
        // A line of the format is 80 characters; more than a few hundred are no line of the format.
        let is_line = (1..=100).contains(&in_line) && (1..=100).contains(&width);
        is_line.then_some(Self { in_line, width })
    }
}

fn header(line: Line<'_>) -> Option<(Header, Fields)> {
    let bytes = line.bytes.trim_ascii_end();
    let (bytes, size) = match bytes.strip_suffix(WIDE) {
        Some(bytes) => (bytes, 2 * WIDTH),
        None => (bytes, WIDTH),
    };
    let ends = [size, 2 * size, 2 * size + WIDTH, 2 * size + 2 * WIDTH];
    let mut numbers = [0; 4];
    let mut start = 0;
    for (value, end) in numbers.iter_mut().zip(ends) {
        *value = whole(bytes.get(start..end)?)?;
        start = end;
    }
    let name = &bytes[start..bytes.len().min(start + WIDTH)];
    let format = bytes.get(start + WIDTH..).unwrap_or(&[]);
    Some((Header::new(numbers, name)?, Fields::parse(format)?))
}

/// A whole number with blanks around it.
fn whole(field: &[u8]) -> Option<i64> {
    std::str::from_utf8(field).ok()?.trim().parse().ok()
}

struct Body<'a> {
    lines: Lines<'a>,
    fields: Fields,
}

impl<'a> Body<'a> {
    fn line(&mut self, expected: &str) -> Result<Line<'a>, FormatError> {
        let at = self.lines.taken;
        self.lines.next().ok_or_else(|| FormatError::line(at, expected, "the end of the file"))
    }

    /// N whole numbers of eight characters, and the line that they are in.
    fn wholes<const N: usize>(&mut self, expected: &str) -> Result<(Line<'a>, [i64; N]), FormatError> {
        let line = self.line(expected)?;
        let mut numbers = [0; N];
        for (k, value) in numbers.iter_mut().enumerate() {
            let start = line.bytes.len().min(k * WIDTH);
            // The last one may be longer: IS of a string, which is written with 11 or 12.
            let end = if k + 1 == N { line.bytes.len() } else { line.bytes.len().min(start + WIDTH) };
            let field = &line.bytes[start..end];
            *value = whole(field).ok_or_else(|| line.error(start, expected, quoted(field.trim_ascii())))?;
        }
        Ok((line, numbers))
    }

    /// The numbers of a line, at most so many; calls `each` with the place of each.
    fn numbers(
        &self,
        line: Line<'_>,
        most: u64,
        each: &mut impl FnMut(f64, Position),
    ) -> Result<u64, FormatError> {
        let Fields { in_line, width } = self.fields;
        let in_line = in_line.min(usize::try_from(most).unwrap_or(in_line));
        let bytes = line.bytes.trim_ascii_end();
        let there = bytes.len().div_ceil(width).min(in_line);
        // Writers that do not reckon with exponents of three digits push numbers out of their columns.
        if bytes.len() > there * width {
            let expected = format!("at most {} characters in a line of {there} numbers", there * width);
            return Err(line.error(there * width, expected, bytes.len().to_string()));
        }
        for k in 0..there {
            let start = k * width;
            let field = bytes[start..bytes.len().min(start + width)].trim_ascii();
            let value = number(field).filter(|_| field.contains(&b'.')).ok_or_else(|| {
                let expected = format!("{FINITE} with a point in columns {} to {}", start + 1, start + width);
                line.error(start, expected, quoted(field))
            })?;
            each(value, Position::Line { line: line.number, column: Some(start + 1) });
        }
        Ok(there as u64)
    }

    /// All numbers up to the next line of whole ones; how many they were.
    fn all_numbers(&mut self, mut each: impl FnMut(f64, Position)) -> Result<u64, FormatError> {
        let mut count = 0;
        while let Some(line) = self.lines.clone().next().filter(|line| line.bytes.contains(&b'.')) {
            self.lines.next();
            count += self.numbers(line, u64::MAX, &mut each)?;
        }
        Ok(count)
    }

    /// The next numbers, so many, in lines of their own.
    fn so_many_numbers(
        &mut self,
        count: u64,
        mut each: impl FnMut(f64, Position),
    ) -> Result<(), FormatError> {
        let mut taken = 0;
        while taken < count {
            let line = self.line(&format!("{count} numbers"))?;
            match self.numbers(line, count - taken, &mut each)? {
                0 => return Err(line.error(0, format!("{count} numbers"), taken.to_string())),
                there => taken += there,
            }
        }
        Ok(())
    }
}

/// Makes values of a column of numbers, from a row (from 1) on.
struct Column<'g, V> {
    gather: &'g mut Gather<V>,
    row: u64,
    col: u64,
    parts: [f64; 2],
    part: usize,
}

impl<V: Value> Column<'_, V> {
    fn push(&mut self, number: f64, place: Position) {
        self.parts[self.part] = number;
        self.part += 1;
        if self.part == V::NUMBERS {
            // A dense column stores its zeros too.
            if self.parts != [0.0; 2] {
                self.gather.push(self.row - 1, self.col - 1, V::from_numbers(self.parts), place);
            }
            self.part = 0;
            self.row = self.row.saturating_add(1);
        }
    }
}

fn matrix<V: Value>(header: &Header, body: &mut Body<'_>) -> Result<NamedMatrix, FormatError> {
    const COLUMN: &str = "a column, its first row (0 of a sparse one) and its words";
    let words_a_number = if header.is_double() { 2 } else { 1 };
    let mut gather = Gather::<V>::new(header.nrows, header.ncols);
    loop {
        let (line, [col, row, words]) = body.wholes::<3>(COLUMN)?;
        let (Ok(col @ 1..), Ok(row), Ok(words)) =
            (u64::try_from(col), u64::try_from(row), u64::try_from(words))
        else {
            return Err(line.error(0, COLUMN, quoted(line.bytes.trim_ascii())));
        };
        if col > header.ncols {
            // The end: a number that means nothing.
            body.line("the number behind the last column")?;
            return Ok(header.named(gather));
        }
        if row > 0 {
            let mut column = Column { gather: &mut gather, row, col, parts: [0.0; 2], part: 0 };
            let numbers = body.all_numbers(|number, place| column.push(number, place))?;
            // Nastran and pyYeti count the numbers of a dense column of text, pyNastran its words.
            if numbers != words && numbers.checked_mul(words_a_number) != Some(words) {
                return Err(line.error(
                    2 * WIDTH,
                    "the number of numbers that follow",
                    format!("{words} where {numbers} do"),
                ));
            }
            whole_values::<V>(line, numbers)?;
            continue;
        }
        let mut left = words;
        while left > 0 {
            let (line, head) = match header.is_bigmat {
                true => body
                    .wholes::<2>(HEAD)
                    .map(|(line, [length, row])| (line, StringHead::of_two(length, row)))?,
                false => body.wholes::<1>(HEAD).map(|(line, [packed])| (line, StringHead::of_one(packed)))?,
            };
            let refuse = |expected: &str| line.error(0, expected, quoted(line.bytes.trim_ascii()));
            let head = head.ok_or_else(|| refuse(HEAD))?;
            let row = head.row().ok_or_else(|| refuse(ROW))?;
            left = head
                .leaves(left)
                .ok_or_else(|| refuse(&format!("a string within the {words} words of its column")))?;
            let numbers = head.words / words_a_number;
            whole_values::<V>(line, numbers)?;
            let mut column = Column { gather: &mut gather, row, col, parts: [0.0; 2], part: 0 };
            body.so_many_numbers(numbers, |number, place| column.push(number, place))?;
        }
    }
}

/// Refuses half a complex value.
fn whole_values<V: Value>(line: Line<'_>, numbers: u64) -> Result<(), FormatError> {
    match numbers % V::NUMBERS as u64 {
        0 => Ok(()),
        _ => Err(line.error(0, "two numbers for each complex value", numbers.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_of_numbers() {
        for (format, fields) in [
            ("", Some((5, 16))),
            ("1P,5E16.9", Some((5, 16))),
            ("1P,3E23.16", Some((3, 23))),
            ("3e24.16", Some((3, 24))),
            ("1P3D25.17", Some((3, 25))),
            ("1P,0E16.9", None),
            ("1P,5F16.9", None),
            ("KAA", None),
        ] {
            let expected = fields.map(|(in_line, width)| Fields { in_line, width });
            assert_eq!(Fields::parse(format.as_bytes()), expected, "{format}");
        }
    }
}
