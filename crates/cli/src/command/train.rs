//! `frfit train`

use super::{megabytes, say_json, say_words};
use crate::args::{Args, Train};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::job::{TrainJob, train_case};
use frfit_workflow::load::Overrides;
use frfit_workflow::output::Words;

pub(crate) fn run(args: &Args, train: &Train) -> Result<Outcome, Failure> {
    let overrides = Overrides { reduced: train.reduced.clone(), ..train.overrides.of_case() };
    let job = train_case(&train.case, &overrides, train.memory.map(megabytes), &train.out)?;
    let TrainJob { case, vectors, work, bytes, seconds } = &job;
    if args.json {
        say_json(&job.json())?;
        return Ok(Outcome::Done);
    }
    let mut words = Words::default();
    words.say(&format!(
        "{}: {vectors} vectors for {} degrees of freedom ({} factorisations, {} solves, {seconds:.2} s)\n{} ({:.1} MB)\n",
        case.title,
        case.model.dim(),
        work.factorisations,
        work.solves,
        train.out.display(),
        *bytes as f64 / 1e6,
    ));
    say_words(args, &words)?;
    Ok(Outcome::Done)
}
