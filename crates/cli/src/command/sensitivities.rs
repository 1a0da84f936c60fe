//! `frfit sensitivities`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Sensitivities};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::load::Overrides;
use frfit_workflow::sensitivities::{SensitivityOptions, sensitivities_case};

pub(crate) fn run(args: &Args, wanted: &Sensitivities) -> Result<Outcome, Failure> {
    let overrides = Overrides { reduced: wanted.reduced.clone(), ..wanted.overrides.of_case() };
    let options = SensitivityOptions {
        noise: wanted.noise,
        candidates: wanted.candidates.clone(),
        memory_bytes: wanted.memory.map(megabytes),
    };
    let job = sensitivities_case(&wanted.case, &overrides, &options, wanted.out.as_deref())?;
    if args.json {
        say_json(&job.summary)?;
    } else {
        let mut words = job.text;
        if let Some(out) = &wanted.out {
            let files = match job.run {
                Ok(_) => "sensitivities.csv, sensitivities.json, figures/",
                Err(_) => "sensitivities.json",
            };
            words.say(&format!("  {:<18}{}: {files}\n", "wrote", out.display()));
        }
        say_words(args, &words)?;
    }
    Ok(Outcome::Done)
}
