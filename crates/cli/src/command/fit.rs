//! `frfit fit`

use super::{say, say_json};
use crate::args::{Args, Fit};
use crate::outcome::{Failure, Outcome};
use frfit::laws::LawKind;
use frfit_workflow::fit::fit_table;

pub(crate) fn run(args: &Args, wanted: &Fit) -> Result<Outcome, Failure> {
    let kinds: Vec<LawKind> = wanted.laws.iter().flat_map(|laws| &laws.0).copied().collect();
    let only = wanted.only.as_ref().map(|(column, value)| (column.as_str(), value.as_str()));
    let job = fit_table(&wanted.table, only, &kinds, wanted.out.as_deref())?;
    if args.json {
        say_json(&job.summary)?;
    } else if !args.quiet {
        let wrote = wanted
            .out
            .as_ref()
            .map_or(String::new(), |out| format!("  wrote {}: law.json, figures/\n", out.display()));
        say(&format!("{}{wrote}", job.text))?;
    }
    Ok(Outcome::Done)
}
