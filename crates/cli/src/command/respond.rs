//! `frfit respond`

use super::{folder_for, megabytes, say_json, say_words};
use crate::args::{Args, Respond};
use crate::outcome::{Failure, Outcome};
use crate::progress::Progress;
use frfit_workflow::job::respond_case;
use frfit_workflow::output::Words;
use frfit_workflow::terminal::short;
use serde_json::json;

pub(crate) fn run(args: &Args, respond: &Respond) -> Result<Outcome, Failure> {
    let overrides = respond.overrides.of_case();
    let progress = Progress::new(args.quiet || args.json);
    let memory = respond.memory.map(megabytes);
    let show = |done, total| progress.show(done, total);
    let out = folder_for(respond.out.as_deref(), &respond.case, "response");
    let done = respond_case(&respond.case, &overrides, memory, Some(&out), &show);
    progress.end();
    let (case, run) = done?;
    let broken = run.unsolved();
    if args.json {
        say_json(&json!({"frequencies": run.frequency_hz.len(), "unsolved": broken}))?;
    } else {
        let (first, last) = (run.frequency_hz.first(), run.frequency_hz.last());
        let band =
            first.zip(last).map_or(String::new(), |(a, b)| format!(", {} to {} Hz", short(*a), short(*b)));
        let mut words = Words::default();
        words.say(&format!(
            "{}: response at {} sensor(s), {} frequencies{band}\nwrote {}: response.csv, frf.uff, figures/\n",
            case.title,
            case.sensors.len(),
            run.frequency_hz.len(),
            out.display()
        ));
        broken.iter().for_each(|line| words.warn(&format!("no answer {line}\n")));
        say_words(args, &words)?;
    }
    Ok(Outcome::Done)
}
