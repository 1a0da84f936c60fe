//! Dense LU with partial pivoting, for tiny models and as an oracle for the sparse back-end.

use super::memory::{FactorMemory, bytes_of};
use super::{Breakdown, Factor, Symbolic};
use crate::Scalar;
use crate::sparse::Pattern;
use faer::linalg::solvers::{PartialPivLu, SolveCore};
use faer::{Conj, Mat, MatMut};
use std::sync::Arc;

pub(super) struct DenseSymbolic {
    pattern: Arc<Pattern>,
}

impl DenseSymbolic {
    pub(super) fn new(pattern: Arc<Pattern>) -> Self {
        Self { pattern }
    }
}

impl<T: Scalar> Symbolic<T> for DenseSymbolic {
    fn factor(&self, values: &[T], _threads: usize) -> Result<Box<dyn Factor<T>>, Breakdown> {
        let n = self.pattern.dim();
        let mut matrix = Mat::<T>::zeros(n, n);
        for ((row, col), &value) in self.pattern.positions().zip(values) {
            matrix[(row, col)] = value;
            matrix[(col, row)] = value;
        }
        Ok(Box::new(DenseFactor(matrix.partial_piv_lu())))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        // L and U of the factor; the matrix, and the work array that becomes them.
        let square = bytes_of::<T>(self.pattern.dim().pow(2));
        Ok(FactorMemory { kept: 2 * square, scratch: 2 * square })
    }
}

struct DenseFactor<T>(PartialPivLu<T>);

impl<T: Scalar> Factor<T> for DenseFactor<T> {
    fn solve_in_place(&self, rhs: &mut [T], _threads: usize) -> Result<(), Breakdown> {
        let n = self.0.L().nrows();
        let columns = rhs.len() / n;
        self.0.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(rhs, n, columns));
        Ok(())
    }

    fn negative_eigenvalues(&self) -> Option<usize> {
        None // LU is no congruence
    }
}
