//! Matrices that Abaqus writes with the names of their rows (`.mtx`): `FORMAT=MATRIX INPUT` and `FORMAT=LABELS`.
//!
//! A line an entry: node and degree of freedom of the row, node and degree of freedom of the column, and the value,
//! set apart by commas, blanks or both. Degrees of freedom are 1 to 3 (translations), 4 to 6 (rotations) and others
//! above (7 warping, 8 pressure, 11 temperature). Nodes that Abaqus has made for itself are negative. Lines that
//! begin with `**` are comments. [`triplets`](crate::triplets) reads `FORMAT=COORDINATE`.
//!
//! The file says nothing of symmetry: where no entry has its mirror image beside it, it is a triangle of a symmetric
//! matrix. Of a degree of freedom that a boundary condition holds fixed, Abaqus writes 10³⁶ on the diagonal of the
//! stiffness: it is left out here, and listed in [`Labels::fixed`].
//!
//! # Limits
//! Assembled matrices only: what `ELEMENT BY ELEMENT` and `*SUBSTRUCTURE MATRIX OUTPUT` write is refused.
//!
//! # Source
//! Abaqus Analysis User's Guide, "Generating matrices" (`*MATRIX GENERATE`, `*MATRIX OUTPUT`); Abaqus Keywords
//! Reference Guide, `*MATRIX INPUT`.

use crate::labelled::Labelled;
use crate::text::{Line, quoted};
use crate::triplets::{Fields, each_entry};
use crate::{CoordinateMatrix, DofLabel, FormatError, Labels};

/// What Abaqus writes on the diagonal of the stiffness for a degree of freedom that is held fixed.
pub const FIXED: f64 = 1e36;

/// Reads a matrix and what its rows stand for, sorted by node and degree of freedom.
///
/// # Errors
/// A line that is not two nodes with their degrees of freedom and a value; a value that is not finite; a position
/// given twice; no entry; matrices of elements.
pub fn read(bytes: &[u8]) -> Result<(CoordinateMatrix, Labels), FormatError> {
    let mut entries = Labelled::<i64>::new();
    let title = each_entry(bytes, |line| {
        if let [b'*', ..] = line.bytes.trim_ascii() {
            let found = quoted(line.bytes.trim_ascii());
            return Err(FormatError::line(line.number, "entries of an assembled matrix", found));
        }
        let fields = Fields::split(line);
        if fields.count() == 6 {
            let expected = "node, dof, node, dof and value (an assembled matrix, not ELEMENT BY ELEMENT)";
            return Err(FormatError::line(line.number, expected, "six fields"));
        }
        let (row, col) = (label(&fields, 0)?, label(&fields, 2)?);
        let value = fields.value(4)?;
        fields.end(5)?;
        entries.push(line.number, row.code(), col.code(), value);
        Ok(())
    })?;
    if entries.len() == 0 {
        return Err(FormatError::whole("entries: node, dof, node, dof and value", "none"));
    }
    let fixed = entries.rows_with_diagonal(|value| value == FIXED);
    if !fixed.is_empty() {
        entries.leave_out(&fixed);
    }
    let symmetry = entries.inferred_symmetry();
    let (matrix, rows) = entries.square(symmetry, title)?;
    let fixed = fixed.into_iter().map(DofLabel::of_code).collect();
    Ok((matrix, Labels { fixed, ..Labels::of_rows(rows) }))
}

fn label(fields: &Fields<'_>, k: usize) -> Result<DofLabel, FormatError> {
    let node = fields.node(k)?;
    let component = fields.whole(k + 1, "a degree of freedom", u64::from(u8::MAX))? as u8;
    Ok(DofLabel { node, component })
}

/// Whether a line that is no comment is an entry, or begins what Abaqus writes of elements and substructures.
pub(crate) fn is_first_line(line: Line<'_>) -> bool {
    let keyword = |word: &[u8]| {
        line.bytes.trim_ascii().get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
    };
    let fields = Fields::split(line);
    let is_entry = |k: usize| {
        label(&fields, k).is_ok()
            && label(&fields, k + 2).is_ok()
            && fields.value(k + 4).is_ok()
            && fields.end(k + 5).is_ok()
    };
    let of_element = fields.count() == 6 && fields.node(0).is_ok() && is_entry(1);
    keyword(b"*USER ELEMENT") || keyword(b"*MATRIX") || is_entry(0) || of_element
}
