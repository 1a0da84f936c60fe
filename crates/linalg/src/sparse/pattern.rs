//! Where the entries of a symmetric matrix are.

use std::sync::Arc;

/// Positions of the lower triangle (row ≥ column) of a symmetric n × n matrix, by columns, rows ascending.
///
/// Every diagonal position is present, stored value or not: a dynamic stiffness adds terms with
/// different patterns, and factorisations want the diagonal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    dim: usize,
    col_ptr: Vec<usize>,
    row_idx: Vec<usize>,
}

impl Pattern {
    /// The pattern of all given positions, of their mirror images, and of the diagonal.
    ///
    /// # Panics
    /// Where a position is outside n × n: callers read files through `frfit-formats`, which checks.
    pub fn new(dim: usize, positions: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut lower: Vec<(usize, usize)> = (0..dim).map(|i| (i, i)).collect();
        lower.extend(positions.into_iter().map(|(row, col)| {
            assert!(row < dim && col < dim, "position ({row}, {col}) outside {dim} x {dim}");
            (row.max(col), row.min(col))
        }));
        let mut next = vec![0; dim + 1];
        lower.iter().for_each(|&(_, col)| next[col + 1] += 1);
        (0..dim).for_each(|col| next[col + 1] += next[col]);
        let mut rows = vec![0; lower.len()];
        for (row, col) in lower {
            rows[next[col]] = row;
            next[col] += 1;
        }
        // `next` has moved from the first to the end of each column.
        let mut start = 0;
        let columns = (0..dim).map(|col| rows[std::mem::replace(&mut start, next[col])..next[col]].to_vec());
        Self::from_columns(dim, columns)
    }

    /// From the rows of each column in any order, repeated or not.
    fn from_columns(dim: usize, columns: impl Iterator<Item = Vec<usize>>) -> Self {
        let (mut col_ptr, mut row_idx) = (vec![0], Vec::new());
        for mut column in columns {
            column.sort_unstable();
            column.dedup();
            row_idx.extend(column);
            col_ptr.push(row_idx.len());
        }
        row_idx.shrink_to_fit();
        Self { dim, col_ptr, row_idx }
    }

    /// The union of patterns of one dimension; the same `Arc` where they are all equal.
    ///
    /// # Panics
    /// Where the dimensions differ, or there is no pattern.
    pub fn union(patterns: &[&Arc<Pattern>]) -> Arc<Pattern> {
        let first = patterns[0];
        if patterns.iter().all(|pattern| Arc::ptr_eq(pattern, first) || pattern == &first) {
            return Arc::clone(first);
        }
        assert!(patterns.iter().all(|pattern| pattern.dim == first.dim), "patterns of one dimension");
        let columns = (0..first.dim)
            .map(|col| patterns.iter().flat_map(|pattern| pattern.column(col)).copied().collect());
        Arc::new(Pattern::from_columns(first.dim, columns))
    }

    /// Number of rows and columns n.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of positions in the lower triangle, diagonal included.
    pub fn stored(&self) -> usize {
        self.row_idx.len()
    }

    /// Number of positions in the full matrix: 2 × lower − n.
    pub fn nonzeros(&self) -> usize {
        2 * self.row_idx.len() - self.dim
    }

    /// First position of each column, and the end: n + 1 numbers.
    pub fn col_ptr(&self) -> &[usize] {
        &self.col_ptr
    }

    /// Row of each position.
    pub fn row_idx(&self) -> &[usize] {
        &self.row_idx
    }

    /// All positions (row, column) in storage order, row ≥ column.
    pub fn positions(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.dim).flat_map(move |col| self.column(col).iter().map(move |&row| (row, col)))
    }

    /// The rows of one column.
    pub fn column(&self, col: usize) -> &[usize] {
        &self.row_idx[self.col_ptr[col]..self.col_ptr[col + 1]]
    }

    /// Storage index of (row, column) or its mirror image, if that position exists.
    pub fn find(&self, row: usize, col: usize) -> Option<usize> {
        let (row, col) = (row.max(col), row.min(col));
        let start = self.col_ptr[col];
        self.column(col).binary_search(&row).ok().map(|offset| start + offset)
    }
}
