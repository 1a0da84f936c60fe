//! The four or five header lines.

use super::fortran::Format;
use crate::assemble::{MOST_ENTRIES, MOST_ROWS};
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

/// The first letter of the matrix type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ValueType {
    Real,
    Complex,
    Pattern,
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
        let nrows = bounded(kind, 1, "NROW, a number of rows", MOST_ROWS)?;
        let ncols = bounded(kind, 2, "NCOL, a number of columns", MOST_ROWS)?;
        let entries = bounded(kind, 3, "NNZERO, a number of entries", MOST_ENTRIES)?;
        if symmetry != Symmetry::General && nrows != ncols {
            return Err(FormatError::line(3, SQUARE, format!("{nrows} rows and {ncols} columns")));
        }

        let line = header_line(lines)?;
        let mut formats = Formats { line, at: 0 };
        let pointers = formats.integers("PTRFMT")?;
        let indices = formats.integers("INDFMT")?;
        let is_pattern = field == ValueType::Pattern;
        let values =
            if is_pattern && rhs_lines == 0 { None } else { formats.values("VALFMT", is_pattern)? };
        let rhs =
            if rhs_lines > 0 { Some(RhsHeader::read(lines, rhs_lines, formats, &values)?) } else { None };

        let numbers = match field {
            ValueType::Pattern => 0,
            ValueType::Real => entries,
            ValueType::Complex => 2 * entries,
        };
        check_lines("PTRCRD", pointer_lines, ncols + 1, Some(&pointers))?;
        check_lines("INDCRD", index_lines, entries, Some(&indices))?;
        check_lines("VALCRD", value_lines, numbers, values.as_ref())?;
        let values = values.filter(|_| !is_pattern);
        Ok(Self { title, field, symmetry, nrows, ncols, entries, pointers, indices, values, rhs })
    }
}

impl RhsHeader {
    /// Line 5: RHSTYP, NRHS, NRHSIX.
    fn read(
        lines: &mut Lines<'_>,
        count: u64,
        mut formats: Formats<'_>,
        values: &Option<Format>,
    ) -> Result<Self, FormatError> {
        let format = formats.values("RHSFMT", true)?.or_else(|| values.clone());
        let Some(format) = format else {
            return Err(formats.line.error(formats.at, "RHSFMT, a Fortran format", "nothing"));
        };
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
        let number = bounded(line, 1, "NRHS, a number of right-hand sides", MOST_ROWS)?;
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

/// MXTYPE, the three letters at the beginning of line 3.
fn matrix_type(line: Line<'_>) -> Result<(ValueType, Symmetry), FormatError> {
    let letters = line.bytes[..line.bytes.len().min(3)].to_ascii_uppercase();
    let error = |at: usize, expected: &str| Err(line.error(at, expected, quoted(&letters)));
    let &[value, symmetry, assembled] = letters.as_slice() else {
        return error(0, "a matrix type of three letters, such as RSA");
    };
    let value = match value {
        b'R' | b'I' => ValueType::Real,
        b'C' => ValueType::Complex,
        b'P' => ValueType::Pattern,
        _ => return error(0, "a matrix type that begins with R, C, P or I, such as RSA"),
    };
    let symmetry = match symmetry {
        b'U' | b'R' => Symmetry::General,
        b'S' => Symmetry::Symmetric,
        b'H' => Symmetry::Hermitian,
        b'Z' => Symmetry::SkewSymmetric,
        _ => return error(1, "a matrix type with S, U, H, Z or R in the middle, such as RSA"),
    };
    match assembled {
        b'A' => Ok((value, symmetry)),
        b'E' => error(2, "an assembled matrix, such as RSA (elemental ones are not read: assemble it first)"),
        _ => error(2, "a matrix type that ends with A, such as RSA"),
    }
}

/// The Fortran formats of line 4, one parenthesis after the other.
struct Formats<'a> {
    line: Line<'a>,
    at: usize,
}

impl Formats<'_> {
    /// The next format; `None` where the line has no more.
    fn next(&mut self, name: &str) -> Result<Option<Format>, FormatError> {
        let rest = &self.line.bytes[self.at..];
        let start = self.at + rest.len() - rest.trim_ascii_start().len();
        let mut depth = 0_usize;
        let is_end = |&byte: &u8| {
            depth = match byte {
                b'(' => depth + 1,
                b')' => depth.saturating_sub(1),
                _ => depth,
            };
            depth == 0
        };
        let rest = &self.line.bytes[start..];
        if rest.is_empty() {
            return Ok(None);
        }
        let length = rest.iter().position(is_end).map_or(rest.len(), |end| end + 1);
        self.at = start + length;
        match Format::parse(&rest[..length]) {
            Ok(format) => Ok(Some(format)),
            Err(expected) => Err(self.line.error(start, format!("{name}: {expected}"), quoted(rest))),
        }
    }

    fn integers(&mut self, name: &str) -> Result<Format, FormatError> {
        match self.next(name)? {
            Some(format) if format.fields.iter().all(|field| field.is_integer) => Ok(format),
            Some(_) => Err(self.line.error(0, format!("{name}, a format of whole numbers (I)"), "another")),
            None => Err(self.line.error(self.at, format!("{name}, a Fortran format"), "the end of the line")),
        }
    }

    fn values(&mut self, name: &str, may_lack: bool) -> Result<Option<Format>, FormatError> {
        match self.next(name)? {
            None if !may_lack => {
                Err(self.line.error(self.at, format!("{name}, a Fortran format"), "the end of the line"))
            }
            other => Ok(other),
        }
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
