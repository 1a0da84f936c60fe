//! `frfit completions`

use super::put;
use crate::args::{Args, Completions};
use crate::outcome::{Failure, Outcome};
use clap::CommandFactory;

pub(crate) fn run(wanted: &Completions) -> Result<Outcome, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(wanted.shell, &mut Args::command(), "frfit", &mut script);
    // A script may hold what would steer a terminal.
    put(std::io::stdout().lock(), "standard output", &String::from_utf8_lossy(&script))?;
    Ok(Outcome::Done)
}
