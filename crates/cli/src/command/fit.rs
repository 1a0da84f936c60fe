//! `frfit fit`

use super::say;
use crate::args::{Args, Fit};
use crate::outcome::{Failure, Outcome};
use frfit::laws::Family;
use frfit_workflow::fit::fit_table;

pub(crate) fn run(args: &Args, wanted: &Fit) -> Result<Outcome, Failure> {
    let mut families: Vec<Family> = Vec::new();
    for &family in wanted.laws.iter().flat_map(|laws| &laws.0) {
        if !families.contains(&family) {
            families.push(family);
        }
    }
    if families.is_empty() {
        families = Family::ALL.to_vec();
    }
    let only = wanted.only.as_ref().map(|(column, value)| (column.as_str(), value.as_str()));
    let job = fit_table(&wanted.table, only, &families, wanted.out.as_deref())?;
    if args.json {
        say(&format!("{:#}\n", job.summary))?;
    } else if !args.quiet {
        let wrote = wanted
            .out
            .as_ref()
            .map_or(String::new(), |out| format!("  wrote {}: law.json, figures/\n", out.display()));
        say(&format!("{}{wrote}", job.text))?;
    }
    Ok(Outcome::Done)
}
