//! Real matrices with complex weights and vectors: what a reduced model is put together from.

use super::Matrix;
use crate::c64;
use pulp::{Arch, NullaryFnOnce};

/// Entries of a sum that stay in the nearest cache while its parts go by.
const ENTRIES_PER_PIECE: usize = 1024;

/// Σ θ_g S_g of real nrows × ncols matrices, column after column.
///
/// # Panics
/// Where a matrix is of another size.
pub fn combination(nrows: usize, ncols: usize, parts: &[(c64, &[f64])]) -> Matrix {
    assert!(parts.iter().all(|(_, matrix)| matrix.len() == nrows * ncols));
    let mut values = vec![c64::default(); nrows * ncols];
    Arch::new().dispatch(Combination { parts, sum: &mut values });
    Matrix::of(nrows, ncols, values)
}

/// S y of a real square matrix, column after column, and a complex vector.
///
/// # Panics
/// Where the lengths do not fit.
pub fn multiply(matrix: &[f64], y: &[c64]) -> Vec<c64> {
    assert_eq!(matrix.len(), y.len() * y.len());
    let (mut re, mut im) = (vec![0.0; y.len()], vec![0.0; y.len()]);
    Arch::new().dispatch(Product { matrix, y, re: &mut re, im: &mut im });
    re.into_iter().zip(im).map(|(re, im)| c64::new(re, im)).collect()
}

struct Combination<'a> {
    parts: &'a [(c64, &'a [f64])],
    sum: &'a mut [c64],
}

impl NullaryFnOnce for Combination<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (k, piece) in self.sum.chunks_mut(ENTRIES_PER_PIECE).enumerate() {
            for (theta, matrix) in self.parts {
                let own = &matrix[k * ENTRIES_PER_PIECE..];
                piece.iter_mut().zip(own).for_each(|(sum, s)| *sum += theta * s);
            }
        }
    }
}

struct Product<'a> {
    matrix: &'a [f64],
    y: &'a [c64],
    re: &'a mut [f64],
    im: &'a mut [f64],
}

impl NullaryFnOnce for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { matrix, y, re, im } = self;
        // two sums of real numbers are what registers are for
        for (column, y) in matrix.chunks_exact(y.len().max(1)).zip(y) {
            for ((re, im), s) in re.iter_mut().zip(im.iter_mut()).zip(column) {
                *re += s * y.re;
                *im += s * y.im;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_products_are_those_of_complex_matrices() {
        // longer than a piece, so that the second one is met
        let n = 40;
        let of = |seed: usize| -> Vec<f64> { (0..n * n).map(|k| ((k * seed) % 17) as f64 - 8.0).collect() };
        let (a, b) = (of(7), of(5));
        let theta = [c64::new(0.5, 2.0), c64::new(-1.0, 0.25)];
        let sum = combination(n, n, &[(theta[0], &a), (theta[1], &b)]);
        let expected = Matrix::from_fn(n, n, |i, j| a[i + j * n] * theta[0] + b[i + j * n] * theta[1]);
        // small whole numbers and halves: no rounding
        assert_eq!(sum, expected);
        let y: Vec<c64> = (0..n).map(|k| c64::new(k as f64, 1.0 - k as f64)).collect();
        let whole = Matrix::from_fn(n, n, |i, j| c64::new(a[i + j * n], 0.0));
        assert_eq!(multiply(&a, &y), whole.multiply(&y));
        assert_eq!(combination(2, 3, &[]), Matrix::zeros(2, 3));
    }
}
