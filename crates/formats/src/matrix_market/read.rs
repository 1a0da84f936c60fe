//! The reader.

use num_complex::Complex64 as c64;

use super::header::{Field, Header};
use crate::assemble::{Assembly, Clash, ClashKind, Duplicates, Value};
use crate::text::{Line, Lines, Tokens};
use crate::{CoordinateMatrix, FormatError, Symmetry};

/// Reads a Matrix Market file.
///
/// Entries at one position are summed in the order of the file (positions of a pattern are merged). An
/// array file names no positions, so its zeros are not stored. The comment lines before the size line
/// become the title.
///
/// # Errors
/// Where the file is not what its banner and size line say; an index outside the matrix; a value that
/// is not a finite number (or, in an integer file, not a whole one below 2⁵³); (i, j) and (j, i) both
/// in a file that stores one triangle; a diagonal that contradicts the symmetry.
///
/// # Limits
/// At most 2³¹ − 1 rows, columns and entries. Memory is bounded by the bytes that are there, not by the size line.
pub fn read(bytes: &[u8]) -> Result<CoordinateMatrix, FormatError> {
    let mut lines = Lines::new(bytes);
    let header = Header::read(&mut lines)?;
    match header.field {
        Field::Pattern => read_entries::<()>(header, lines),
        Field::Real | Field::Integer => read_entries::<f64>(header, lines),
        Field::Complex => read_entries::<c64>(header, lines),
    }
}

fn read_entries<V: Value>(header: Header, lines: Lines<'_>) -> Result<CoordinateMatrix, FormatError> {
    let promised = header.entries.unwrap_or_else(|| array_length(&header));
    // An entry takes two bytes a token, its blank or line end among them.
    let tokens = V::NUMBERS + if header.entries.is_some() { 2 } else { 0 };
    let room = lines.bytes_left() / (2 * tokens) + 1;
    let mut assembly = Assembly::new(header.symmetry, room.min(usize::try_from(promised).unwrap_or(room)));

    let mut body = Body::new(&header, lines.clone());
    let mut count = 0;
    while let Some((line, mut tokens)) = body.next_line() {
        if count == promised {
            let found = "one more line";
            return Err(FormatError::line(line.number, size_says(&header, promised), found));
        }
        let (row, col) = body.position(&mut tokens)?;
        let value = V::from_numbers(numbers::<V>(header.field, line, &mut tokens)?);
        tokens.end()?;
        count += 1;
        if header.entries.is_some() || value.parts() != [0.0, 0.0] {
            assembly
                .push(row, col, value)
                .map_err(|(expected, found)| FormatError::line(line.number, expected, found))?;
        }
    }
    if count < promised {
        return Err(FormatError::line(body.lines.taken, size_says(&header, promised), count.to_string()));
    }
    let (nrows, ncols) = (header.nrows as usize, header.ncols as usize);
    assembly
        .finish(Duplicates::Sum, nrows, ncols, header.title.clone())
        .map_err(|clash| locate(clash, Body::new(&header, lines)))
}

/// How many values an array file lists: all, one triangle, or one triangle without the diagonal.
fn array_length(header: &Header) -> u64 {
    let n = header.nrows;
    match header.symmetry {
        Symmetry::General => n * header.ncols,
        Symmetry::Symmetric | Symmetry::Hermitian => n * (n + 1) / 2,
        Symmetry::SkewSymmetric => n * n.saturating_sub(1) / 2,
    }
}

fn size_says(header: &Header, promised: u64) -> String {
    let entries = if promised == 1 { "entry" } else { "entries" };
    format!("{promised} {entries}, as line {} says", header.size_line)
}

/// The lines after the size line, and the position of the next array value.
struct Body<'h, 'a> {
    header: &'h Header,
    lines: Lines<'a>,
    next: (u64, u64),
}

impl<'h, 'a> Body<'h, 'a> {
    fn new(header: &'h Header, lines: Lines<'a>) -> Self {
        let first = if header.symmetry == Symmetry::SkewSymmetric { 1 } else { 0 };
        Self { header, lines, next: (first, 0) }
    }

    /// The next line that is neither blank nor a comment.
    fn next_line(&mut self) -> Option<(Line<'a>, Tokens<'a>)> {
        let is_entry = |line: &Line<'_>| !matches!(line.bytes.trim_ascii(), [] | [b'%', ..]);
        self.lines.find(is_entry).map(|line| (line, Tokens::new(line)))
    }

    /// Row and column from 0: as the line says, or of the next array value (column by column).
    fn position(&mut self, tokens: &mut Tokens<'_>) -> Result<(u64, u64), FormatError> {
        if self.header.entries.is_some() {
            let row = tokens.whole("a row", 1, self.header.nrows)?;
            let col = tokens.whole("a column", 1, self.header.ncols)?;
            return Ok((row - 1, col - 1));
        }
        let (row, col) = self.next;
        self.next = match self.header.symmetry {
            _ if row + 1 < self.header.nrows => (row + 1, col),
            Symmetry::General => (0, col + 1),
            Symmetry::Symmetric | Symmetry::Hermitian => (col + 1, col + 1),
            Symmetry::SkewSymmetric => (col + 2, col + 1),
        };
        Ok((row, col))
    }
}

/// The numbers of one value.
fn numbers<V: Value>(field: Field, line: Line<'_>, tokens: &mut Tokens<'_>) -> Result<[f64; 2], FormatError> {
    const TOO_LARGE: f64 = 9_007_199_254_740_992.0; // 2⁵³: below it a double holds every whole number
    let mut numbers = [0.0; 2];
    for number in numbers.iter_mut().take(V::NUMBERS) {
        let (start, value) = tokens.number()?;
        if field == Field::Integer && (value.fract() != 0.0 || value.abs() >= TOO_LARGE) {
            return Err(line.error(start, "a whole number below 2^53 in an integer file", value.to_string()));
        }
        *number = value;
    }
    Ok(numbers)
}

/// The line that brings a clash about, found by reading the positions once more.
fn locate(clash: Clash, mut body: Body<'_, '_>) -> FormatError {
    let (low, high) = (clash.col as u64, clash.row as u64);
    let mut places = std::iter::from_fn(|| {
        let (line, mut tokens) = body.next_line()?;
        body.position(&mut tokens).ok().map(|place| (line.number, place))
    })
    .filter(|&(_, place)| {
        place == (high, low) || (clash.kind == ClashKind::Mirrored && place == (low, high))
    });
    let first = places.next();
    let (row, col) = (clash.row + 1, clash.col + 1);
    let (last, expected, found) = match clash.kind {
        ClashKind::Mirrored => (
            places.find(|&(_, place)| Some(place) != first.map(|f| f.1)),
            "one triangle only, as the banner says",
            format!("both ({row}, {col}) and ({col}, {row})"),
        ),
        ClashKind::Overflow | ClashKind::Twice => (
            places.last(),
            "entries with a finite sum",
            format!("a sum beyond the largest double at row {row}, column {col}"),
        ),
    };
    match last {
        Some((line, _)) => FormatError::line(line, expected, found),
        None => FormatError::whole(expected, found),
    }
}
