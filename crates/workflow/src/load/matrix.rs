//! From a matrix file to a symmetric matrix.

use frfit::c64;
use frfit_formats::{CoordinateMatrix, Entries, FormatError, Symmetry};
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};

/// How far a_ij and a_ji may differ, relative to the largest entry.
///
/// Programs that export the full matrix print each triangle's own sum of element contributions: in 12 digits or
/// more these differ by rounding. A difference above 1e-10 is in the physics: D would not be symmetric.
const SYMMETRIC_TO: f64 = 1e-10;

/// Checks that a matrix is a term of a dynamic stiffness: square, with values, and Aᵀ = A.
///
/// # Errors
/// What is not: rectangular, without a row, pattern only, skew-symmetric, Hermitian, or two entries that differ.
pub fn check_symmetric(matrix: &CoordinateMatrix) -> Result<(), FormatError> {
    let (rows, cols) = (matrix.nrows, matrix.ncols);
    if rows != cols || rows == 0 {
        return Err(FormatError::whole("a square matrix", format!("{rows} rows and {cols} columns")));
    }
    if matrix.entries == Entries::Pattern {
        return Err(FormatError::whole("a matrix with values", "a pattern: positions without values"));
    }
    match asymmetry(matrix) {
        Some(found) => Err(FormatError::whole("a symmetric matrix (its transpose is A)", found)),
        None => Ok(()),
    }
}

/// Rows (from 0) in which no matrix has a value that is not zero: of square matrices with so many rows.
pub(crate) fn empty_rows<'m>(
    rows: usize,
    matrices: impl IntoIterator<Item = &'m CoordinateMatrix>,
) -> Vec<usize> {
    let mut empty = vec![true; rows];
    for matrix in matrices {
        let is_zero = |k: usize| match &matrix.entries {
            Entries::Pattern => false,
            Entries::Real(values) => values[k] == 0.0,
            Entries::Complex(values) => values[k].norm() == 0.0,
        };
        for (k, (&row, &col)) in matrix.rows.iter().zip(&matrix.cols).enumerate() {
            if !is_zero(k) {
                empty[row] = false;
                empty[col] = false;
            }
        }
    }
    (0..rows).filter(|&row| empty[row]).collect()
}

/// Why Aᵀ is not A, in words; `None` where it is.
pub(crate) fn asymmetry(matrix: &CoordinateMatrix) -> Option<String> {
    match matrix.symmetry {
        Symmetry::Symmetric => None,
        Symmetry::General => worst_pair(matrix),
        Symmetry::SkewSymmetric => Some("a skew-symmetric one (its transpose is -A)".into()),
        Symmetry::Hermitian => Some("a Hermitian one (its transpose is the conjugate of A)".into()),
    }
}

/// The two entries of a general matrix that differ most, in words; `None` where none do.
fn worst_pair(matrix: &CoordinateMatrix) -> Option<String> {
    let values = complex(matrix);
    let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let worst = (matrix.rows.iter().zip(&matrix.cols).zip(&values))
        .map(|((&row, &col), &value)| (row, col, value, entry(matrix, &values, col, row)))
        .max_by(|a, b| (a.2 - a.3).norm().total_cmp(&(b.2 - b.3).norm()))?;
    let (row, col, here, there) = worst;
    // Divided first: the difference of two huge entries may overflow to infinity, and is then refused too.
    if (here / largest - there / largest).norm() <= SYMMETRIC_TO || largest == 0.0 {
        return None;
    }
    let shown = |value: c64| if value.im == 0.0 { value.re.to_string() } else { value.to_string() };
    let (row, col) = (row + 1, col + 1);
    Some(format!("{} at ({row}, {col}) but {} at ({col}, {row})", shown(here), shown(there)))
}

