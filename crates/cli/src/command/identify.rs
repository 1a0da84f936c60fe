//! `frfit identify`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Identify};
use crate::outcome::{Failure, Outcome};
use crate::progress::Progress;
use crate::report;
use frfit::identify::Status;
use frfit_workflow::job::{IdentifyJob, identify_case, several_case};
use frfit_workflow::load::{Overrides, asks_for_several};
use frfit_workflow::run::RunOptions;
use std::path::Path;

pub(crate) fn run(args: &Args, identify: &Identify) -> Result<Outcome, Failure> {
    let overrides = Overrides {
        method: identify.method.clone(),
        order: identify.order,
        band_hz: identify.overrides.band,
        selection: identify.selection.clone(),
        reduction: identify.reduction.clone(),
    };
    if asks_for_several(&identify.case)? {
        return several(args, identify, &overrides);
    }
    let options = RunOptions { error_map: identify.error_map, memory_bytes: identify.memory.map(megabytes) };
    let job = carry_out(args, &identify.case, &overrides, options, &identify.out)?;
    // What the user left out needs no answer.
    let trusted = job.run.count(Status::Ok) + job.run.count(Status::OutOfBand) == job.run.found.lines.len();
    Ok(if identify.strict && !trusted { Outcome::NotTrusted } else { Outcome::Done })
}

/// Several unknowns, or one that does not vary.
fn several(args: &Args, identify: &Identify, overrides: &Overrides) -> Result<Outcome, Failure> {
    let progress = Progress::new(args.quiet || args.json);
    let memory = identify.memory.map(megabytes);
    let show = |done, total| progress.show(done, total);
    let job = several_case(&identify.case, overrides, memory, &identify.out, &show);
    progress.end();
    let job = job?;
    if args.json {
        say_json(&job.summary)?;
    } else {
        say_words(args, &report::several(&job, &identify.out))?;
    }
    let outcome = &job.run.found;
    let trusted = outcome.is_trusted() && job.run.count(Status::Ok) == outcome.lines.len();
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
