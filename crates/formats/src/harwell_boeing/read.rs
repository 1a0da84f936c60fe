//! The reader.

use num_complex::Complex64 as c64;

use super::block::Block;
use super::header::Header;
use super::matrix_type::ValueType;
use super::rhs::RightHandSides;
use crate::assemble::{Assembly, ClashKind, Duplicates, Value};
use crate::text::Lines;
use crate::{CoordinateMatrix, FormatError};

/// A matrix and the vectors that come with it.
#[derive(Debug, Clone, PartialEq)]
pub struct HarwellBoeing {
    /// The matrix.
    pub matrix: CoordinateMatrix,
    /// The right-hand sides, where the file has any.
    pub rhs: Option<RightHandSides>,
}

/// Reads the matrix of a Harwell–Boeing file; right-hand sides are skipped.
///
/// Entries of the upper triangle of a matrix that is given by one triangle are mirrored into the lower
/// one. The title is TITLE and, on a second line, KEY.
///
/// # Errors
/// Where the counts of the header, the formats and the lines that are there contradict each other; a
/// pointer that falls, a row index outside the matrix, a position given twice; a value that is blank or
/// not a finite number; an elemental matrix.
///
/// # Limits
/// At most 2³¹ − 1 rows, columns and entries. Memory is bounded by the bytes that are there.
pub fn read(bytes: &[u8]) -> Result<CoordinateMatrix, FormatError> {
    let mut lines = Lines::new(bytes);
    let header = Header::read(&mut lines)?;
    let matrix = read_matrix(&mut lines, &header)?;
    if let Some(rhs) = &header.rhs {
        for read in 0..rhs.lines {
            if lines.next().is_none() {
                let found = format!("the end of the file after {read}");
                return Err(FormatError::line(lines.taken, format!("RHSCRD = {} lines", rhs.lines), found));
            }
        }
    }
    nothing_more(lines)?;
    Ok(matrix)
}

/// Reads a Harwell–Boeing file with its right-hand sides.
///
/// # Errors
/// As [`read`], and where right-hand sides are stored as sparse vectors (RHSTYP beginning with M).
pub fn read_with_rhs(bytes: &[u8]) -> Result<HarwellBoeing, FormatError> {
    let mut lines = Lines::new(bytes);
    let header = Header::read(&mut lines)?;
    let matrix = read_matrix(&mut lines, &header)?;
    let rhs = match &header.rhs {
        Some(rhs) => Some(RightHandSides::read(&mut lines, &header, rhs)?),
        None => None,
    };
    nothing_more(lines)?;
    Ok(HarwellBoeing { matrix, rhs })
}

fn nothing_more(mut lines: Lines<'_>) -> Result<(), FormatError> {
    match lines.find(|line| !line.is_blank()) {
        Some(line) => {
            Err(FormatError::line(line.number, "the end of the file, as line 2 says", "more lines"))
        }
        None => Ok(()),
    }
}

fn read_matrix(lines: &mut Lines<'_>, header: &Header) -> Result<CoordinateMatrix, FormatError> {
    match header.field {
        ValueType::Pattern => read_entries::<()>(lines, header),
        ValueType::Real => read_entries::<f64>(lines, header),
        ValueType::Complex => read_entries::<c64>(lines, header),
    }
}

fn read_entries<V: Value>(lines: &mut Lines<'_>, header: &Header) -> Result<CoordinateMatrix, FormatError> {
    // Every field takes at least one byte: what is missing is found before it is allocated for.
    let fields = header.ncols + 1 + header.entries * (1 + V::NUMBERS as u64);
    if fields > lines.bytes_left() as u64 {
        let found = format!("{} bytes", lines.bytes_left());
        return Err(FormatError::line(3, format!("{fields} fields behind the header"), found));
    }
    let pointers = read_pointers(lines, header)?;
    let before_indices = lines.clone();
    let rows = read_rows(lines, header, &pointers)?;

    let mut values = header
        .values
        .as_ref()
        .map(|format| Block::new(lines, format, "value", V::NUMBERS as u64 * header.entries));
    let mut assembly = Assembly::<V>::new(header.symmetry, rows.len());
    let columns = pointers.windows(2).enumerate().flat_map(|(col, p)| (p[0]..p[1]).map(move |_| col));
    for (&row, col) in rows.iter().zip(columns) {
        let mut numbers = [0.0; 2];
        for number in numbers.iter_mut().take(V::NUMBERS) {
            if let Some(values) = &mut values {
                *number = values.number()?;
            }
        }
        assembly.push(u64::from(row), col as u64, V::from_numbers(numbers)).map_err(
            |(expected, found)| {
                FormatError::line(values.as_ref().map_or(3, Block::line_number), expected, found)
            },
        )?;
    }
    drop(rows);
    let (nrows, ncols) = (header.nrows as usize, header.ncols as usize);
    assembly.finish(Duplicates::Refuse, nrows, ncols, header.title.clone()).map_err(|clash| {
        let (row, col) = (clash.row + 1, clash.col + 1);
        let found = match clash.kind {
            ClashKind::Mirrored => format!("both ({row}, {col}) and ({col}, {row})"),
            ClashKind::Overflow | ClashKind::Twice => format!("({row}, {col}) twice"),
        };
        let line = locate(before_indices, header, &pointers, clash.row as u32, clash.col as u32);
        FormatError::line(line, "each position once", found)
    })
}

/// Where each column begins among the entries, from 0, and where the last one ends.
fn read_pointers(lines: &mut Lines<'_>, header: &Header) -> Result<Vec<u32>, FormatError> {
    let mut block = Block::new(lines, &header.pointers, "column pointer", header.ncols + 1);
    let mut pointers = Vec::with_capacity(header.ncols as usize + 1);
    let (mut least, end) = (1, header.entries + 1);
    for col in 0..=header.ncols {
        least = match col {
            0 => block.whole(1, 1)?,
            col if col == header.ncols => block.whole(end, end)?,
            _ => block.whole(least, end)?,
        };
        pointers.push((least - 1) as u32);
    }
    if header.ncols == 0 && header.entries > 0 {
        return Err(FormatError::line(
            3,
            "no entries where there are no columns",
            header.entries.to_string(),
        ));
    }
    Ok(pointers)
}

/// The row of each entry, from 0.
fn read_rows(lines: &mut Lines<'_>, header: &Header, pointers: &[u32]) -> Result<Vec<u32>, FormatError> {
    let mut block = Block::new(lines, &header.indices, "row index", header.entries);
    let mut rows = Vec::with_capacity(header.entries as usize);
    for _ in 0..pointers.last().copied().unwrap_or(0) {
        rows.push((block.whole(1, header.nrows)? - 1) as u32);
    }
    Ok(rows)
}

/// The line of the row index that gives a position, or its mirror, for the second time.
fn locate(mut lines: Lines<'_>, header: &Header, pointers: &[u32], high: u32, low: u32) -> usize {
    let mut block = Block::new(&mut lines, &header.indices, "row index", header.entries);
    let mut seen = false;
    for (col, ends) in pointers.windows(2).enumerate() {
        for _ in ends[0]..ends[1] {
            let Ok(row) = block.whole(1, header.nrows) else { return block.line_number() };
            let place = (row as u32 - 1, col as u32);
            let is_place = place == (high, low) || (header.is_one_triangle() && place == (low, high));
            if is_place && seen {
                return block.line_number();
            }
            seen |= is_place;
        }
    }
    block.line_number()
}
