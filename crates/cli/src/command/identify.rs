//! `frfit identify`

use super::{folder_for, megabytes, say_json, say_words};
use crate::args::{Args, Identify};
use crate::outcome::{Failure, Outcome};
use crate::progress::Progress;
use crate::report;
use frfit::identify::{Line, Trust};
use frfit_workflow::job::{IdentifyJob, identify_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;
use std::path::Path;

pub(crate) fn run(args: &Args, identify: &Identify) -> Result<Outcome, Failure> {
    let overrides = Overrides {
        method: identify.method.clone(),
        order: identify.order,
        selection: identify.selection.clone(),
        reduction: identify.reduction.clone(),
        reduced: identify.reduced.clone(),
        ..identify.overrides.of_case()
    };
    let options = RunOptions {
        error_map: identify.error_map,
        memory_bytes: identify.memory.map(megabytes),
        keep_reduced: identify.keep_reduced.clone(),
    };
    let out = folder_for(identify.out.as_deref(), &identify.case, "results");
    let job = carry_out(args, &identify.case, &overrides, options, &out)?;
    let found = &job.run.found;
    // What the user left out needs no value.
    let is_fine = |line: &Line| matches!(line.status.trust(), Trust::Trusted | Trust::NotAsked);
    let trusted = found.lines.iter().all(is_fine) && found.is_trusted();
    Ok(if identify.strict && !trusted { Outcome::NotTrusted } else { Outcome::Done })
}

/// Identifies and says what came out; `frfit demo` ends with this too.
pub(crate) fn carry_out(
    args: &Args,
    case: &Path,
    overrides: &Overrides,
    options: RunOptions,
    out: &Path,
) -> Result<IdentifyJob, Failure> {
    let progress = Progress::new(args.quiet || args.json);
    let job = identify_case(case, overrides, options, out, &|done, total| progress.show(done, total));
    progress.end();
    let job = job?;
    if args.json {
        say_json(&job.summary)?;
    } else {
        say_words(args, &report::identified(&job, out))?;
    }
    Ok(job)
}
