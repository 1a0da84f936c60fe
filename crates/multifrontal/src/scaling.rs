//! Symmetric scaling S A S that brings the largest entry of every row near 1.

use crate::FactorError;
use crate::scalar::{Real, Scalar};
use crate::symbolic::Lower;

/// Passes: each halves the logarithm of what is left; three leave an eighth.
const PASSES: usize = 3;

/// The diagonal of S, in powers of two so that no digit is lost.
///
/// # Errors
/// [`FactorError::Values`], [`FactorError::NotFinite`].
///
/// # Source
/// D. Ruiz, RAL-TR-2001-034.
pub(crate) fn scaling<T: Scalar>(pattern: &Lower, values: &[T]) -> Result<Vec<T::Real>, FactorError> {
    let expected = pattern.row_idx.len();
    if values.len() != expected {
        return Err(FactorError::Values { expected, found: values.len() });
    }
    if let Some(at) = values.iter().position(|value| !value.is_finite()) {
        let col = pattern.col_ptr.partition_point(|&start| start <= at) - 1;
        return Err(FactorError::NotFinite { row: pattern.row_idx[at] as usize, col });
    }
    let sizes: Vec<f64> = values.iter().map(|value| value.size()).collect();
    let mut scale = vec![1.0f64; pattern.dim];
    let mut largest = vec![0.0f64; pattern.dim];
    // Plain comparisons: `f64::max` asks for numbers that are none.
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    for _ in 0..PASSES {
        largest.fill(0.0);
        for col in 0..pattern.dim {
            let (mut own, by) = (largest[col], scale[col]);
            let sizes = &sizes[pattern.col_ptr[col]..pattern.col_ptr[col + 1]];
            for (&row, size) in pattern.column(col).iter().zip(sizes) {
                let row = row as usize;
                let size = size * scale[row] * by;
                largest[row] = larger(largest[row], size);
                own = larger(own, size);
            }
            largest[col] = larger(largest[col], own);
        }
        for (scale, &largest) in scale.iter_mut().zip(&largest) {
            // A row of zeros stays one; a size that overflows or underflows has no root to divide by.
            if largest > 0.0 && largest.is_finite() {
                *scale /= largest.sqrt();
            }
        }
    }
    let power = |scale: f64| T::Real::from_f64(scale.log2().round().clamp(-500.0, 500.0).exp2());
    Ok(scale.into_iter().map(power).collect())
}
