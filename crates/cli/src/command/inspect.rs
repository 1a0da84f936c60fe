//! `frfit inspect`

use super::{say, say_json_line};
use crate::args::{Args, Inspect};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::inspect::{inspect, modes_json, natural_frequencies, rigid_body_modes};

pub(crate) fn run(args: &Args, wanted: &Inspect) -> Result<Outcome, Failure> {
    for file in &wanted.files {
        let found = inspect(file)?;
        match args.json {
            true => say_json_line(&found.json())?,
            false => say(&found.text())?,
        }
    }
    let frequency_hz = match (&wanted.files[..], wanted.modes) {
        ([stiffness, mass], Some(count)) => natural_frequencies(stiffness, mass, count)?,
        // two files that are not K and M have none
        ([stiffness, mass], None) => natural_frequencies(stiffness, mass, USUAL).unwrap_or_default(),
        (files, Some(_)) => {
            let found = files.len();
            return Err(Failure::Input(format!("--modes: expected two files, K and M, found {found}")));
        }
        (_, None) => Vec::new(),
    };
    if frequency_hz.is_empty() {
        return Ok(Outcome::Done);
    }
    if args.json {
        say_json_line(&modes_json(&frequency_hz))?;
    } else {
        let rigid = rigid_body_modes(&frequency_hz);
        let lines = frequency_hz.iter().enumerate().map(|(i, f)| format!("  {:>3}  {f:.6} Hz\n", i + 1));
        let rigid = match rigid {
            0 => String::new(),
            1 => "; the first is a rigid-body mode".to_owned(),
            more => format!("; the first {more} are rigid-body modes"),
        };
        let lines = lines.collect::<String>();
        say(&format!("natural frequencies of K φ = ω² M φ{rigid}\n{lines}"))?;
    }
    Ok(Outcome::Done)
}

/// Natural frequencies of two files where no number is asked for: six rigid-body modes, and as many others.
const USUAL: usize = 12;
