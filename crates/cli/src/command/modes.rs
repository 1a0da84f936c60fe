//! `frfit modes`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Modes};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::load::Overrides;
use frfit_workflow::modes::{ModesOptions, modes_case};

pub(crate) fn run(args: &Args, wanted: &Modes) -> Result<Outcome, Failure> {
    let overrides = Overrides {
        identified: wanted.identified.clone(),
        reduced: wanted.reduced.clone(),
        ..wanted.overrides.of_case()
    };
    let options = ModesOptions { max_order: wanted.max_order, memory_bytes: wanted.memory.map(megabytes) };
    let job = modes_case(&wanted.case, &overrides, &options, wanted.out.as_deref())?;
    if args.json {
        say_json(&job.summary)?;
    } else {
        let mut words = job.text;
        if let Some(out) = &wanted.out {
            let files = match job.run.measured {
                Some(_) => "modes.csv, modes.json, modes.uff, stabilisation.csv, correlation.csv, figures/",
                None => "modes.csv, modes.json, modes.uff",
            };
            words.say(&format!("  {:<18}{}: {files}\n", "wrote", out.display()));
        }
        say_words(args, &words)?;
    }
    Ok(Outcome::Done)
}
