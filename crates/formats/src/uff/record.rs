//! What a dataset holds, by its number.

use std::ops::Range;

use crate::FormatError;

use super::file::File;
use super::file_header::FileHeader;
use super::function::Function;
use super::nodes::Node;
use super::trace_line::TraceLine;
use super::units::Units;

/// The content of one dataset.
#[derive(Debug, Clone, PartialEq)]
pub enum Record {
    /// 58 or 58b.
    Function(Box<Function>),
    /// 15 or 2411.
    Nodes(Vec<Node>),
    /// 82.
    TraceLine(Box<TraceLine>),
    /// 151.
    FileHeader(Box<FileHeader>),
    /// 164.
    Units(Box<Units>),
    /// Any other number: where it is, delimiter lines included.
    Other {
        /// Dataset number.
        dataset: u32,
        /// Its bytes in the file.
        bytes: Range<usize>,
    },
}

/// Reads every dataset of a file, data included. Memory is at most 16 times the file.
///
/// # Errors
///
/// As [`scan`](super::scan), or a dataset of a known number holds something else than its format says.
pub fn read_all(bytes: &[u8]) -> Result<Vec<Record>, FormatError> {
    let file = File::new(bytes)?;
    (0..file.entries().len()).map(|index| file.record(index)).collect()
}
