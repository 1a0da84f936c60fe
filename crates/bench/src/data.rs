//! Data that are not part of the project.

use frfit_linalg::sparse::SymmetricMatrix;
use frfit_workflow::load::symmetric_matrix;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// The folder of the data: `FRFIT_DATA`, or the one beside the project.
pub fn data() -> PathBuf {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    std::env::var_os("FRFIT_DATA").map_or_else(|| PathBuf::from(beside), PathBuf::from)
}

/// What is said where data are absent.
pub fn absent(path: &Path) -> String {
    format!("no {} (set FRFIT_DATA)", path.display())
}

/// A symmetric matrix of a file.
///
/// # Errors
/// What is wrong with it, with its path.
pub fn matrix(path: &Path) -> Result<SymmetricMatrix, String> {
    let refused = |error: &dyn Display| format!("{}: {error}", path.display());
    let bytes = std::fs::read(path).map_err(|error| refused(&error))?;
    let matrix = frfit_formats::read_matrix(&bytes).map_err(|error| refused(&error))?;
    symmetric_matrix(&matrix).map_err(|error| refused(&error))
}
