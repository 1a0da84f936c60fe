//! What a dataset holds, by its number.

use std::ops::Range;

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
