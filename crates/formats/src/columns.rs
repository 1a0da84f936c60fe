//! The entries of a matrix by columns, both triangles, as most programs store them.

use crate::{CoordinateMatrix, Entries, FormatError, Symmetry};

/// An entry of a matrix, both triangles of which are there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    /// From 0.
    pub(crate) col: usize,
    /// From 0.
    pub(crate) row: usize,
    /// Real and imaginary part.
    pub(crate) parts: [f64; 2],
}

/// Every entry of both triangles, by column, then row.
pub(crate) fn entries(matrix: &CoordinateMatrix) -> Vec<Entry> {
    let parts = |k: usize| match &matrix.entries {
        Entries::Pattern => [1.0, 0.0],
        Entries::Real(values) => [values[k], 0.0],
        Entries::Complex(values) => [values[k].re, values[k].im],
    };
    let places = || matrix.rows.iter().copied().zip(matrix.cols.iter().copied()).enumerate();
    let mut entries: Vec<Entry> =
        places().map(|(k, (row, col))| Entry { col, row, parts: parts(k) }).collect();
    if matrix.symmetry != Symmetry::General {
        let mirrored = places().filter(|(_, (row, col))| row != col).map(|(k, (row, col))| {
            let [re, im] = parts(k);
            let parts = match matrix.symmetry {
                Symmetry::SkewSymmetric => [-re, -im],
                Symmetry::Hermitian => [re, -im],
                _ => [re, im],
            };
            Entry { col: row, row: col, parts }
        });
        entries.extend(mirrored);
        entries.sort_unstable_by_key(|entry| (entry.col, entry.row));
    }
    entries
}

/// A matrix in compressed columns.
pub(crate) struct CompressedColumns {
    pub(crate) rows: Vec<i32>,
    /// Where each column begins, and the number of entries.
    pub(crate) ends: Vec<i32>,
    pub(crate) re: Vec<f64>,
    /// Of a complex matrix.
    pub(crate) im: Option<Vec<f64>>,
}

impl CompressedColumns {
    /// Both triangles of a matrix with values.
    ///
    /// # Errors
    /// A matrix that breaks [`CoordinateMatrix::validate`], is a pattern, or has rows or entries beyond 32 bits.
    pub(crate) fn of(matrix: &CoordinateMatrix) -> Result<Self, FormatError> {
        matrix.validate()?;
        let is_complex = match matrix.entries {
            Entries::Pattern => return Err(FormatError::whole("a matrix with values", "a pattern")),
            Entries::Real(_) => false,
            Entries::Complex(_) => true,
        };
        let entries = entries(matrix);
        let counts = [matrix.nrows, matrix.ncols, entries.len()];
        if let Some(count) = counts.into_iter().find(|&count| i32::try_from(count).is_err()) {
            return Err(FormatError::whole("rows, columns and entries below 2^31", count.to_string()));
        }
        let mut ends = vec![0; matrix.ncols + 1];
        entries.iter().for_each(|entry| ends[entry.col + 1] += 1);
        (1..ends.len()).for_each(|k| ends[k] += ends[k - 1]);
        Ok(Self {
            rows: entries.iter().map(|entry| entry.row as i32).collect(),
            ends,
            re: entries.iter().map(|entry| entry.parts[0]).collect(),
            im: is_complex.then(|| entries.iter().map(|entry| entry.parts[1]).collect()),
        })
    }
}
