//! Running the program as a user does.
#![allow(dead_code, reason = "each test file uses its own part")]

use crate::outside;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs `frfit` in a folder.
pub(crate) fn frfit(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_frfit")).args(arguments).current_dir(folder).output().unwrap()
}

/// Runs `frfit`, asserts exit code 0, and returns what it says.
pub(crate) fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = frfit(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs `frfit`, asserts that it blames the input (exit code 2) and says nothing else, and returns the message.
pub(crate) fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = frfit(folder, arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
    assert!(output.stdout.is_empty());
    errors
}

/// A file or folder of the data for tests, wherever the program runs.
pub(crate) fn data(name: &str) -> PathBuf {
    outside::shared(name).canonicalize().unwrap()
}

/// The cells of one column of a table.
pub(crate) fn column(table: &str, name: &str) -> Vec<String> {
    let mut lines = table.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().to_owned()).collect()
}
