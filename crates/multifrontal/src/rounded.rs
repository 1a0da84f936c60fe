//! A factor in single precision of a matrix in double.

use crate::scalar::{Real, Scalar};
use crate::{Factor, FactorError, Inertia, Options, Symbolic, Threads, scaling, size};

/// L D Lᵀ in single precision of S A S for a matrix A in double: half of the memory of [`Factor`].
///
/// S scales A so that nothing overflows. [`Symbolic::factor_rounded`] makes it.
///
/// # Limits
/// A solution has some seven digits times the condition of the matrix, so that it has to be refined; [`Solver`](crate::Solver) does.
#[derive(Debug)]
pub struct RoundedFactor<T: Scalar> {
    factor: Factor<T::Single>,
    /// S by row.
    scale: Vec<T::Real>,
}

impl Symbolic {
    /// Factorises a matrix in single precision, whatever its own is.
    ///
    /// # Errors
    /// As [`Symbolic::factor`].
    pub fn factor_rounded<T: Scalar>(
        &self,
        values: &[T],
        options: &Options,
    ) -> Result<RoundedFactor<T>, FactorError> {
        let scale = scaling::scaling(&self.pattern, values, 1)?;
        let scaled = self.pattern.positions().zip(values);
        let scaled = scaled.map(|((row, col), value)| value.scale(scale[row]).scale(scale[col]).to_single());
        let factor = self.factor(&scaled.collect::<Vec<_>>(), options)?;
        Ok(RoundedFactor { factor, scale })
    }

    /// Bytes that a [`RoundedFactor`] keeps, if no pivot is delayed.
    pub fn rounded_factor_bytes<T: Scalar>(&self) -> usize {
        self.factor_bytes::<T::Single>() + self.dim() * size_of::<T::Real>()
    }

    /// Bytes that a factorisation in single precision by one worker needs beyond the factor, at most, if no pivot is delayed.
    pub fn rounded_working_bytes<T: Scalar>(&self) -> usize {
        self.working_bytes::<T::Single>() + self.pattern.row_idx.len() * size_of::<T::Single>()
    }
}

impl<T: Scalar> RoundedFactor<T> {
    /// Overwrites k right-hand sides (n × k, column after column) with the solutions, unrefined.
    ///
    /// # Panics
    /// Where there are not whole right-hand sides.
    pub fn solve_in_place(&self, rhs: &mut [T], threads: Threads) {
        let n = self.scale.len().max(1);
        let mut single = vec![T::Single::default(); rhs.len()];
        let mut sizes = Vec::with_capacity(rhs.len() / n);
        for (x, single) in rhs.chunks_exact_mut(n).zip(single.chunks_exact_mut(n)) {
            x.iter_mut().zip(&self.scale).for_each(|(x, &scale)| *x = x.scale(scale));
            // A residual is small: brought to 1 it keeps all digits of single precision.
            let largest = size(x);
            let down = T::Real::from_f64(if largest > 0.0 { 1.0 / largest } else { 1.0 });
            single.iter_mut().zip(x.iter()).for_each(|(single, x)| *single = x.scale(down).to_single());
            sizes.push(largest);
        }
        self.factor.solve_in_place(&mut single, threads);
        for ((x, single), largest) in rhs.chunks_exact_mut(n).zip(single.chunks_exact(n)).zip(sizes) {
            let up = T::Real::from_f64(largest);
            for ((x, &single), &scale) in x.iter_mut().zip(single).zip(&self.scale) {
                *x = T::from_single(single).scale(up).scale(scale);
            }
        }
    }

    /// Signs of the pivots: see [`Factor::inertia`].
    ///
    /// # Limits
    /// An eigenvalue of S A S that is smaller than single precision resolves, some 10⁻⁷ of the largest one, may be counted on either side.
    pub fn inertia(&self) -> Inertia {
        self.factor.inertia()
    }
}
