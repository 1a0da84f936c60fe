//! One file a command.

pub(crate) mod check;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod example;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod frf;
pub(crate) mod identify;
pub(crate) mod inspect;
pub(crate) mod report;
pub(crate) mod respond;
pub(crate) mod sensitivities;

use crate::outcome::Failure;
use std::io::Write;

/// Writes to standard output; a reader that has gone away is no failure.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Input(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// As many bytes.
fn megabytes(count: u64) -> u64 {
    count.saturating_mul(1_000_000)
}
