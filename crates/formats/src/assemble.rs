//! From entries in the order of a file to a [`CoordinateMatrix`]: fold, sort, merge.

use num_complex::Complex64 as c64;

use crate::{CoordinateMatrix, Entries, Symmetry};

/// The largest number of rows or columns: what a signed 32-bit index counts.
pub(crate) const MAX_ROWS: u64 = i32::MAX as u64;

/// The largest number of entries: what a signed 32-bit pointer counts.
pub(crate) const MAX_ENTRIES: u64 = i32::MAX as u64;

/// A stored value: none (pattern), real or complex.
pub(crate) trait Value: Copy {
    /// How many numbers a file stores for one value.
    const NUMBERS: usize;
    fn from_numbers(numbers: [f64; 2]) -> Self;
    /// Real part and imaginary part; a position of a pattern counts as 1.
    fn parts(self) -> [f64; 2];
    /// Sum of two entries at the same position.
    fn plus(self, other: Self) -> Self;
    fn entries(values: Vec<Self>) -> Entries;
}

impl Value for () {
    const NUMBERS: usize = 0;
    fn from_numbers(_: [f64; 2]) {}
    fn parts(self) -> [f64; 2] {
        [1.0, 0.0]
    }
    fn plus(self, (): Self) {}
    fn entries(_: Vec<Self>) -> Entries {
        Entries::Pattern
    }
}

impl Value for f64 {
    const NUMBERS: usize = 1;
    fn from_numbers([re, _]: [f64; 2]) -> Self {
        re
    }
    fn parts(self) -> [f64; 2] {
        [self, 0.0]
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn entries(values: Vec<Self>) -> Entries {
        Entries::Real(values)
    }
}

impl Value for c64 {
    const NUMBERS: usize = 2;
    fn from_numbers([re, im]: [f64; 2]) -> Self {
        Self::new(re, im)
    }
    fn parts(self) -> [f64; 2] {
        [self.re, self.im]
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn entries(values: Vec<Self>) -> Entries {
        Entries::Complex(values)
    }
}

/// Why the entries of a file do not make a matrix; row and column from 0, in the kept triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Clash {
    pub(crate) row: usize,
    pub(crate) col: usize,
    pub(crate) kind: ClashKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClashKind {
    /// (i, j) and (j, i) are both given where one triangle stands for the other.
    Mirrored,
    /// A position is given twice where each is to be given once.
    Twice,
    /// The sum of entries at one position is beyond the largest double.
    Overflow,
}

/// The treatment of several entries at one position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Duplicates {
    Sum,
    Refuse,
}

/// Entries as they come; `finish` makes the matrix.
///
/// A key is column, row and, in its last bit, whether the entry was mirrored from the upper triangle. Keys
/// of 8 bytes keep the readers within their bound on memory: 16 bytes a byte of input.
pub(crate) struct Assembly<V> {
    symmetry: Symmetry,
    keys: Vec<u64>,
    values: Vec<V>,
}

impl<V: Value> Assembly<V> {
    pub(crate) fn new(symmetry: Symmetry, capacity: usize) -> Self {
        Self { symmetry, keys: Vec::with_capacity(capacity), values: Vec::with_capacity(capacity) }
    }

    /// Adds an entry (row and column from 0, below [`MAX_ROWS`]), mirrored into the lower triangle.
    ///
    /// # Errors
    /// What the symmetry asks of a diagonal entry and what this one is instead.
    pub(crate) fn push(&mut self, row: u64, col: u64, value: V) -> Result<(), (&'static str, String)> {
        let [re, im] = value.parts();
        match self.symmetry {
            Symmetry::SkewSymmetric if row == col && (re, im) == (0.0, 0.0) => return Ok(()),
            Symmetry::SkewSymmetric if row == col => {
                return Err((SKEW_DIAGONAL, format!("{} in row {}", c64::new(re, im), row + 1)));
            }
            Symmetry::Hermitian if row == col && im != 0.0 => {
                return Err((HERMITIAN_DIAGONAL, format!("{} in row {}", c64::new(re, im), row + 1)));
            }
            _ => {}
        }
        let is_mirrored = self.symmetry != Symmetry::General && row < col;
        self.keys.push(if is_mirrored { row << 32 | col << 1 | 1 } else { col << 32 | row << 1 });
        self.values.push(if is_mirrored { mirrored(self.symmetry, value) } else { value });
        Ok(())
    }

    /// Sorts by column, then row, and sums what is at the same position (of a pattern: keeps one).
    pub(crate) fn finish(
        self,
        duplicates: Duplicates,
        nrows: usize,
        ncols: usize,
        title: String,
    ) -> Result<CoordinateMatrix, Clash> {
        let Self { symmetry, mut keys, mut values } = self;
        if !keys.is_sorted_by(|a, b| a >> 1 < b >> 1) {
            let mut pairs: Vec<(u64, V)> = keys.into_iter().zip(values).collect();
            // Stable, so that duplicates are summed in the order of the file.
            pairs.sort_by_key(|pair| pair.0);
            merge(&mut pairs, duplicates)?;
            (keys, values) = pairs.into_iter().unzip();
        }
        Ok(CoordinateMatrix {
            nrows,
            ncols,
            symmetry,
            cols: keys.iter().map(|&key| place(key).1).collect(),
            rows: keys.into_iter().map(|key| place(key).0).collect(),
            entries: V::entries(values),
            title,
        })
    }
}

/// Row and column of a key.
fn place(key: u64) -> (usize, usize) {
    ((key as u32 >> 1) as usize, (key >> 32) as usize)
}

/// Makes one entry of neighbours at the same position; the first that must not be is the error.
fn merge<V: Value>(pairs: &mut Vec<(u64, V)>, duplicates: Duplicates) -> Result<(), Clash> {
    let mut clash = None;
    pairs.dedup_by(|next, kept| {
        let is_same = next.0 >> 1 == kept.0 >> 1;
        if is_same {
            kept.1 = kept.1.plus(next.1);
            let kind = if next.0 != kept.0 {
                Some(ClashKind::Mirrored)
            } else if duplicates == Duplicates::Refuse {
                Some(ClashKind::Twice)
            } else if !kept.1.parts().iter().all(|x| x.is_finite()) {
                Some(ClashKind::Overflow)
            } else {
                None
            };
            let (row, col) = place(kept.0);
            clash = clash.or(kind.map(|kind| Clash { row, col, kind }));
        }
        is_same
    });
    clash.map_or(Ok(()), Err)
}

pub(crate) const SKEW_DIAGONAL: &str = "nothing but zeros on the diagonal of a skew-symmetric matrix";
pub(crate) const HERMITIAN_DIAGONAL: &str = "a real diagonal of a Hermitian matrix";

/// The value of (j, i), given that of (i, j).
fn mirrored<V: Value>(symmetry: Symmetry, value: V) -> V {
    let [re, im] = value.parts();
    V::from_numbers(match symmetry {
        Symmetry::General | Symmetry::Symmetric => [re, im],
        Symmetry::SkewSymmetric => [-re, -im],
        Symmetry::Hermitian => [re, -im],
    })
}
