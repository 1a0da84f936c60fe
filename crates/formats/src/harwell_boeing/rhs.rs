//! Right-hand sides, starting guesses and solutions behind the matrix.

use num_complex::Complex64 as c64;

use super::block::Block;
use super::header::{Header, RhsHeader};
use super::matrix_type::ValueType;
use crate::text::Lines;
use crate::{Entries, FormatError};

/// The vectors that a Harwell–Boeing file may carry behind its matrix.
///
/// Each field has `count` vectors of as many values as the matrix has rows, one after the other; complex
/// where the matrix is.
#[derive(Debug, Clone, PartialEq)]
pub struct RightHandSides {
    /// Number of right-hand sides.
    pub count: usize,
    /// The right-hand sides.
    pub vectors: Entries,
    /// Starting guesses of the solutions.
    pub guesses: Option<Entries>,
    /// Solutions.
    pub solutions: Option<Entries>,
}

impl RightHandSides {
    pub(super) fn read(lines: &mut Lines<'_>, header: &Header, rhs: &RhsHeader) -> Result<Self, FormatError> {
        let [storage, guesses, solutions] = rhs.kind;
        if storage != b'F' {
            let found = "sparse ones (RHSTYP begins with M)";
            return Err(FormatError::line(rhs.line, "full right-hand sides (RHSTYP begins with F)", found));
        }
        let mut read = |name| read_vectors(&mut *lines, header, rhs, name);
        Ok(Self {
            count: rhs.count as usize,
            vectors: read("right-hand side")?,
            guesses: if guesses == b'G' { Some(read("starting guess")?) } else { None },
            solutions: if solutions == b'X' { Some(read("solution")?) } else { None },
        })
    }
}

fn read_vectors(
    lines: &mut Lines<'_>,
    header: &Header,
    rhs: &RhsHeader,
    name: &'static str,
) -> Result<Entries, FormatError> {
    // Both numbers are below 2³¹.
    let count = header.nrows * rhs.count;
    let numbers = if header.field == ValueType::Complex { 2 * count } else { count };
    // A number takes at least one byte.
    if numbers > lines.bytes_left() as u64 {
        let expected = format!("{numbers} {name} fields");
        return Err(FormatError::line(rhs.line, expected, format!("{} bytes", lines.bytes_left())));
    }
    let mut block = Block::new(lines, &rhs.format, name, numbers);
    if header.field != ValueType::Complex {
        return (0..count).map(|_| block.number()).collect::<Result<_, _>>().map(Entries::Real);
    }
    let mut values = Vec::with_capacity(count as usize);
    for _ in 0..count {
        values.push(c64::new(block.number()?, block.number()?));
    }
    Ok(Entries::Complex(values))
}
