//! Complex symmetric: faer's sparse LU.
//!
//! faer's symmetric factorisations are Hermitian for complex numbers, which a dynamic stiffness is not
//! (METHOD: Aᵀ = A); its LU is the one that solves them, at the price of both triangles and of a
//! column ordering.

use super::memory::{FactorMemory, bytes_of, scratch};
use super::ordering::Elimination;
use super::{Breakdown, Factor, Symbolic};
use crate::c64;
use crate::sparse::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use std::sync::{Arc, OnceLock};

/// Parallelism is over frequencies, above this crate: one factorisation runs on one thread.
const PAR: Par = Par::Seq;

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

    fn symbolic(&self) -> Result<Arc<SymbolicLu<usize>>, Breakdown> {
        let analyse = || factorize_symbolic_lu(self.full.symbolic(), Default::default()).ok().map(Arc::new);
        self.symbolic.get_or_init(analyse).clone().ok_or(Breakdown::OutOfMemory)
    }
}

impl Symbolic<c64> for Lu {
    fn factor(&self, values: &[c64]) -> Result<Box<dyn Factor<c64>>, Breakdown> {
        let pattern = self.full.symbolic();
        let symbolic = self.symbolic()?;
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

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        let symbolic = self.symbolic()?;
        let full = &self.full;
        let neighbours = |v: usize| &full.row_idx[full.col_ptr[v]..full.col_ptr[v + 1]];
        let (order, _) = symbolic.col_perm().arrays();
        let without_interchanges = Elimination::new(order.to_vec(), neighbours, |_| 1);
        let factors = bytes_of::<c64>(2 * without_interchanges.entries());
        // Measured on plates, sandwiches and blocks of 1k to 50k dofs: 1.4 to 3 times that is kept (interchanges,
        // zeros in supernodes, vectors that grow by doubling), and 3.5 to 6.6 times is the peak (contributions
        // wait in memory that is not given back).
        Ok(FactorMemory { kept: 3 * factors, scratch: 4 * factors })
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
