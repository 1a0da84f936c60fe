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

/// A = QR of a real matrix: Q as A and R, `columns` × `columns`, both column after column.
#[derive(Debug, Clone, PartialEq)]
pub struct RealQr {
    /// Q.
    pub q: Vec<f64>,
    /// R, zeros below its diagonal.
    pub r: Vec<f64>,
}

/// A = QR of a real matrix with `columns` columns, column after column; fewer rows than columns are filled up with zeros.
///
/// # Errors
/// [`NoConvergence`] for values that are not finite.
///
/// # Panics
/// Where the length is not a multiple of `columns`.
pub fn real_qr(a: &[f64], columns: usize) -> Result<RealQr, NoConvergence> {
    if columns == 0 {
        return Ok(RealQr { q: Vec::new(), r: Vec::new() });
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
    let (q, r) = (qr.compute_thin_Q(), qr.thin_R());
    let each = |n: usize| (0..columns).flat_map(move |j| (0..n).map(move |i| (i, j)));
    Ok(RealQr {
        q: each(rows).map(|(i, j)| q[(i, j)]).collect(),
        r: each(columns).map(|(i, j)| if i <= j { r[(i, j)] } else { 0.0 }).collect(),
    })
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
    fn a_real_matrix_is_the_product_of_its_factors() {
        let a = [3.0, 4.0, 0.0, 1.0, 2.0, 2.0];
        let RealQr { q, r } = real_qr(&a, 2).unwrap();
        for j in 0..2 {
            for i in 0..3 {
                let product: f64 = (0..2).map(|k| q[i + 3 * k] * r[k + 2 * j]).sum();
                assert!((product - a[i + 3 * j]).abs() < 1e-14);
            }
        }
        assert!((r[0].abs() - 5.0).abs() < 1e-14 && r[1] == 0.0);
        // One row, two columns.
        assert_eq!(real_qr(&[2.0, 1.0], 2).unwrap().r[0].abs(), 2.0);
    }
}
