//! The place of one dataset in a file, and its number.

use std::ops::Range;

use memchr::memchr_iter;

use super::lines::Lines;

/// One dataset of a file: its number and where it is. Nothing inside it has been read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Dataset number.
    pub dataset: u32,
    /// Line of the opening `-1`, from 1; bytes that end a line count inside binary data too.
    pub line: usize,
    /// Bytes of the dataset, both delimiter lines included.
    pub bytes: Range<usize>,
    /// Bytes between the line with the number and the closing delimiter.
    pub(super) body: Range<usize>,
    /// What the line with the number says about binary data.
    pub(super) binary: Option<BinaryForm>,
}

/// How the numbers of a 58b are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BinaryForm {
    /// 1: little endian, 2: big endian.
    pub(super) byte_order: u8,
    /// 1: VAX, 2: IEEE 754, 3: IBM/370.
    pub(super) float_format: u8,
}

impl Entry {
    /// Whether the data of this dataset are binary (58b).
    #[must_use]
    pub fn is_binary(&self) -> bool {
        self.binary.is_some()
    }

    /// The lines of the body in the file it was found in.
    pub(super) fn lines<'a>(&self, file: &'a [u8]) -> Lines<'a> {
        let title = file.get(self.bytes.start..self.body.start).unwrap_or_default();
        let body = file.get(self.body.clone()).unwrap_or_default();
        Lines::new(body, self.line + memchr_iter(b'\n', title).count())
    }
}
