//! What the header of a matrix says, in text and binary alike.

use crate::assemble::{Duplicates, Value};
use crate::gather::{Gather, declared_symmetric};
use crate::{CoordinateMatrix, FormatError, NamedMatrix};

/// From this number of rows on sparse columns are in BIGMAT strings, whatever the sign of the number.
const BIGMAT_ROWS: u64 = 65_536;

/// The header of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) ncols: u64,
    pub(super) nrows: u64,
    /// Sparse columns have their strings' length and row in two numbers.
    pub(super) is_bigmat: bool,
    form: i64,
    kind: i64,
    pub(super) name: String,
}

impl Header {
    /// Columns, rows (negative with BIGMAT), form and type; `None` where it cannot be a header.
    pub(super) fn new([ncols, nrows, form, kind]: [i64; 4], name: &[u8]) -> Option<Self> {
        let name: Vec<u8> = name.iter().filter(|byte| !b" \0".contains(byte)).copied().collect();
        let is_header = ncols >= 0 && (1..=4).contains(&kind) && (0..=20).contains(&form);
        let rows = nrows.unsigned_abs();
        is_header.then(|| Self {
            ncols: ncols.unsigned_abs(),
            nrows: rows,
            is_bigmat: nrows < 0 || rows >= BIGMAT_ROWS,
            form,
            kind,
            name: String::from_utf8_lossy(&name).into_owned(),
        })
    }

    pub(super) fn is_complex(&self) -> bool {
        self.kind > 2
    }

    pub(super) fn is_double(&self) -> bool {
        self.kind % 2 == 0
    }

    /// The matrix that the columns have given.
    pub(super) fn named<V: Value>(&self, gather: Gather<V>) -> NamedMatrix {
        let refused = FormatError::whole("a matrix that stores its entries", "form 8, an identity");
        let symmetric = |matrix: CoordinateMatrix| match self.form {
            6 => declared_symmetric(matrix),
            _ => matrix,
        };
        let matrix = match self.form {
            8 => Err(refused),
            _ => gather.finish(Duplicates::Refuse, &self.name).map(symmetric),
        };
        NamedMatrix::plain(self.name.as_str(), matrix)
    }
}

/// A string of a sparse column: the words of its numbers, and its first row from 1.
pub(super) struct StringHead {
    pub(super) words: u64,
    pub(super) row: i64,
    /// Words that the head itself takes.
    pub(super) own: u64,
}

impl StringHead {
    /// Of BIGMAT: L + 1 and the row.
    pub(super) fn of_two(length: i64, row: i64) -> Option<Self> {
        Some(Self { words: u64::try_from(length).ok()?.checked_sub(1)?, row, own: 2 })
    }

    /// Otherwise: row + 65536 (L + 1).
    pub(super) fn of_one(packed: i64) -> Option<Self> {
        Some(Self { words: u64::try_from(packed >> 16).ok()?.checked_sub(1)?, row: packed & 0xFFFF, own: 1 })
    }

    /// Its first row, from 1.
    pub(super) fn row(&self) -> Option<u64> {
        u64::try_from(self.row).ok().filter(|row| *row > 0)
    }

    /// Words of the column that are left behind it; `None` where there were fewer than it takes.
    pub(super) fn leaves(&self, left: u64) -> Option<u64> {
        left.checked_sub(self.words.checked_add(self.own)?)
    }
}

/// What a row has to be.
pub(super) const ROW: &str = "a row from 1";
/// What a string's head has to be.
pub(super) const HEAD: &str = "the length of a string (at least 1) and its row";
