//! Products and projections of vectors.

use crate::{Scalar, c64};

/// Σ aᵢ bᵢ, without conjugation: what complex symmetric matrices want.
pub fn transpose_dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::default(), |sum, (&a, &b)| sum + a * b)
}

/// Σ āᵢ bᵢ.
pub fn dot(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

/// √Σ |aᵢ|².
pub fn norm(a: &[c64]) -> f64 {
    a.iter().map(|a| a.norm_sqr()).sum::<f64>().sqrt()
}

/// Takes out of x what lies in the span of orthonormal vectors, and returns it as coefficients.
///
/// Gram–Schmidt, twice, which is enough (Kahan, Parlett): the rest is orthogonal to roundoff of the original x.
pub fn orthogonalise(basis: &[Vec<c64>], x: &mut [c64]) -> Vec<c64> {
    let mut coefficients = vec![c64::default(); basis.len()];
    for _ in 0..2 {
        for (v, coefficient) in basis.iter().zip(&mut coefficients) {
            let overlap = dot(v, x);
            x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
            *coefficient += overlap;
        }
    }
    coefficients
}
