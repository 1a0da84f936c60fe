//! `frfit check`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Check};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::check::{check_case, check_text};
use frfit_workflow::load::Overrides;

pub(crate) fn run(args: &Args, wanted: &Check) -> Result<Outcome, Failure> {
    let overrides = Overrides { reduced: wanted.reduced.clone(), ..wanted.overrides.of_case() };
    let job = check_case(&wanted.case, &overrides, wanted.memory.map(megabytes))?;
    if args.json {
        say_json(&job.json())?;
    } else {
        say_words(args, &check_text(&job))?;
    }
    Ok(if wanted.strict && !job.is_clean() { Outcome::NotTrusted } else { Outcome::Done })
}
