//! The files of an example, as bytes.

mod frf;
mod matrix;
mod table;

pub(crate) use frf::{Frf, csv_frf, uff_frfs};
pub use matrix::matrix;
pub(crate) use table::{dofs, force, several_truth, truth};

/// A file of an example.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Path relative to the example's folder.
    pub path: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl File {
    pub(crate) fn new(path: &str, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.to_owned(), bytes: bytes.into() }
    }
}
