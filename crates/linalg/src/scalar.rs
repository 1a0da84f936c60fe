//! The two scalars that there are.

use crate::c64;
use crate::sparse::{Pattern, accumulate, side_by_side};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for num_complex::Complex64 {}
}

/// `f64` or [`c64`], and nothing else: what the symmetric solvers are written over.
pub trait Scalar: sealed::Sealed + faer::traits::ComplexField<Real = f64> + multifrontal::Scalar {
    /// out −= A X for the matrix with these values, n × k column after column.
    #[doc(hidden)]
    fn multiply_subtract(pattern: &Pattern, values: &[Self], x: &[Self], out: &mut [Self]);
}

impl Scalar for f64 {
    fn multiply_subtract(pattern: &Pattern, values: &[f64], x: &[f64], out: &mut [f64]) {
        side_by_side::multiply_add(pattern, values, |a| -a, x, out);
    }
}

impl Scalar for c64 {
    fn multiply_subtract(pattern: &Pattern, values: &[c64], x: &[c64], out: &mut [c64]) {
        let n = pattern.dim().max(1);
        for (x, out) in x.chunks_exact(n).zip(out.chunks_exact_mut(n)) {
            accumulate(pattern, values, x, out, |a, b| -(a * b));
        }
    }
}

/// max |aᵢ| over a slice; 0 for an empty one, NaN and infinities pass through.
pub(crate) fn max_modulus<T: Scalar>(values: &[T]) -> f64 {
    values.iter().map(|value| value.modulus()).fold(0.0, |largest, modulus| {
        // `f64::max` drops NaN, and a NaN must not be dropped here.
        if modulus > largest || modulus.is_nan() { modulus } else { largest }
    })
}
