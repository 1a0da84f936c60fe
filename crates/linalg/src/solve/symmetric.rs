//! Real symmetric: faer's supernodal L Lᵀ where that succeeds, L B Lᵀ with Bunch–Kaufman pivots elsewhere,
//! and LU where constraints leave zeros on the diagonal.
//!
//! J. R. Bunch, L. Kaufman, Math. Comp. 31 (1977) 163–179.

use super::lu::Lu;
use super::memory::{FactorMemory, bytes_of, scratch, zeros};
use super::ordering::fill_reducing;
use super::{Breakdown, Factor, PAR, Symbolic};
use crate::sparse::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};
use std::sync::{Arc, OnceLock};

/// Real symmetric, definite or not; the symbolic analysis serves both symmetric factorisations.
pub(super) struct Symmetric {
    pattern: Arc<Pattern>,
    lu: Arc<Lu>,
    symbolic: OnceLock<Option<Arc<SymbolicCholesky<usize>>>>,
}

impl Symmetric {
    pub(super) fn new(pattern: &Arc<Pattern>, lu: Arc<Lu>) -> Self {
        Self { pattern: Arc::clone(pattern), lu, symbolic: OnceLock::new() }
    }

    fn lower(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.pattern.dim();
        SymbolicSparseColMatRef::new_checked(n, n, self.pattern.col_ptr(), None, self.pattern.row_idx())
    }

    fn analyse(&self) -> Option<Arc<SymbolicCholesky<usize>>> {
        // Pivoting needs the dense block of a supernode to choose from.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let order = fill_reducing(&self.pattern)?;
        let mut inverse = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &row)| inverse[row] = k);
        let order = PermRef::new_checked(&order, &inverse, order.len());
        factorize_symbolic_cholesky(self.lower(), Side::Lower, SymmetricOrdering::Custom(order), params)
            .ok()
            .map(Arc::new)
    }

    fn symbolic(&self) -> Result<Arc<SymbolicCholesky<usize>>, Breakdown> {
        self.symbolic.get_or_init(|| self.analyse()).clone().ok_or(Breakdown::OutOfMemory)
    }

    /// Whether L Lᵀ exists, that is whether all pivots are positive; L if it does.
    fn cholesky(&self, matrix: &[f64], factor: &mut [f64]) -> Result<bool, Breakdown> {
        let symbolic = self.symbolic()?;
        let mut buffer = scratch(symbolic.factorize_numeric_llt_scratch::<f64>(PAR, Default::default()))?;
        let outcome = symbolic.factorize_numeric_llt(
            factor,
            SparseColMatRef::new(self.lower(), matrix),
            Side::Lower,
            Default::default(),
            PAR,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        match outcome {
            Ok(_) => Ok(true),
            Err(LltError::NonPositivePivot { .. }) => Ok(false),
        }
    }

    fn bunch_kaufman(&self, matrix: &[f64], values: Vec<f64>) -> Result<BunchKaufman, Breakdown> {
        let symbolic = self.symbolic()?;
        let n = self.pattern.dim();
        let mut factor = BunchKaufman {
            values,
            subdiagonal: zeros(n)?,
            forward: zeros(n)?,
            inverse: zeros(n)?,
            symbolic: Arc::clone(&symbolic),
        };
        let mut buffer =
            scratch(symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(PAR, Default::default()))?;
        symbolic.factorize_numeric_intranode_lblt(
            &mut factor.values,
            &mut factor.subdiagonal,
            &mut factor.forward,
            &mut factor.inverse,
            SparseColMatRef::new(self.lower(), matrix),
            Side::Lower,
            PAR,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        Ok(factor)
    }
}

impl Symbolic<f64> for Symmetric {
    fn factor(&self, matrix: &[f64]) -> Result<Box<dyn Factor<f64>>, Breakdown> {
        let diagonal = || (0..self.pattern.dim()).map(|col| matrix[self.pattern.col_ptr()[col]]);
        // A constraint has few neighbours: it is eliminated early, alone, and its supernode has no other pivot.
        if diagonal().any(|a| a == 0.0) {
            return Symbolic::<f64>::factor(self.lu.as_ref(), matrix);
        }
        let symbolic = self.symbolic()?;
        let mut values = zeros(symbolic.len_val())?;
        // A definite matrix has a positive diagonal; an indefinite one with a positive diagonal shows itself
        // in L Lᵀ by a pivot that is not positive, at the price of what was done up to there.
        if diagonal().all(|a| a > 0.0) && self.cholesky(matrix, &mut values)? {
            return Ok(Box::new(Cholesky { symbolic, values }));
        }
        Ok(Box::new(self.bunch_kaufman(matrix, values)?))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        let symbolic = self.symbolic()?;
        let n = self.pattern.dim();
        // What Bunch–Kaufman takes: it needs a little more than L Lᵀ, and the numbers alone decide.
        let cholesky = symbolic.factorize_numeric_llt_scratch::<f64>(PAR, Default::default());
        let pivoted = symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(PAR, Default::default());
        Ok(FactorMemory {
            kept: bytes_of::<f64>(symbolic.len_val()) + bytes_of::<f64>(n) + bytes_of::<usize>(2 * n),
            scratch: cholesky.or(pivoted).unaligned_bytes_required(),
        })
    }
}

struct Cholesky {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
}

impl Factor<f64> for Cholesky {
    fn solve_in_place(&self, rhs: &mut [f64]) {
        let n = self.symbolic.nrows();
        let columns = rhs.len() / n;
        let mut buffer = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, PAR));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, columns),
            PAR,
            MemStack::new(&mut buffer),
        );
    }
}

struct BunchKaufman {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl Factor<f64> for BunchKaufman {
    fn solve_in_place(&self, rhs: &mut [f64]) {
        let n = self.symbolic.nrows();
        let columns = rhs.len() / n;
        let mut buffer = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, PAR));
        let pivots = PermRef::new_checked(&self.forward, &self.inverse, n);
        IntranodeLbltRef::new(&self.symbolic, &self.values, &self.subdiagonal, pivots)
            .solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(rhs, n, columns),
                PAR,
                MemStack::new(&mut buffer),
            );
    }
}
