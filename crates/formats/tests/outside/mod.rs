//! What tests find outside of the project, or say that they do not: for all crates, by path.
#![allow(dead_code, clippy::print_stdout, reason = "each test uses a part; one that is skipped says so")]

use std::path::PathBuf;
use std::process::Command;

/// A file or folder of the data for tests; `None` and a word where there is none.
pub(crate) fn shared(name: &str) -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let path = PathBuf::from(std::env::var("FRFIT_DATA").unwrap_or_else(|_| beside.into())).join(name);
    if !path.exists() {
        println!("skipped: no {} (set FRFIT_DATA)", path.display());
        return None;
    }
    Some(path)
}

/// A Python that has a module; `None` and a word where there is none.
pub(crate) fn python_with(module: &str) -> Option<String> {
    let python = std::env::var("FRFIT_PYTHON").unwrap_or_else(|_| "python3".into());
    let found = Command::new(&python).args(["-c", &format!("import {module}")]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        println!("skipped: {python} has no {module} (set FRFIT_PYTHON to one that has)");
        return None;
    }
    Some(python)
}
