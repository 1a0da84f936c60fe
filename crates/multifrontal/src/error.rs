//! Why a matrix could not be factorised, or a system not be solved.

use std::fmt;

/// Why a matrix could not be factorised, or a system not be solved; rows are those of the matrix as given.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum FactorError {
    /// Not one value for each entry of the pattern.
    Values {
        /// Entries of the pattern.
        expected: usize,
        /// Values given.
        found: usize,
    },
    /// An entry is infinite or not a number.
    NotFinite {
        /// Its row.
        row: usize,
        /// Its column.
        col: usize,
    },
    /// Nothing was left of some rows when everything else had been eliminated.
    Singular {
        /// One of them.
        row: usize,
        /// How many there are.
        deficiency: usize,
    },
    /// A right-hand side has no solution of finite numbers: it has none itself, or the matrix is singular but
    /// for roundoff.
    NoSolution {
        /// Which of the right-hand sides.
        column: usize,
    },
    /// The factor does not fit into memory.
    OutOfMemory,
}

impl fmt::Display for FactorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Values { expected, found } => write!(f, "expected {expected} values, found {found}"),
            Self::NotFinite { row, col } => write!(f, "entry ({row}, {col}) is infinite or not a number"),
            Self::Singular { row, deficiency } => {
                write!(f, "the matrix is singular: {deficiency} of its rows vanish, row {row} among them")
            }
            Self::NoSolution { column } => write!(f, "right-hand side {column} has no finite solution"),
            Self::OutOfMemory => write!(f, "the factor does not fit into memory"),
        }
    }
}

impl std::error::Error for FactorError {}
