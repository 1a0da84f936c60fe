//! A file of a result, before it is written.

use std::path::PathBuf;

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Path relative to the output folder.
    pub path: PathBuf,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file at a relative path.
    pub fn new(path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.into(), bytes: bytes.into() }
    }
}
