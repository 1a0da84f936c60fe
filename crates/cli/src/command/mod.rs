//! One file a command.

pub(crate) mod batch;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod example;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod frf;
pub(crate) mod identify;
pub(crate) mod inspect;
pub(crate) mod man;
pub(crate) mod modes;
pub(crate) mod report;
pub(crate) mod respond;
pub(crate) mod sensitivities;
pub(crate) mod train;

use crate::args::Args;
use crate::outcome::Failure;
use frfit_workflow::output::{Words, is_standard_output};
use frfit_workflow::terminal::{printable, printable_json};
use serde_json::Value;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Says lines on standard output, without what would steer a terminal.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    put(std::io::stdout().lock(), "standard output", &printable(text))
}

/// Says what came out; with `--quiet` only warnings and findings.
pub(crate) fn say_words(args: &Args, words: &Words) -> Result<(), Failure> {
    say(if args.quiet { &words.warnings } else { &words.all })
}

/// The same of what is written to `out`: on standard error where the result takes standard output.
pub(crate) fn say_beside(args: &Args, out: &Path, words: &Words) -> Result<(), Failure> {
    match is_standard_output(out) {
        true => {
            let text = if args.quiet { &words.warnings } else { &words.all };
            put(std::io::stderr().lock(), "standard error", &printable(text))
        }
        false => say_words(args, words),
    }
}

/// Says JSON on standard output, over several lines.
pub(crate) fn say_json(value: &Value) -> Result<(), Failure> {
    put(std::io::stdout().lock(), "standard output", &printable_json(&format!("{value:#}\n")))
}

/// Says JSON on one line of standard output.
pub(crate) fn say_json_line(value: &Value) -> Result<(), Failure> {
    put(std::io::stdout().lock(), "standard output", &printable_json(&format!("{value}\n")))
}

/// Refuses `--json` where the result takes standard output.
pub(crate) fn one_on_standard_output(args: &Args, out: &Path) -> Result<(), Failure> {
    match args.json && is_standard_output(out) {
        true => {
            let found = "standard output for both";
            Err(Failure::Input(format!("--json: expected a file for what is written, found {found}")))
        }
        false => Ok(()),
    }
}

/// A reader that has gone away is no failure.
fn put(mut to: impl Write, name: &str, text: &str) -> Result<(), Failure> {
    match to.write_all(text.as_bytes()).and_then(|()| to.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Input(format!("{name}: expected to write here, found: {error}")))
        }
        _ => Ok(()),
    }
}

/// The folder of results that was asked for, or one beside the case: `case-results` for `case.toml`.
pub(crate) fn folder_for(out: Option<&Path>, case: &Path, what: &str) -> PathBuf {
    let stem = || case.file_stem().unwrap_or_default().to_string_lossy();
    out.map_or_else(|| case.with_file_name(format!("{}-{what}", stem())), Path::to_path_buf)
}

/// As many bytes.
fn megabytes(count: u64) -> u64 {
    count.saturating_mul(1_000_000)
}
