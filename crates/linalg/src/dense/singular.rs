//! Singular values of a tall real matrix, by faer's QR iteration.

use super::NoConvergence;
use faer::Mat;

/// A = U Σ Vᵀ without U: σ_i descending, one for each column, and the right singular vectors.
#[derive(Debug, Clone, PartialEq)]
pub struct Singular {
    /// σ_i; zeros where A has fewer rows than columns.
    pub values: Vec<f64>,
    /// v_i, orthonormal, one entry for each column of A.
    pub vectors: Vec<Vec<f64>>,
}

/// All singular values and right singular vectors of a real matrix with `columns` columns, given column after column.
///
/// # Errors
/// [`NoConvergence`] for values that are not finite, or where the iteration fails.
///
/// # Panics
/// Where the length is not a multiple of `columns`.
pub fn singular(a: &[f64], columns: usize) -> Result<Singular, NoConvergence> {
    if columns == 0 {
        return Ok(Singular { values: Vec::new(), vectors: Vec::new() });
    }
    assert_eq!(a.len() % columns, 0, "whole columns");
    if !a.iter().all(|value| value.is_finite()) {
        return Err(NoConvergence);
    }
    let rows = a.len() / columns;
    // Rows of zeros change nothing, and give each column its singular value.
    let entry = |i: usize, j: usize| if i < rows { a[i + j * rows] } else { 0.0 };
    let padded = Mat::from_fn(rows.max(columns), columns, entry);
    let svd = padded.thin_svd().map_err(|_| NoConvergence)?;
    let (values, vectors) = (svd.S(), svd.V());
    Ok(Singular {
        values: (0..columns).map(|i| values[i]).collect(),
        vectors: (0..columns).map(|i| (0..columns).map(|j| vectors[(j, i)]).collect()).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_descend_and_vectors_are_those_of_the_columns() {
        // Columns 3e₁ and 4e₂ of three rows.
        let found = singular(&[3.0, 0.0, 0.0, 0.0, 4.0, 0.0], 2).unwrap();
        assert!((found.values[0] - 4.0).abs() < 1e-15 && (found.values[1] - 3.0).abs() < 1e-15);
        assert!((found.vectors[0][1].abs() - 1.0).abs() < 1e-15 && found.vectors[0][0].abs() < 1e-15);
    }

    #[test]
    fn fewer_rows_than_columns_leave_a_null_space() {
        let found = singular(&[1.0, 1.0, 1.0], 3).unwrap();
        assert!((found.values[0] - 3f64.sqrt()).abs() < 1e-15 && found.values[1] < 1e-15);
        let sum: f64 = found.vectors[2].iter().sum();
        assert!(sum.abs() < 1e-14, "orthogonal to what is seen: {sum}");
        assert_eq!(singular(&[f64::NAN], 1), Err(NoConvergence));
        assert_eq!(singular(&[], 2).unwrap().values, [0.0, 0.0]);
    }
}
