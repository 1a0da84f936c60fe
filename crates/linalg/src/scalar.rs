//! The two scalars that there are.

use crate::c64;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for num_complex::Complex64 {}
}

/// `f64` or [`c64`], and nothing else: what the symmetric solvers are written over.
pub trait Scalar:
    sealed::Sealed + faer::traits::ComplexField<Real = f64> + multifrontal::Scalar<Real = f64>
{
}

impl Scalar for f64 {}

impl Scalar for c64 {}

/// max |aᵢ| over a slice; 0 for an empty one, NaN and infinities pass through.
pub(crate) fn max_modulus<T: Scalar>(values: &[T]) -> f64 {
    values.iter().map(|value| value.modulus()).fold(0.0, |largest, modulus| {
        // `f64::max` drops NaN, and a NaN must not be dropped here.
        if modulus > largest || modulus.is_nan() { modulus } else { largest }
    })
}
