//! The writer.

use std::io::Write;

use crate::columns::{Entry, entries};
use crate::{CoordinateMatrix, Entries, FormatError, Symmetry};

/// Numbers in a line of 80 characters: 17 digits, a sign and an exponent of three digits each.
const IN_LINE: usize = 3;
/// The largest number of rows: 8 characters, one of them the sign of BIGMAT.
const MAX_ROWS: usize = 9_999_999;
/// The largest number of columns, and of words in a column: 8 characters.
const MAX_COLUMNS_OR_WORDS: usize = 99_999_998;
/// Words of a double.
const WORDS: usize = 2;

/// Writes matrices with names as text, sparse with BIGMAT, types 2 and 4, in the format `1P,3E24.16`.
///
/// 17 digits read back to the same bits. Of a symmetric matrix both triangles are written, as Nastran does, with form 6.
///
/// # Errors
/// A name that is not a letter and up to seven letters and digits; a matrix that breaks
/// [`CoordinateMatrix::validate`], is a pattern, or has more than 9,999,999 rows or 99,999,998 columns (or words in
/// a column): the format has eight characters for these.
pub fn write(matrices: &[(&str, &CoordinateMatrix)]) -> Result<Vec<u8>, FormatError> {
    let mut out = Vec::new();
    for (name, matrix) in matrices {
        let is_name = name.len() <= 8
            && name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric());
        if !is_name {
            let expected = "a name of a letter and up to seven letters and digits";
            return Err(FormatError::whole(expected, format!("{name:?}")));
        }
        write_one(&mut out, &name.to_ascii_uppercase(), matrix)?;
    }
    Ok(out)
}

fn write_one(out: &mut Vec<u8>, name: &str, matrix: &CoordinateMatrix) -> Result<(), FormatError> {
    matrix.validate()?;
    let CoordinateMatrix { nrows, ncols, .. } = *matrix;
    if nrows > MAX_ROWS || ncols > MAX_COLUMNS_OR_WORDS {
        let expected = format!("at most {} rows and {} columns", MAX_ROWS, MAX_COLUMNS_OR_WORDS);
        return Err(FormatError::whole(expected, format!("{nrows} and {ncols}")));
    }
    let (kind, numbers) = match &matrix.entries {
        Entries::Pattern => return Err(FormatError::whole("a matrix with values", "a pattern")),
        Entries::Real(_) => (2, 1),
        Entries::Complex(_) => (4, 2),
    };
    let form = match matrix.symmetry {
        Symmetry::Symmetric => 6,
        _ if nrows == ncols => 1,
        _ => 2,
    };
    // Writing into a Vec cannot fail.
    let _ = writeln!(out, "{ncols:8}{:8}{form:8}{kind:8}{name:8}1P,{IN_LINE}E24.16", -(nrows as i64));
    let entries = entries(matrix);
    for column in entries.chunk_by(|a, b| a.col == b.col) {
        let strings: Vec<&[Entry]> = column.chunk_by(|a, b| a.row + 1 == b.row).collect();
        let words = 2 * strings.len() + WORDS * numbers * column.len();
        if words > MAX_COLUMNS_OR_WORDS {
            return Err(FormatError::whole(
                format!("at most {} words in a column", MAX_COLUMNS_OR_WORDS),
                words.to_string(),
            ));
        }
        let _ = writeln!(out, "{:8}{:8}{words:8}", column[0].col + 1, 0);
        for string in strings {
            let _ = writeln!(out, "{:8}{:8}", WORDS * numbers * string.len() + 1, string[0].row + 1);
            write_numbers(out, string.iter().flat_map(|entry| &entry.parts[..numbers]));
        }
    }
    let _ = writeln!(out, "{:8}{:8}{:8}", ncols + 1, 1, 1);
    write_numbers(out, std::iter::once(&1.0));
    Ok(())
}

fn write_numbers<'a>(out: &mut Vec<u8>, numbers: impl Iterator<Item = &'a f64>) {
    let mut in_line = 0;
    for number in numbers {
        let text = format!("{number:.16E}");
        let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
        let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
        let _ = write!(out, "{:>24}", format!("{mantissa}E{sign}{digits:0>2}"));
        in_line = (in_line + 1) % IN_LINE;
        if in_line == 0 {
            out.push(b'\n');
        }
    }
    if in_line > 0 {
        out.push(b'\n');
    }
}
