//! `frfit check`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Check};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::check::{check_case, check_text, findings_json, not_judged, others_json};
use frfit_workflow::load::Overrides;
use serde_json::json;

pub(crate) fn run(args: &Args, wanted: &Check) -> Result<Outcome, Failure> {
    let overrides =
        Overrides { band_hz: wanted.overrides.band, reduced: wanted.reduced.clone(), ..Overrides::default() };
    let job = check_case(&wanted.case, &overrides, wanted.memory.map(megabytes))?;
    if args.json {
        let found = json!({
            "title": job.case.title,
            "findings": findings_json(&job.case, &job.diagnosis),
            "other_explanations": others_json(&job.case, &job.diagnosis),
            "misfit": job.diagnosis.misfit,
            "not_judged": job.diagnosis.not_judged.map(not_judged),
            "frequencies": job.diagnosis.frequencies,
        });
        say_json(&found)?;
    } else {
        say_words(args, &check_text(&job))?;
    }
    let clean = job.diagnosis.findings.is_empty() && job.diagnosis.others.is_empty();
    Ok(if wanted.strict && !clean { Outcome::NotTrusted } else { Outcome::Done })
}
