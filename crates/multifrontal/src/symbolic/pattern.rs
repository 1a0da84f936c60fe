//! Where the entries of a lower triangle are.

use std::fmt;

/// Positions of a lower triangle by columns.
#[derive(Debug, Clone)]
pub(crate) struct Lower {
    pub(crate) dim: usize,
    pub(crate) col_ptr: Vec<usize>,
    pub(crate) row_idx: Vec<u32>,
}

/// What is wrong with a pattern or a permutation.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum PatternError {
    /// `col_ptr` must have n + 1 entries that begin with 0, do not descend, and end with the number of rows given.
    Columns,
    /// A row above the diagonal or outside the matrix.
    Row {
        /// Its column.
        col: usize,
        /// The row.
        row: usize,
    },
    /// An entry that comes twice.
    Repeated {
        /// Its column.
        col: usize,
        /// Its row.
        row: usize,
    },
    /// An order that is no permutation of the rows: the first row that is missing, repeated or outside.
    Permutation(usize),
    /// More than 2³² − 1 rows or entries.
    TooLarge,
}

impl fmt::Display for PatternError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Columns => {
                write!(
                    f,
                    "column pointers: expected n + 1 of them, from 0, ascending, to the number of entries"
                )
            }
            Self::Row { col, row } => {
                write!(f, "column {col}: expected rows of the lower triangle, found row {row}")
            }
            Self::Repeated { col, row } => {
                write!(f, "column {col}: expected each row once, found row {row} again")
            }
            Self::Permutation(row) => {
                write!(f, "order: expected every row once, found otherwise for row {row}")
            }
            Self::TooLarge => write!(f, "expected less than 2^32 - 1 rows and entries"),
        }
    }
}

impl std::error::Error for PatternError {}

impl Lower {
    pub(crate) fn new(dim: usize, col_ptr: &[usize], row_idx: &[usize]) -> Result<Self, PatternError> {
        if dim >= u32::MAX as usize || row_idx.len() >= u32::MAX as usize {
            return Err(PatternError::TooLarge);
        }
        let ends = col_ptr.first() == Some(&0) && col_ptr.last() == Some(&row_idx.len());
        if col_ptr.len() != dim + 1 || !ends || !col_ptr.is_sorted() {
            return Err(PatternError::Columns);
        }
        // The last column that had each row.
        let mut seen = vec![usize::MAX; dim];
        for col in 0..dim {
            for &row in &row_idx[col_ptr[col]..col_ptr[col + 1]] {
                if row < col || row >= dim {
                    return Err(PatternError::Row { col, row });
                }
                if std::mem::replace(&mut seen[row], col) == col {
                    return Err(PatternError::Repeated { col, row });
                }
            }
        }
        // Checked above: every row fits.
        let row_idx = row_idx.iter().map(|&row| row as u32).collect();
        Ok(Self { dim, col_ptr: col_ptr.to_vec(), row_idx })
    }

    pub(crate) fn column(&self, col: usize) -> &[u32] {
        &self.row_idx[self.col_ptr[col]..self.col_ptr[col + 1]]
    }

    /// (row, column) of every entry, as stored.
    pub(crate) fn positions(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.dim).flat_map(|col| self.column(col).iter().map(move |&row| (row as usize, col)))
    }
}

pub(super) fn check_permutation(dim: usize, order: &[usize]) -> Result<(), PatternError> {
    let mut seen = vec![false; dim];
    for &row in order {
        if row >= dim || std::mem::replace(&mut seen[row], true) {
            return Err(PatternError::Permutation(row));
        }
    }
    seen.iter().position(|seen| !seen).map_or(Ok(()), |row| Err(PatternError::Permutation(row)))
}
