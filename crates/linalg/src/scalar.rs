//! The two scalars that there are.

use crate::c64;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for num_complex::Complex64 {}
}

/// `f64` or [`c64`], and nothing else: what the symmetric solvers are written over.
pub trait Scalar:
    sealed::Sealed
    + faer::traits::ComplexField<Real = f64>
    + Copy
    + Send
    + Sync
    + Debug
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + 'static
{
    /// |a|.
    fn modulus(self) -> f64;
    /// Neither infinite nor NaN in any part.
    fn finite(self) -> bool;
}

impl Scalar for f64 {
    fn modulus(self) -> f64 {
        self.abs()
    }

    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl Scalar for c64 {
    fn modulus(self) -> f64 {
        self.norm()
    }

    fn finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

/// max |aᵢ| over a slice; 0 for an empty one, NaN and infinities pass through.
pub(crate) fn max_modulus<T: Scalar>(values: &[T]) -> f64 {
    values.iter().map(|value| value.modulus()).fold(0.0, |largest, modulus| {
        // `f64::max` drops NaN, and a NaN must not be dropped here.
        if modulus > largest || modulus.is_nan() { modulus } else { largest }
    })
}
