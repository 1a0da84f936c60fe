//! Entries of a matrix in a container: checked one by one, the first that cannot be is kept as the reason.

use num_complex::Complex64 as c64;

use crate::assemble::{Assembly, Duplicates, MAX_ROWS, Value};
use crate::text::FINITE;
use crate::{CoordinateMatrix, Entries, FormatError, Position, Symmetry};

/// Entries of one matrix. Those that cannot be do not stop the reading of the file.
pub(crate) struct Gather<V> {
    size: [u64; 2],
    assembly: Assembly<V>,
    refused: Option<FormatError>,
}

impl<V: Value> Gather<V> {
    pub(crate) fn new(nrows: u64, ncols: u64) -> Self {
        let refused = (nrows > MAX_ROWS || ncols > MAX_ROWS).then(|| {
            let expected = format!("at most {MAX_ROWS} rows and columns");
            FormatError::whole(expected, format!("{nrows} by {ncols}"))
        });
        Self { size: [nrows, ncols], assembly: Assembly::new(Symmetry::General, 0), refused }
    }

    /// Adds an entry (row and column from 0).
    pub(crate) fn push(&mut self, row: u64, col: u64, value: V, position: Position) {
        let [nrows, ncols] = self.size;
        let [re, im] = value.parts();
        let wrong = if self.refused.is_some() {
            return;
        } else if row >= nrows || col >= ncols {
            let found = format!("row {}, column {}", row.saturating_add(1), col.saturating_add(1));
            Some((format!("a position in {nrows} by {ncols}"), found))
        } else if !(re.is_finite() && im.is_finite()) {
            let found = c64::new(re, im);
            Some((FINITE.to_owned(), format!("{found} in row {}, column {}", row + 1, col + 1)))
        } else {
            // Refuses nothing of a general matrix.
            let _ = self.assembly.push(row, col, value);
            None
        };
        self.refused =
            wrong.map(|(expected, found)| FormatError { position, ..FormatError::whole(expected, found) });
    }

    /// The matrix, each position once.
    pub(crate) fn finish(self, duplicates: Duplicates, title: &str) -> Result<CoordinateMatrix, FormatError> {
        if let Some(error) = self.refused {
            return Err(error);
        }
        let [nrows, ncols] = self.size.map(|n| n as usize);
        self.assembly.finish(duplicates, nrows, ncols, title.to_owned()).map_err(|clash| {
            let found = format!("row {}, column {} again", clash.row + 1, clash.col + 1);
            FormatError::whole("each position once, or a finite sum", found)
        })
    }
}

/// A matrix that its file declares symmetric, as one triangle: where both are there and the same, or one only.
///
/// Where both are there and differ it stays as it is: that they do is for the caller to judge.
pub(crate) fn declared_symmetric(matrix: CoordinateMatrix) -> CoordinateMatrix {
    if matrix.nrows != matrix.ncols {
        return matrix;
    }
    let upper = matrix.rows.iter().zip(&matrix.cols).any(|(row, col)| row < col);
    let lower = matrix.rows.iter().zip(&matrix.cols).any(|(row, col)| row > col);
    match &matrix.entries {
        Entries::Real(values) => folded(&matrix, values, upper && lower),
        Entries::Complex(values) => folded(&matrix, values, upper && lower),
        Entries::Pattern => None,
    }
    .unwrap_or(matrix)
}

/// The lower triangle; `None` where both are there and differ.
fn folded<V: Value + PartialEq>(
    matrix: &CoordinateMatrix,
    values: &[V],
    is_both: bool,
) -> Option<CoordinateMatrix> {
    let entries = || matrix.rows.iter().zip(&matrix.cols).zip(values).map(|((&row, &col), &v)| (row, col, v));
    if is_both {
        let mut mirrored: Vec<_> = entries().filter(|(row, col, _)| row < col).collect();
        mirrored.sort_by_key(|&(row, col, _)| (row, col));
        let lower = entries().filter(|(row, col, _)| row > col).map(|(row, col, v)| (col, row, v));
        if !lower.eq(mirrored) {
            return None;
        }
    }
    let mut assembly = Assembly::new(Symmetry::Symmetric, values.len());
    for (row, col, value) in entries().filter(|(row, col, _)| !is_both || row >= col) {
        assembly.push(row as u64, col as u64, value).ok()?;
    }
    assembly.finish(Duplicates::Refuse, matrix.nrows, matrix.ncols, matrix.title.clone()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gathered(entries: &[(u64, u64, f64)]) -> Result<CoordinateMatrix, FormatError> {
        let mut gather = Gather::new(2, 2);
        for &(row, col, value) in entries {
            gather.push(row, col, value, Position::File);
        }
        gather.finish(Duplicates::Refuse, "")
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for (entries, found) in [
            (&[(2, 0, 1.0)][..], "row 3, column 1"),
            (&[(0, 0, f64::NAN)], "NaN+0i in row 1, column 1"),
            (&[(0, 1, 1.0), (0, 1, 2.0)], "row 1, column 2 again"),
        ] {
            assert_eq!(gathered(entries).unwrap_err().found, found);
        }
        assert_eq!(
            Gather::<f64>::new(1 << 31, 1).finish(Duplicates::Sum, "").unwrap_err().found,
            "2147483648 by 1"
        );
    }

    #[test]
    fn a_declared_symmetry_is_believed_as_far_as_the_entries_bear_it_out() {
        let lower = [(0, 0, 2.0), (1, 0, -1.0)];
        let expected = declared_symmetric(gathered(&lower).unwrap());
        assert_eq!((expected.symmetry, expected.rows.as_slice()), (Symmetry::Symmetric, &[0, 1][..]));
        for same in [&[(0, 0, 2.0), (0, 1, -1.0)][..], &[(0, 0, 2.0), (1, 0, -1.0), (0, 1, -1.0)]] {
            assert_eq!(declared_symmetric(gathered(same).unwrap()), expected);
        }
        for other in [&[(1, 0, -1.0), (0, 1, 1.0)][..], &[(1, 0, -1.0), (0, 1, -1.5)]] {
            let matrix = gathered(other).unwrap();
            assert_eq!(declared_symmetric(matrix.clone()), matrix);
        }
    }
}
