//! `frfit inspect`

use super::say;
use crate::args::{Args, Inspect};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::inspect::{inspect, natural_frequencies};
use serde_json::json;

pub(crate) fn run(args: &Args, wanted: &Inspect) -> Result<Outcome, Failure> {
    for file in &wanted.files {
        let found = inspect(file)?;
        say(&if args.json { format!("{}\n", found.json()) } else { found.text() })?;
    }
    let Some(count) = wanted.modes else { return Ok(Outcome::Done) };
    let [stiffness, mass] = &wanted.files[..] else {
        let found = wanted.files.len();
        return Err(Failure::Input(format!("--modes: expected two files, K and M, found {found}")));
    };
    let frequency_hz = natural_frequencies(stiffness, mass, count)?;
    say(&if args.json {
        format!("{}\n", json!({"natural_frequencies_hz": frequency_hz}))
    } else {
        let lines = frequency_hz.iter().enumerate().map(|(i, f)| format!("  {:>3}  {f:.6} Hz\n", i + 1));
        format!("natural frequencies of K φ = ω² M φ\n{}", lines.collect::<String>())
    })?;
    Ok(Outcome::Done)
}
