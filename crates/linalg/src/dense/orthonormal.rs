//! Orthonormal columns of tall matrices, by faer's QR decomposition.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::{Mat, MatRef};

/// Q of A = QR, with as many columns as A has: its first k columns span the first k of A.
///
/// # Errors
/// [`NoConvergence`] for values that are not finite.
///
/// # Panics
/// Where A has fewer rows than columns.
pub fn orthonormal(a: &Matrix) -> Result<Matrix, NoConvergence> {
    assert!(a.nrows() >= a.ncols(), "as many rows as columns");
    if !a.is_finite() {
        return Err(NoConvergence);
    }
    let q: Mat<c64> = a.as_faer().qr().compute_thin_Q();
    Ok(Matrix::from_fn(a.nrows(), a.ncols(), |i, j| q[(i, j)]))
}

/// R of A = QR of a real matrix with so many columns, column after column; fewer rows than columns are filled up with zeros.
///
/// # Errors
/// [`NoConvergence`] for values that are not finite.
///
/// # Panics
/// Where the length is not a multiple of `columns`.
pub fn upper_triangle(a: &[f64], columns: usize) -> Result<Vec<f64>, NoConvergence> {
    if columns == 0 {
        return Ok(Vec::new());
    }
    assert_eq!(a.len() % columns, 0, "whole columns");
    if !a.iter().all(|value| value.is_finite()) {
        return Err(NoConvergence);
    }
    let rows = a.len() / columns;
    let qr = match rows >= columns {
        true => MatRef::from_column_major_slice(a, rows, columns).qr(),
        false => Mat::from_fn(columns, columns, |i, j| if i < rows { a[i + j * rows] } else { 0.0 }).qr(),
    };
    let r = qr.thin_R();
    let entry = |at: usize| (at % columns, at / columns);
    let value = |(i, j): (usize, usize)| if i <= j { r[(i, j)] } else { 0.0 };
    Ok((0..columns * columns).map(entry).map(value).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_orthonormal_and_span_those_of_the_matrix() {
        let a = Matrix::from_fn(4, 2, |i, j| c64::new((i * (j + 1)) as f64 + 1.0, (i + j) as f64));
        let q = orthonormal(&a).unwrap();
        let dot = |x: &[c64], y: &[c64]| x.iter().zip(y).map(|(x, y)| x.conj() * y).sum::<c64>();
        assert!((dot(q.column(0), q.column(0)) - 1.0).norm() < 1e-15);
        assert!(dot(q.column(0), q.column(1)).norm() < 1e-15);
        let size = dot(a.column(0), a.column(0)).re.sqrt();
        assert!((dot(q.column(0), a.column(0)).norm() - size).abs() < 1e-14);
        assert_eq!(orthonormal(&Matrix::from_fn(1, 1, |_, _| c64::new(f64::NAN, 0.0))), Err(NoConvergence));
    }

    #[test]
    fn a_triangle_has_the_products_of_the_columns() {
        let a = [3.0, 4.0, 0.0, 1.0, 2.0, 2.0];
        let r = upper_triangle(&a, 2).unwrap();
        let product = |x: &[f64], i: usize, j: usize| -> f64 {
            let rows = x.len() / 2;
            (0..rows).map(|k| x[k + i * rows] * x[k + j * rows]).sum()
        };
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            assert!((product(&r, i, j) - product(&a, i, j)).abs() < 1e-13, "{r:?}");
        }
        assert!((r[0].abs() - 5.0).abs() < 1e-14 && r[1] == 0.0);
        // One row, two columns.
        assert_eq!(upper_triangle(&[2.0, 1.0], 2).unwrap()[0].abs(), 2.0);
    }
}
