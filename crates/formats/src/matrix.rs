//! The contents of a matrix file, before anybody decides how to use them.

use num_complex::Complex64 as c64;

use crate::FormatError;
use crate::assemble::{Assembly, Duplicates, HERMITIAN_DIAGONAL, MAX_ROWS, SKEW_DIAGONAL, Value};
use crate::text::FINITE;

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

impl CoordinateMatrix {
    /// Checks what the fields promise: equal lengths, positions inside the matrix, sorted and once each,
    /// in the kept triangle, values finite. The readers give only such matrices; the writers ask for it.
    ///
    /// # Errors
    /// The first promise that is broken, and at which entry.
    pub fn validate(&self) -> Result<(), FormatError> {
        let broken = |expected: &str, found: String| Err(FormatError::whole(expected, found));
        let (count, values) = (self.rows.len(), self.entries.len().unwrap_or(self.rows.len()));
        if self.cols.len() != count || values != count {
            let found = format!("{count} rows, {} columns, {values} values", self.cols.len());
            return broken("as many rows as columns as values", found);
        }
        let one_triangle = self.symmetry != Symmetry::General;
        if one_triangle && self.nrows != self.ncols {
            return broken(SQUARE, format!("{} rows and {} columns", self.nrows, self.ncols));
        }
        let mut last = None;
        for (k, (&row, &col)) in self.rows.iter().zip(&self.cols).enumerate() {
            let here = || format!("row {}, column {}", row + 1, col + 1);
            if row >= self.nrows || col >= self.ncols {
                return broken(&format!("a position in {} by {}", self.nrows, self.ncols), here());
            }
            if one_triangle && row < col {
                return broken("entries of the lower triangle", here());
            }
            if last.replace((col, row)) >= Some((col, row)) {
                return broken("entries sorted by column, then row, each once", here());
            }
            let value = self.entries.get(k);
            if !value.is_finite() {
                return broken(FINITE, format!("{value} at {}", here()));
            }
            if row == col && self.symmetry == Symmetry::SkewSymmetric {
                return broken(SKEW_DIAGONAL, format!("{value} at {}", here()));
            }
            if row == col && self.symmetry == Symmetry::Hermitian && value.im != 0.0 {
                return broken(HERMITIAN_DIAGONAL, format!("{value} at {}", here()));
            }
        }
        Ok(())
    }
}

impl CoordinateMatrix {
    /// The square matrix of `size` rows whose row and column `to[k]` are this one's k-th; where `to[k]` is `None`, they
    /// are left out. All other entries are zero.
    ///
    /// # Errors
    /// A matrix that is not square, or breaks [`CoordinateMatrix::validate`]; not a place for each row; a place beyond
    /// `size`, or two rows with one place.
    pub fn renumbered(&self, to: &[Option<usize>], size: usize) -> Result<Self, FormatError> {
        self.validate()?;
        if self.nrows != self.ncols || to.len() != self.nrows {
            let expected = format!("a square matrix of {} rows, a place for each", to.len());
            return Err(FormatError::whole(expected, format!("{} by {}", self.nrows, self.ncols)));
        }
        if size as u64 > MAX_ROWS {
            return Err(FormatError::whole(format!("a size up to {MAX_ROWS}"), size.to_string()));
        }
        let mut places: Vec<usize> = to.iter().flatten().copied().collect();
        places.sort_unstable();
        if places.last().is_some_and(|&last| last >= size) || places.windows(2).any(|pair| pair[0] == pair[1])
        {
            return Err(FormatError::whole(format!("places below {size}, each once"), "others"));
        }
        match &self.entries {
            Entries::Pattern => self.moved(to, size, |_| ()),
            Entries::Real(values) => self.moved(to, size, |k| values[k]),
            Entries::Complex(values) => self.moved(to, size, |k| values[k]),
        }
    }

    fn moved<V: Value>(
        &self,
        to: &[Option<usize>],
        size: usize,
        value: impl Fn(usize) -> V,
    ) -> Result<Self, FormatError> {
        let mut assembly = Assembly::new(self.symmetry, self.rows.len());
        for (k, (&row, &col)) in self.rows.iter().zip(&self.cols).enumerate() {
            if let (Some(row), Some(col)) = (to[row], to[col]) {
                let pushed = assembly.push(row as u64, col as u64, value(k));
                pushed.map_err(|(expected, found)| FormatError::whole(expected, found))?;
            }
        }
        // The positions were distinct, and in one triangle: they still are.
        let twice = |_| FormatError::whole("each position once", "one twice");
        assembly.finish(Duplicates::Refuse, size, size, self.title.clone()).map_err(twice)
    }
}

/// What every symmetry asks of the shape, in the words of an error.
pub(crate) const SQUARE: &str = "as many rows as columns in a matrix given by one triangle";

impl Entries {
    /// Number of values; `None` of a pattern.
    fn len(&self) -> Option<usize> {
        match self {
            Self::Pattern => None,
            Self::Real(values) => Some(values.len()),
            Self::Complex(values) => Some(values.len()),
        }
    }

    /// The k-th value as a complex number; 1 for a position of a pattern.
    ///
    /// # Panics
    /// Where there is no k-th value.
    fn get(&self, k: usize) -> c64 {
        match self {
            Self::Pattern => c64::new(1.0, 0.0),
            Self::Real(values) => c64::new(values[k], 0.0),
            Self::Complex(values) => values[k],
        }
    }
}
