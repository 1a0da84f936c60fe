//! What the rows of an Ansys matrix stand for: the mapping file of `HBMAT` (`.mapping`).
//!
//! `HBMAT, fname, ext, , ASCII, STIFF, NO, YES` writes the matrix as a Harwell–Boeing file, which
//! [`harwell_boeing`](crate::harwell_boeing) reads, and `fname.mapping` beside it: a line of headings (`Matrix Eqn`,
//! `Node`, `DOF`), then a line a row: its number from 1, the node, and UX, UY, UZ, ROTX, ROTY or ROTZ.
//!
//! # Limits
//! Other degrees of freedom (PRES, TEMP, WARP, …) are refused: frfit's names have none for them.
//!
//! # Source
//! Ansys Mechanical APDL Command Reference, HBMAT.

use crate::assemble::MAX_ROWS;
use crate::label::{MAX_NODE, distinct};
use crate::text::{Line, Lines, Tokens, quoted};
use crate::{DofLabel, FormatError};

const DIRECTIONS: [&str; 6] = ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"];

/// Reads what the rows stand for, in the order of the rows.
///
/// # Errors
/// No line of headings; a line that is not row, node and direction; rows that do not count up from 1; a name given
/// twice; no row.
pub fn read_mapping(bytes: &[u8]) -> Result<Vec<DofLabel>, FormatError> {
    let mut lines = Lines::new(bytes).filter(|line| !line.is_blank());
    match lines.next() {
        Some(line) if is_heading(line) => {}
        Some(line) => {
            let found = quoted(line.bytes.trim_ascii());
            return Err(FormatError::line(line.number, "the headings Matrix Eqn, Node and DOF", found));
        }
        None => return Err(FormatError::whole("the headings Matrix Eqn, Node and DOF", "an empty file")),
    }
    let mut labels = Vec::new();
    let mut numbers = Vec::new();
    for line in lines {
        let mut tokens = Tokens::new(line);
        let due = labels.len() as u64 + 1;
        tokens.whole("the number of the next row", due, due.min(MAX_ROWS))?;
        let node = tokens.whole("a node", 1, MAX_NODE)? as i64;
        let (start, word) = tokens.take();
        let direction = DIRECTIONS.iter().position(|name| name.as_bytes().eq_ignore_ascii_case(word));
        let component =
            direction.ok_or_else(|| line.error(start, "UX, UY, UZ, ROTX, ROTY or ROTZ", quoted(word)))? as u8
                + 1;
        tokens.end()?;
        labels.push(DofLabel { node, component });
        numbers.push(u32::try_from(line.number).unwrap_or(u32::MAX));
    }
    if labels.is_empty() {
        return Err(FormatError::whole("a row with its node and direction", "none"));
    }
    distinct(labels, &numbers)
}

/// Whether a line is the headings of a mapping file.
fn is_heading(line: Line<'_>) -> bool {
    let words: Vec<_> = line.bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
    match words[..] {
        [.., node, dof] => node.eq_ignore_ascii_case(b"node") && dof.eq_ignore_ascii_case(b"dof"),
        _ => false,
    }
}
