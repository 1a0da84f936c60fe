//! The writer.

use std::fmt::Display;
use std::io::Write;

use crate::{CoordinateMatrix, Entries, FormatError, Symmetry};

/// Fields of a line of 80 columns: 17 significant digits and a blank before each.
const VALUE_WIDTH: usize = 25;
const VALUES_IN_LINE: usize = 80 / VALUE_WIDTH;

/// Writes a matrix in lines of 80 columns.
///
/// Values are written as `(3E25.16)` with 17 significant digits, which read back to the same bits. The
/// first line of the title becomes TITLE, cut at 72 characters; the second becomes KEY if it has at most 8.
///
/// # Errors
/// A matrix that breaks [`CoordinateMatrix::validate`] or has more than 2³¹ − 1 entries.
pub fn write(matrix: &CoordinateMatrix) -> Result<Vec<u8>, FormatError> {
    matrix.validate()?;
    let count = matrix.rows.len();
    if i32::try_from(count).is_err() {
        return Err(FormatError::whole("at most 2^31 - 1 entries", count.to_string()));
    }
    let pointers = pointers(matrix);
    let pointer_width = digits(count + 1) + 1;
    let index_width = digits(matrix.nrows) + 1;
    let (letter, numbers): (_, Vec<f64>) = match &matrix.entries {
        Entries::Pattern => ('P', Vec::new()),
        Entries::Real(values) => ('R', values.clone()),
        Entries::Complex(values) => ('C', values.iter().flat_map(|z| [z.re, z.im]).collect()),
    };
    let lines = [
        pointers.len().div_ceil(80 / pointer_width),
        count.div_ceil(80 / index_width),
        numbers.len().div_ceil(VALUES_IN_LINE),
    ];

    let mut out = Vec::new();
    let (title, key) = title_and_key(&matrix.title);
    // Writing into a Vec cannot fail.
    let _ = writeln!(out, "{title:<72}{key:<8}");
    let total: usize = lines.iter().sum();
    let _ = writeln!(out, "{total:>14}{:>14}{:>14}{:>14}{:>14}", lines[0], lines[1], lines[2], 0);
    let kind = format!("{letter}{}A", symmetry_letter(matrix));
    let _ = writeln!(out, "{kind:<14}{:>14}{:>14}{count:>14}{:>14}", matrix.nrows, matrix.ncols, 0);
    let integers = |width: usize| format!("({}I{width})", 80 / width);
    let values = if letter == 'P' { String::new() } else { format!("({VALUES_IN_LINE}E{VALUE_WIDTH}.16)") };
    let _ = writeln!(out, "{:<16}{:<16}{values:<40}", integers(pointer_width), integers(index_width));
    block(&mut out, pointer_width, pointers);
    block(&mut out, index_width, matrix.rows.iter().map(|row| row + 1));
    block(&mut out, VALUE_WIDTH, numbers.into_iter().map(scientific));
    Ok(out)
}

/// Where each column begins among the entries, from 1, and where the last one ends.
fn pointers(matrix: &CoordinateMatrix) -> Vec<usize> {
    let mut pointers = vec![1; matrix.ncols + 1];
    for col in &matrix.cols {
        pointers[col + 1] += 1;
    }
    for col in 0..matrix.ncols {
        pointers[col + 1] += pointers[col] - 1;
    }
    pointers
}

fn digits(n: usize) -> usize {
    n.to_string().len()
}

fn symmetry_letter(matrix: &CoordinateMatrix) -> char {
    match matrix.symmetry {
        Symmetry::General if matrix.nrows == matrix.ncols => 'U',
        Symmetry::General => 'R',
        Symmetry::Symmetric => 'S',
        Symmetry::SkewSymmetric => 'Z',
        Symmetry::Hermitian => 'H',
    }
}

fn title_and_key(text: &str) -> (String, String) {
    let ascii = |line: &str| -> String {
        line.trim().chars().map(|c| if c == ' ' || c.is_ascii_graphic() { c } else { '?' }).collect()
    };
    let mut lines = text.split('\n').map(ascii);
    let mut title = lines.next().unwrap_or_default();
    title.truncate(72);
    (title, lines.next().filter(|key| key.len() <= 8).unwrap_or_default())
}

/// Fields of equal width, as many as fit into 80 columns.
fn block<T: Display>(out: &mut Vec<u8>, width: usize, fields: impl IntoIterator<Item = T>) {
    let in_line = 80 / width;
    let mut column = 0;
    for field in fields {
        let _ = write!(out, "{field:>width$}");
        column = (column + 1) % in_line;
        if column == 0 {
            out.push(b'\n');
        }
    }
    if column > 0 {
        out.push(b'\n');
    }
}

/// 17 significant digits with a Fortran exponent: `-1.5000000000000000E-07`.
fn scientific(value: f64) -> String {
    let text = format!("{value:.16e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) if exponent.starts_with('-') => {
            format!("{mantissa}E-{:0>2}", &exponent[1..])
        }
        Some((mantissa, exponent)) => format!("{mantissa}E+{exponent:0>2}"),
        None => text,
    }
}