/// The entry at a position; zero where none is stored.
fn entry(matrix: &CoordinateMatrix, values: &[c64], row: usize, col: usize) -> c64 {
    let start = matrix.cols.partition_point(|&c| c < col);
    let end = start + matrix.cols[start..].partition_point(|&c| c == col);
    matrix.rows[start..end].binary_search(&row).map_or(c64::default(), |k| values[start + k])
}

/// The stored values as complex numbers, those of a pattern as 1.
pub(crate) fn complex(matrix: &CoordinateMatrix) -> Vec<c64> {
    match &matrix.entries {
        Entries::Pattern => vec![c64::new(1.0, 0.0); matrix.rows.len()],
        Entries::Real(values) => values.iter().map(|&value| c64::new(value, 0.0)).collect(),
        Entries::Complex(values) => values.clone(),
    }
}

/// The matrix on its lower triangle; of a general one the mean of both triangles.
///
/// # Errors
/// As [`check_symmetric`].
pub fn symmetric_matrix(matrix: &CoordinateMatrix) -> Result<SymmetricMatrix, FormatError> {
    check_symmetric(matrix)?;
    let weight = |row, col| if matrix.symmetry == Symmetry::General && row != col { 0.5 } else { 1.0 };
    let positions = matrix.rows.iter().copied().zip(matrix.cols.iter().copied());
    if let Entries::Real(values) = &matrix.entries {
        let mut triplets = Triplets::new(matrix.nrows);
        positions
            .zip(values)
            .for_each(|((row, col), &value)| triplets.add(row, col, weight(row, col) * value));
        return Ok(triplets.assemble());
    }
    let values: Vec<c64> =
        positions.clone().zip(complex(matrix)).map(|((row, col), value)| weight(row, col) * value).collect();
    let (rows, cols): (Vec<_>, Vec<_>) = positions.map(|(row, col)| (row.max(col), row.min(col))).unzip();
    Ok(SymmetricMatrix::from_complex_triplets(matrix.nrows, &rows, &cols, &values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn general(entries: Entries, positions: &[(usize, usize)]) -> CoordinateMatrix {
        let (rows, cols) = positions.iter().copied().unzip();
        let symmetry = Symmetry::General;
        CoordinateMatrix { nrows: 2, ncols: 2, symmetry, rows, cols, entries, title: String::new() }
    }

    const FULL: [(usize, usize); 4] = [(0, 0), (1, 0), (0, 1), (1, 1)];

    #[test]
    fn rounding_between_triangles_is_averaged_away() {
        let matrix = general(Entries::Real(vec![2.0, -1.0, -1.0 - 1e-11, 3.0]), &FULL);
        let symmetric = symmetric_matrix(&matrix).unwrap();
        assert_eq!(symmetric.real_values(), Some(&[2.0, -1.0 - 0.5e-11, 3.0][..]));
    }

    #[test]
    fn complex_symmetric_is_symmetric_and_hermitian_values_are_not() {
        let i = c64::new(0.0, 1.0);
        let matrix = general(Entries::Complex(vec![2.0 + i, i, i, 3.0 + i]), &FULL);
        assert_eq!(symmetric_matrix(&matrix).unwrap().get(0, 1), i);
        let conjugate = general(Entries::Complex(vec![2.0 + i, c64::new(0.0, -1.0), i, 3.0 + i]), &FULL);
        let found = symmetric_matrix(&conjugate).unwrap_err().found;
        assert_eq!(found, "0+1i at (1, 2) but 0-1i at (2, 1)");
    }

    #[test]
    fn an_entry_without_its_mirror_image_is_found() {
        let matrix = general(Entries::Real(vec![2.0, 0.5, 3.0]), &[(0, 0), (1, 0), (1, 1)]);
        assert_eq!(symmetric_matrix(&matrix).unwrap_err().found, "0.5 at (2, 1) but 0 at (1, 2)");
        let zero = general(Entries::Real(vec![0.0]), &[(1, 0)]);
        assert_eq!(symmetric_matrix(&zero).unwrap().get(0, 1), c64::default());
    }
}
