//! Eigenvalues of small matrices, by faer's QR and symmetric QR iterations.

use super::{Matrix, NoConvergence};
use crate::c64;
use faer::{MatRef, Side};

/// Eigenvalues λᵢ and right eigenvectors vᵢ (columns, of norm one) of A v = λ v.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigen {
    /// λᵢ, in the order of the iteration.
    pub values: Vec<c64>,
    /// vᵢ in column i.
    pub vectors: Matrix,
}

/// All eigenvalues and eigenvectors of a square matrix.
///
/// # Errors
/// [`NoConvergence`] for a matrix with values that are not finite, or where the QR iteration fails.
///
/// # Panics
/// Where A is not square.
///
/// # Limits
/// Backward stable: of a non-normal matrix (a long Jordan-like block) single eigenvalues may be far off.
pub fn eigen(a: &Matrix) -> Result<Eigen, NoConvergence> {
    assert_eq!(a.nrows(), a.ncols());
    if !a.is_finite() {
        return Err(NoConvergence);
    }
    let decomposition = a.as_faer().eigen().map_err(|_| NoConvergence)?;
    let (values, vectors) = (decomposition.S(), decomposition.U());
    let n = a.nrows();
    let mut unit = Matrix::from_fn(n, n, |i, j| vectors[(i, j)]);
    for j in 0..n {
        let norm = unit.column(j).iter().map(|v| v.norm_sqr()).sum::<f64>().sqrt();
        (0..n).for_each(|i| unit[(i, j)] /= norm);
    }
    Ok(Eigen { values: (0..n).map(|i| values[i]).collect(), vectors: unit })
}

/// All eigenvalues of a square matrix, without vectors.
///
/// # Errors
/// [`NoConvergence`] for a matrix with values that are not finite, or where the QR iteration fails.
///
/// # Panics
/// Where A is not square.
///
/// # Limits
/// Those of [`eigen`].
pub fn eigenvalues(a: &Matrix) -> Result<Vec<c64>, NoConvergence> {
    assert_eq!(a.nrows(), a.ncols());
    if !a.is_finite() {
        return Err(NoConvergence);
    }
    a.as_faer().eigenvalues().map_err(|_| NoConvergence)
}

/// Eigenvalues, ascending, and orthonormal eigenvectors (n × n, column after column) of a real symmetric
/// matrix, of which the lower triangle is read (n × n, column after column).
///
/// # Errors
/// [`NoConvergence`] for values that are not finite, or where the iteration fails.
///
/// # Panics
/// Where the length is not n².
pub fn symmetric_eigen(n: usize, a: &[f64]) -> Result<(Vec<f64>, Vec<f64>), NoConvergence> {
    assert_eq!(a.len(), n * n);
    if !a.iter().all(|value| value.is_finite()) {
        return Err(NoConvergence);
    }
    if n == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    let matrix = MatRef::from_column_major_slice(a, n, n);
    let decomposition = matrix.self_adjoint_eigen(Side::Lower).map_err(|_| NoConvergence)?;
    let (values, vectors) = (decomposition.S(), decomposition.U());
    let values = (0..n).map(|i| values[i]).collect();
    Ok((values, (0..n).flat_map(|j| (0..n).map(move |i| vectors[(i, j)])).collect()))
}
