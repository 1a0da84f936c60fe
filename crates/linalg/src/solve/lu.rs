//! faer's sparse factorisations: supernodal Bunch–Kaufman for real symmetric, LU for complex symmetric.
//!
//! faer's symmetric factorisations are Hermitian for complex numbers, which a dynamic stiffness is not
//! (METHOD: Aᵀ = A); its LU is the one that solves them, at the price of both triangles and of a
//! column ordering.

use super::{Breakdown, Factor, Symbolic};
use crate::c64;
use crate::sparse::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::linalg::{LuError, SupernodalThreshold};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::sync::{Arc, OnceLock};

/// Parallelism is over frequencies, above this crate: one factorisation runs on one thread.
const PAR: Par = Par::Seq;

fn scratch(request: faer::dyn_stack::StackReq) -> Result<MemBuffer, Breakdown> {
    MemBuffer::try_new(request).map_err(|_| Breakdown::OutOfMemory)
}

fn zeros<T: Copy + Default>(len: usize) -> Result<Vec<T>, Breakdown> {
    let mut values = Vec::new();
    values.try_reserve_exact(len).map_err(|_| Breakdown::OutOfMemory)?;
    values.resize(len, T::default());
    Ok(values)
}

/// Complex symmetric: LU of both triangles, threshold partial pivoting, COLAMD ordering.
pub(super) struct Lu {
    full: Arc<FullPattern>,
    symbolic: OnceLock<Option<Arc<SymbolicLu<usize>>>>,
}

/// Both triangles by columns, and for each position the place of its value in the lower triangle.
struct FullPattern {
    dim: usize,
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
    source: Vec<usize>,
}

impl FullPattern {
    fn new(pattern: &Pattern) -> Self {
        let dim = pattern.dim();
        let mut columns = vec![Vec::new(); dim];
        // Ascending columns, so that each column of the upper triangle comes out with ascending rows,
        // and before the lower triangle of that column.
        for (k, (row, col)) in pattern.positions().enumerate() {
            columns[col].push((row, k));
            if row != col {
                columns[row].push((col, k));
            }
        }
        let mut col_ptr = Vec::with_capacity(dim + 1);
        col_ptr.push(0);
        let (mut row_idx, mut source) = (Vec::new(), Vec::new());
        for mut column in columns {
            column.sort_unstable();
            row_idx.extend(column.iter().map(|&(row, _)| row));
            source.extend(column.iter().map(|&(_, k)| k));
            col_ptr.push(row_idx.len());
        }
        Self { dim, col_ptr, row_idx, source }
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.dim, self.dim, &self.col_ptr, None, &self.row_idx)
    }
}

impl Lu {
    pub(super) fn new(pattern: &Pattern) -> Self {
        Self { full: Arc::new(FullPattern::new(pattern)), symbolic: OnceLock::new() }
    }
}

impl Symbolic<c64> for Lu {
    fn factor(&self, values: &[c64]) -> Result<Box<dyn Factor<c64>>, Breakdown> {
        let pattern = self.full.symbolic();
        let symbolic = self
            .symbolic
            .get_or_init(|| factorize_symbolic_lu(pattern, Default::default()).ok().map(Arc::new))
            .clone()
            .ok_or(Breakdown::OutOfMemory)?;
        let full: Vec<c64> = self.full.source.iter().map(|&k| values[k]).collect();
        let mut numeric = NumericLu::new();
        let mut buffer = scratch(symbolic.factorize_numeric_lu_scratch::<c64>(PAR, Default::default()))?;
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                SparseColMatRef::new(pattern, &full),
                PAR,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|error| match error {
                LuError::SymbolicSingular { .. } => Breakdown::Singular { condition_at_least: f64::INFINITY },
                LuError::Generic(_) => Breakdown::OutOfMemory,
            })?;
        Ok(Box::new(LuFactor { symbolic, numeric }))
    }
}

struct LuFactor {
    symbolic: Arc<SymbolicLu<usize>>,
    numeric: NumericLu<usize, c64>,
}

impl Factor<c64> for LuFactor {
    fn solve_in_place(&self, rhs: &mut [c64]) {
        let n = self.symbolic.nrows();
        let columns = rhs.len() / n;
        let mut buffer = MemBuffer::new(self.symbolic.solve_in_place_scratch::<c64>(columns, PAR));
        let factor = LuRef::new_unchecked(&self.symbolic, &self.numeric);
        factor.solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, columns),
            PAR,
            MemStack::new(&mut buffer),
        );
    }
}

/// Real symmetric: supernodal L B Lᵀ with Bunch–Kaufman pivots inside each supernode, AMD ordering.
///
/// Bunch & Kaufman, Math. Comp. 31 (1977) 163–179.
pub(super) struct BunchKaufman {
    pattern: Arc<Pattern>,
    symbolic: OnceLock<Option<Arc<SymbolicCholesky<usize>>>>,
}

impl BunchKaufman {
    pub(super) fn new(pattern: &Arc<Pattern>) -> Self {
        Self { pattern: Arc::clone(pattern), symbolic: OnceLock::new() }
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
        factorize_symbolic_cholesky(self.lower(), Side::Lower, SymmetricOrdering::Amd, params)
            .ok()
            .map(Arc::new)
    }
}

impl Symbolic<f64> for BunchKaufman {
    fn factor(&self, values: &[f64]) -> Result<Box<dyn Factor<f64>>, Breakdown> {
        let symbolic = self.symbolic.get_or_init(|| self.analyse()).clone().ok_or(Breakdown::OutOfMemory)?;
        let n = self.pattern.dim();
        let mut factor = BunchKaufmanFactor {
            values: zeros(symbolic.len_val())?,
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
            SparseColMatRef::new(self.lower(), values),
            Side::Lower,
            PAR,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        Ok(Box::new(factor))
    }
}

struct BunchKaufmanFactor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl Factor<f64> for BunchKaufmanFactor {
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
