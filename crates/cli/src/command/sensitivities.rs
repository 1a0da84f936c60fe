//! `frfit sensitivities`

use super::{megabytes, say};
use crate::args::{Args, Sensitivities};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::load::Overrides;
use frfit_workflow::sensitivities::{SensitivityOptions, sensitivities_case};

pub(crate) fn run(args: &Args, wanted: &Sensitivities) -> Result<Outcome, Failure> {
    let overrides = Overrides { band_hz: wanted.overrides.band, ..Overrides::default() };
    let options = SensitivityOptions {
        noise: wanted.noise,
        candidates: wanted.candidates.clone(),
        memory_bytes: wanted.memory.map(megabytes),
    };
    let job = sensitivities_case(&wanted.case, &overrides, &options, wanted.out.as_deref())?;
    if args.json {
        say(&format!("{:#}\n", job.summary))?;
    } else if !args.quiet {
        let wrote = wanted.out.as_ref().map_or(String::new(), |out| {
            let files = match job.run {
                Ok(_) => "sensitivities.csv, sensitivities.json, figures/",
                Err(_) => "sensitivities.json",
            };
            format!("  {:<18}{}: {files}\n", "wrote", out.display())
        });
        say(&format!("{}{wrote}", job.text))?;
    }
    Ok(Outcome::Done)
}
