//! Nested dissection, and what an order costs: the operations by which all solvers are rated.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use feral_scotch::{CscPattern, ScotchOptions, scotch_order_full};
use frfit_linalg::sparse::Pattern;

const NONE: usize = usize::MAX;

/// Both triangles by columns, rows ascending, and for each position the place of its value in the lower triangle.
pub struct Full {
    /// First position of each column, and the end.
    pub col_ptr: Vec<usize>,
    /// Row of each position.
    pub row_idx: Vec<usize>,
    /// Place in the lower triangle.
    pub source: Vec<usize>,
}

impl Full {
    /// Both triangles of a pattern.
    pub fn new(pattern: &Pattern) -> Self {
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
        // By ascending columns a column's upper triangle comes first, in ascending rows.
        for (k, (row, col)) in pattern.positions().enumerate() {
            place(row, col, k);
            if row != col {
                place(col, row, k);
            }
        }
        Self { col_ptr, row_idx, source }
    }

    /// As faer wants it.
    pub fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.col_ptr.len() - 1;
        SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx)
    }

    /// Elimination tree and entries of each column of L (diagonal included) for an order.
    ///
    /// # Source
    /// J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134–172.
    fn eliminate(&self, order: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let n = order.len();
        let mut position = vec![0; n];
        order.iter().enumerate().for_each(|(k, &row)| position[row] = k);
        let (mut parent, mut count, mut reached) = (vec![NONE; n], vec![1; n], vec![NONE; n]);
        for k in 0..n {
            reached[k] = k;
            for &neighbour in &self.row_idx[self.col_ptr[order[k]]..self.col_ptr[order[k] + 1]] {
                let mut at = position[neighbour];
                while at < k && reached[at] != k {
                    reached[at] = k;
                    count[at] += 1;
                    if parent[at] == NONE {
                        parent[at] = k;
                    }
                    at = parent[at];
                }
            }
        }
        (parent, count)
    }

    /// Operations in real numbers and entries of L for an order: Σ c² and Σ c over the columns.
    pub fn cost(&self, order: &[usize]) -> (f64, f64) {
        let (_, count) = self.eliminate(order);
        let sum = |power| count.iter().map(|&c| (c as f64).powi(power)).sum();
        (sum(2), sum(1))
    }

    /// The same elimination with every subtree in one piece: only then are supernodes runs of columns.
    fn postorder(&self, order: &[usize]) -> Vec<usize> {
        let (parent, count) = self.eliminate(order);
        let n = order.len();
        let mut children = vec![Vec::new(); n + 1];
        (0..n).for_each(|k| children[parent[k].min(n)].push(k));
        // The child with most rows last, next to its parent; taken from the back, so it is visited first and written first
        // in the reversed order.
        children.iter_mut().for_each(|list| list.sort_by_key(|&k| count[k]));
        let (mut reversed, mut open) = (Vec::with_capacity(n), std::mem::take(&mut children[n]));
        while let Some(k) = open.pop() {
            reversed.push(order[k]);
            open.append(&mut children[k]);
        }
        reversed.reverse();
        reversed
    }

    /// Nested dissection by feral-scotch, which compresses the dofs of a node by itself; postordered.
    ///
    /// # Errors
    /// Where there are more than 2³¹ entries or the crate refuses.
    pub fn dissection(&self) -> Result<Vec<usize>, String> {
        let narrow = |of: &[usize]| of.iter().map(|&k| i32::try_from(k)).collect::<Result<Vec<_>, _>>();
        let columns = narrow(&self.col_ptr).map_err(|error| error.to_string())?;
        let rows = narrow(&self.row_idx).map_err(|error| error.to_string())?;
        let pattern =
            CscPattern::new(self.col_ptr.len() - 1, &columns, &rows).ok_or("no pattern for feral")?;
        let (order, ..) =
            scotch_order_full(&pattern, &ScotchOptions::default()).map_err(|error| format!("{error:?}"))?;
        let order: Vec<usize> = order.into_iter().map(|row| row as usize).collect();
        Ok(self.postorder(&order))
    }

    /// Minimum degree by faer, postordered.
    ///
    /// # Errors
    /// Where faer refuses.
    pub fn minimum_degree(&self) -> Result<Vec<usize>, String> {
        let n = self.col_ptr.len() - 1;
        let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
        let mut buffer = MemBuffer::new(amd::order_scratch::<usize>(n, self.row_idx.len()));
        amd::order(&mut order, &mut inverse, self.symbolic(), Default::default(), MemStack::new(&mut buffer))
            .map_err(|error| format!("{error:?}"))?;
        Ok(self.postorder(&order))
    }
}
