//! The four or five header lines.

use super::formats::Formats;
use super::fortran::Format;
use super::matrix_type::{ValueType, matrix_type};
use crate::assemble::{MAX_ENTRIES, MAX_ROWS};
use crate::matrix::SQUARE;
use crate::text::{Line, Lines, quoted, whole};
use crate::{FormatError, Symmetry};

/// What the header says, its counts checked against each other and against the formats.
pub(super) struct Header {
    pub(super) title: String,
    pub(super) field: ValueType,
    pub(super) symmetry: Symmetry,
    pub(super) nrows: u64,
    pub(super) ncols: u64,
    pub(super) entries: u64,
    pub(super) pointers: Format,
    pub(super) indices: Format,
    /// `None` of a pattern.
    pub(super) values: Option<Format>,
    pub(super) rhs: Option<RhsHeader>,
}

/// What the header says about right-hand sides.
pub(super) struct RhsHeader {
    /// Number of lines they take.
    pub(super) lines: u64,
    /// RHSTYP: storage (F full, M as the matrix), G where guesses follow, X where solutions follow.
    pub(super) kind: [u8; 3],
    pub(super) count: u64,
    pub(super) format: Format,
    /// Number of the line with RHSTYP.
    pub(super) line: usize,
}

impl Header {
    pub(super) fn is_one_triangle(&self) -> bool {
        self.symmetry != Symmetry::General
    }

    pub(super) fn read(lines: &mut Lines<'_>) -> Result<Self, FormatError> {
        let title = title(header_line(lines)?.bytes);
        let counts = header_line(lines)?;
        let [total, pointer_lines, index_lines, value_lines, rhs_lines] = [
            card(counts, 0, "TOTCRD, the number of lines")?,
            card(counts, 1, "PTRCRD, the number of pointer lines")?,
            card(counts, 2, "INDCRD, the number of index lines")?,
            card(counts, 3, "VALCRD, the number of value lines")?,
            card(counts, 4, "RHSCRD, the number of right-hand side lines")?,
        ];
        let sum = [pointer_lines, index_lines, value_lines, rhs_lines].iter().sum::<u64>();
        if total != sum {
            let expected = format!("TOTCRD, the sum of the other counts, {sum}");
            return Err(FormatError::line(2, expected, total.to_string()));
        }

        let kind = header_line(lines)?;
        let (field, symmetry) = matrix_type(kind)?;
        let nrows = bounded(kind, 1, "NROW, a number of rows", MAX_ROWS)?;
        let ncols = bounded(kind, 2, "NCOL, a number of columns", MAX_ROWS)?;
        let entries = bounded(kind, 3, "NNZERO, a number of entries", MAX_ENTRIES)?;
        if symmetry != Symmetry::General && nrows != ncols {
            return Err(FormatError::line(3, SQUARE, format!("{nrows} rows and {ncols} columns")));
        }

        let mut formats = Formats::new(header_line(lines)?);
        let pointers = formats.integers("PTRFMT")?;
        let indices = formats.integers("INDFMT")?;
        let values = if field == ValueType::Pattern { None } else { Some(formats.required("VALFMT")?) };
        let rhs = if rhs_lines > 0 { Some(RhsHeader::read(lines, rhs_lines, formats)?) } else { None };

        let numbers = match field {
            ValueType::Pattern => 0,
            ValueType::Real => entries,
            ValueType::Complex => 2 * entries,
        };
        check_lines("PTRCRD", pointer_lines, ncols + 1, Some(&pointers))?;
        check_lines("INDCRD", index_lines, entries, Some(&indices))?;
        check_lines("VALCRD", value_lines, numbers, values.as_ref())?;
        Ok(Self { title, field, symmetry, nrows, ncols, entries, pointers, indices, values, rhs })
    }
}

