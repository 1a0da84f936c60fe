//! Symmetric scaling S A S that brings the largest entry of every row near 1.

use crate::FactorError;
use crate::scalar::{Real, Scalar};
use crate::symbolic::Lower;
use crate::threads::map;
use std::ops::Range;

/// Passes: each halves the remaining logarithm; three leave an eighth.
const SCALING_PASSES: usize = 3;

/// Entries below which another thread costs more than it brings.
const MIN_SHARED_ENTRIES: usize = 50_000;

/// The diagonal of S, in powers of two so that no digit is lost.
///
/// # Errors
/// [`FactorError::Values`], [`FactorError::NotFinite`].
///
/// # Source
/// D. Ruiz, RAL-TR-2001-034.
pub(crate) fn scaling<T: Scalar>(
    pattern: &Lower,
    values: &[T],
    threads: usize,
) -> Result<Vec<T::Real>, FactorError> {
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
    let threads = if values.len() < MIN_SHARED_ENTRIES { 1 } else { threads };
    let columns: Vec<_> =
        (0..threads).map(|k| k * pattern.dim / threads..(k + 1) * pattern.dim / threads).collect();
    for _ in 0..SCALING_PASSES {
        let largest = map(threads, columns.clone(), |columns| largest(pattern, columns, &sizes, &scale));
        for (row, scale) in scale.iter_mut().enumerate() {
            let largest = largest.iter().map(|of| of[row]).fold(0.0, larger);
            // A row of zeros stays one; a size that overflows or underflows has no root to divide by.
            if largest > 0.0 && largest.is_finite() {
                *scale /= largest.sqrt();
            }
        }
    }
    let power = |scale: f64| T::Real::from_f64(scale.log2().round().clamp(-500.0, 500.0).exp2());
    Ok(scale.into_iter().map(power).collect())
}

/// The largest scaled entry of every row, as far as some columns show it, and they as rows.
fn largest(pattern: &Lower, columns: Range<usize>, sizes: &[f64], scale: &[f64]) -> Vec<f64> {
    let mut largest = vec![0.0f64; pattern.dim];
    for col in columns {
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
    largest
}

/// A plain comparison: `f64::max` also asks for NaN.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
