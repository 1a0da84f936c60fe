//! What some tests need from outside of the project, for all crates, by path.
//!
//! Such a test is marked `#[ignore = "needs …"]`, and the end of its name says the same to cargo-nextest: `_needs_data`,
//! `_needs_scipy`, `_needs_data_and_lvm_read`. `cargo xtask test` runs it where all that is there. A test that runs
//! without what it needs fails.
#![allow(dead_code, reason = "each crate uses a part")]

use std::path::PathBuf;
use std::process::Command;

/// A file or folder of the data for tests.
///
/// # Panics
///
/// Where there is none.
pub(crate) fn shared(name: &str) -> PathBuf {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let path = PathBuf::from(std::env::var("FRFIT_DATA").unwrap_or_else(|_| beside.into())).join(name);
    assert!(path.exists(), "this test needs {} (FRFIT_DATA names another folder)", path.display());
    path
}

/// A Python that has these modules, as `import` lists them.
///
/// # Panics
///
/// Where there is none.
pub(crate) fn python_with(modules: &str) -> String {
    let python = std::env::var("FRFIT_PYTHON").unwrap_or_else(|_| "python3".into());
    let output = Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    let output = output.unwrap_or_else(|error| panic!("{python}: {error} (FRFIT_PYTHON names another one)"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{python} lacks {modules} (FRFIT_PYTHON names another one): {errors}");
    python
}
