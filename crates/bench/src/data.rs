//! Data that are not part of the project.

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