impl RhsHeader {
    /// Line 5: RHSTYP, NRHS, NRHSIX.
    fn read(lines: &mut Lines<'_>, count: u64, mut formats: Formats<'_>) -> Result<Self, FormatError> {
        // A pattern has no use for VALFMT, but it may stand there: the last format is that of the vectors.
        let mut format = formats.required("RHSFMT")?;
        while let Some(next) = formats.next("RHSFMT")? {
            format = next;
        }
        let line = header_line(lines)?;
        let mut kind = [b' '; 3];
        for (letter, &byte) in kind.iter_mut().zip(line.bytes) {
            *letter = byte.to_ascii_uppercase();
        }
        match kind {
            [b'F' | b'M', b'G' | b' ', b'X' | b' '] => {}
            _ => {
                return Err(line.error(0, "RHSTYP: F or M, then G or blank, then X or blank", quoted(&kind)));
            }
        }
        let number = bounded(line, 1, "NRHS, a number of right-hand sides", MAX_ROWS)?;
        Ok(Self { lines: count, kind, count: number, format, line: line.number })
    }
}

fn header_line<'a>(lines: &mut Lines<'a>) -> Result<Line<'a>, FormatError> {
    let number = lines.taken + 1;
    lines.next().ok_or_else(|| match number {
        1 => FormatError::whole("the header lines of a Harwell-Boeing file", "an empty file"),
        _ => FormatError::line(number, "a header line", "the end of the file"),
    })
}

/// Columns 1 to 72 are the title, 73 to 80 the key; other than printable ASCII is shown as `?`.
fn title(line: &[u8]) -> String {
    let printable = |bytes: &[u8]| -> String {
        bytes.iter().map(|&b| if b == b' ' || b.is_ascii_graphic() { char::from(b) } else { '?' }).collect()
    };
    let (title, key) = line.split_at(line.len().min(72));
    let (title, key) = (printable(title), printable(&key[..key.len().min(8)]));
    match key.trim() {
        "" => title.trim().to_owned(),
        key => format!("{}\n{key}", title.trim()),
    }
}

/// The n-th number of a line of 14 columns each; blank is 0.
fn card(line: Line<'_>, n: usize, name: &str) -> Result<u64, FormatError> {
    let start = 14 * n;
    let field = line.bytes.get(start..).unwrap_or(&[]);
    let field = field[..field.len().min(14)].trim_ascii();
    match whole(field) {
        _ if field.is_empty() => Ok(0),
        // 14 digits: sums of these cannot overflow.
        Some(count) => Ok(count),
        None => Err(line.error(
            start,
            format!("{name}, in columns {} to {}", start + 1, start + 14),
            quoted(field),
        )),
    }
}

fn bounded(line: Line<'_>, n: usize, name: &str, most: u64) -> Result<u64, FormatError> {
    match card(line, n, name)? {
        count if count <= most => Ok(count),
        count => Err(line.error(14 * n, format!("{name}, up to {most}"), count.to_string())),
    }
}

/// Checks a count of lines against the number of fields they have to hold.
fn check_lines(name: &str, lines: u64, fields: u64, format: Option<&Format>) -> Result<(), FormatError> {
    let needed = format.map_or(0, |format| fields.div_ceil(format.fields.len() as u64));
    if lines == needed {
        return Ok(());
    }
    let expected = format!("{name} = {needed}, the lines that {fields} fields take by the format in line 4");
    Err(FormatError::line(2, expected, lines.to_string()))
}

/// Whether the third line begins with a matrix type and the fourth with a format.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    let mut lines = Lines::new(bytes).skip(2);
    let (Some(kind), Some(formats)) = (lines.next(), lines.next()) else {
        return false;
    };
    let is_kind = match kind.bytes.to_ascii_uppercase().as_slice() {
        [b'R' | b'C' | b'P' | b'I', b'S' | b'U' | b'H' | b'Z' | b'R', b'A' | b'E', rest @ ..] => {
            rest.first().is_none_or(u8::is_ascii_whitespace)
        }
        _ => false,
    };
    is_kind && formats.bytes.trim_ascii_start().starts_with(b"(")
}
