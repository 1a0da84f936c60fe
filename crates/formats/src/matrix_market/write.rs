//! The writer.

use std::io::Write;

use crate::{CoordinateMatrix, Entries, FormatError, Symmetry};

/// Writes a matrix as a coordinate file.
///
/// Values have the shortest digits that read back to the same bits. The lines of the title become
/// comment lines. The format has no real and no pattern Hermitian matrices: they are written as symmetric.
///
/// # Errors
/// A matrix that breaks [`CoordinateMatrix::validate`], or a skew-symmetric pattern, which the format
/// does not have.
pub fn write(matrix: &CoordinateMatrix) -> Result<Vec<u8>, FormatError> {
    matrix.validate()?;
    let mut out = Vec::new();
    // Writing into a Vec cannot fail.
    let _ = header(&mut out, matrix.entries_word(), symmetry_word(matrix)?, matrix);
    for (k, (row, col)) in matrix.rows.iter().zip(&matrix.cols).enumerate() {
        let _ = match &matrix.entries {
            Entries::Pattern => writeln!(out, "{} {}", row + 1, col + 1),
            Entries::Real(values) => writeln!(out, "{} {} {:?}", row + 1, col + 1, values[k]),
            Entries::Complex(values) => {
                writeln!(out, "{} {} {:?} {:?}", row + 1, col + 1, values[k].re, values[k].im)
            }
        };
    }
    Ok(out)
}

fn header(out: &mut Vec<u8>, field: &str, symmetry: &str, matrix: &CoordinateMatrix) -> std::io::Result<()> {
    writeln!(out, "%%MatrixMarket matrix coordinate {field} {symmetry}")?;
    if !matrix.title.is_empty() {
        for line in matrix.title.split('\n') {
            writeln!(out, "% {}", line.trim())?;
        }
    }
    writeln!(out, "{} {} {}", matrix.nrows, matrix.ncols, matrix.rows.len())
}

impl CoordinateMatrix {
    fn entries_word(&self) -> &'static str {
        match self.entries {
            Entries::Pattern => "pattern",
            Entries::Real(_) => "real",
            Entries::Complex(_) => "complex",
        }
    }
}

fn symmetry_word(matrix: &CoordinateMatrix) -> Result<&'static str, FormatError> {
    match (matrix.symmetry, &matrix.entries) {
        (Symmetry::General, _) => Ok("general"),
        (Symmetry::Hermitian, Entries::Complex(_)) => Ok("hermitian"),
        (Symmetry::Symmetric | Symmetry::Hermitian, _) => Ok("symmetric"),
        (Symmetry::SkewSymmetric, Entries::Pattern) => Err(FormatError::whole(
            "a pattern that Matrix Market has a word for (general or symmetric)",
            "a skew-symmetric pattern",
        )),
        (Symmetry::SkewSymmetric, _) => Ok("skew-symmetric"),
    }
}
