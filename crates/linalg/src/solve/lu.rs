//! Complex symmetric, and real symmetric with constraints: faer's sparse LU.
//!
//! faer's symmetric factorisations are Hermitian for complex numbers, which a dynamic stiffness is not
//! (METHOD: Aᵀ = A); its LU is the one that solves them, at the price of both triangles and of a
//! column ordering.

use super::memory::{FactorMemory, bytes_of, scratch};
use super::ordering::Elimination;
use super::{Breakdown, Factor, PAR, Symbolic};
use crate::Scalar;
use crate::sparse::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut};
use std::sync::{Arc, OnceLock};

/// LU of both triangles, threshold partial pivoting, COLAMD ordering; analysed when first needed.
pub(super) struct Lu {
    pattern: Arc<Pattern>,
    analysed: OnceLock<Option<Arc<Analysed>>>,
}

struct Analysed {
    full: FullPattern,
    symbolic: SymbolicLu<usize>,
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
        let mut col_ptr = vec![0; dim + 1];
        for (row, col) in pattern.positions() {
            col_ptr[col + 1] += 1;
            col_ptr[row + 1] += usize::from(row != col);
        }
        (0..dim).for_each(|col| col_ptr[col + 1] += col_ptr[col]);
        let mut next = col_ptr.clone();
        let (mut row_idx, mut source) = (vec![0; col_ptr[dim]], vec![0; col_ptr[dim]]);
        let mut place = |row, col: usize, k| {
            (row_idx[next[col]], source[next[col]]) = (row, k);
            next[col] += 1;
        };
        // Ascending columns, so that each column of the upper triangle comes out with ascending rows,
        // and before the lower triangle of that column.
        for (k, (row, col)) in pattern.positions().enumerate() {
            place(row, col, k);
            if row != col {
                place(col, row, k);
            }
        }
        Self { dim, col_ptr, row_idx, source }
    }

    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.dim, self.dim, &self.col_ptr, None, &self.row_idx)
    }

    fn column(&self, col: usize) -> &[usize] {
        &self.row_idx[self.col_ptr[col]..self.col_ptr[col + 1]]
    }
}

impl Lu {
    pub(super) fn new(pattern: &Arc<Pattern>) -> Self {
        Self { pattern: Arc::clone(pattern), analysed: OnceLock::new() }
    }

    fn analysed(&self) -> Result<Arc<Analysed>, Breakdown> {
        let analyse = || {
            let full = FullPattern::new(&self.pattern);
            let symbolic = factorize_symbolic_lu(full.symbolic(), Default::default()).ok()?;
            Some(Arc::new(Analysed { full, symbolic }))
        };
        self.analysed.get_or_init(analyse).clone().ok_or(Breakdown::OutOfMemory)
    }
}

impl<T: Scalar> Symbolic<T> for Lu {
    fn factor(&self, values: &[T]) -> Result<Box<dyn Factor<T>>, Breakdown> {
        let analysed = self.analysed()?;
        let Analysed { full, symbolic } = analysed.as_ref();
        let values: Vec<T> = full.source.iter().map(|&k| values[k]).collect();
        let mut numeric = NumericLu::new();
        let mut buffer = scratch(symbolic.factorize_numeric_lu_scratch::<T>(PAR, Default::default()))?;
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                SparseColMatRef::new(full.symbolic(), &values),
                PAR,
                MemStack::new(&mut buffer),
                Default::default(),
            )
            .map_err(|error| match error {
                LuError::SymbolicSingular { .. } => Breakdown::Singular { condition_at_least: f64::INFINITY },
                LuError::Generic(_) => Breakdown::OutOfMemory,
            })?;
        Ok(Box::new(LuFactor { analysed, numeric }))
    }

    fn memory(&self) -> Result<FactorMemory, Breakdown> {
        let analysed = self.analysed()?;
        let (order, _) = analysed.symbolic.col_perm().arrays();
        let without_interchanges = Elimination::new(order.to_vec(), |row| analysed.full.column(row), |_| 1);
        let factors = bytes_of::<T>(2 * without_interchanges.entries());
        // Measured on plates, sandwiches and blocks of 1k to 50k dofs: 1.4 to 3.1 times that is kept (interchanges,
        // zeros in supernodes, vectors that grow by doubling), and 3.5 to 6.6 times is the peak (contributions
        // wait in memory that is not given back).
        Ok(FactorMemory { kept: 3 * factors, scratch: 4 * factors })
    }
}

struct LuFactor<T> {
    analysed: Arc<Analysed>,
    numeric: NumericLu<usize, T>,
}

impl<T: Scalar> Factor<T> for LuFactor<T> {
    fn solve_in_place(&self, rhs: &mut [T]) {
        let symbolic = &self.analysed.symbolic;
        let n = symbolic.nrows();
        let columns = rhs.len() / n;
        let mut buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<T>(columns, PAR));
        let factor = LuRef::new_unchecked(symbolic, &self.numeric);
        factor.solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, columns),
            PAR,
            MemStack::new(&mut buffer),
        );
    }
}
