//! What a matrix file says, before anybody decides what to do with it.

use num_complex::Complex64 as c64;

/// What the file declares about A and its transpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symmetry {
    /// Nothing: every entry is stored.
    General,
    /// Aᵀ = A: one triangle is stored.
    Symmetric,
    /// Aᵀ = −A: one triangle without the diagonal is stored.
    SkewSymmetric,
    /// Aᴴ = A: one triangle is stored.
    Hermitian,
}

/// The stored values, in the order of [`CoordinateMatrix::rows`].
#[derive(Debug, Clone, PartialEq)]
pub enum Entries {
    /// Positions without values: read them as 1 where a number is needed.
    Pattern,
    /// Real (or integer) values.
    Real(Vec<f64>),
    /// Complex values.
    Complex(Vec<c64>),
}

/// A sparse matrix as positions and values; each stored position occurs once, sorted by column, then row.
///
/// Of a symmetric, skew-symmetric or Hermitian matrix the lower triangle is kept (row ≥ column).
#[derive(Debug, Clone, PartialEq)]
pub struct CoordinateMatrix {
    /// Number of rows.
    pub nrows: usize,
    /// Number of columns.
    pub ncols: usize,
    /// What the file declares about the other triangle.
    pub symmetry: Symmetry,
    /// Row of each stored entry, from 0.
    pub rows: Vec<usize>,
    /// Column of each stored entry, from 0.
    pub cols: Vec<usize>,
    /// Value of each stored entry.
    pub entries: Entries,
    /// What the file says about itself: title, key, comment lines.
    pub title: String,
}
