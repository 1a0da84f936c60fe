//! `frfit report`

use super::{say, say_json};
use crate::args::{Args, Report};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::Reads;
use frfit_workflow::output::write_all;
use frfit_workflow::report::report_of_folder;
use serde_json::json;

pub(crate) fn run(args: &Args, wanted: &Report) -> Result<Outcome, Failure> {
    let mut reads = Reads::default();
    let page = report_of_folder(&wanted.results, &mut reads)?;
    let (path, bytes) = (wanted.results.join(&page.path), page.bytes.len());
    write_all(&wanted.results, vec![page], &reads)?;
    if args.json {
        say_json(&json!({"wrote": path.display().to_string(), "bytes": bytes}))?;
    } else if !args.quiet {
        say(&format!("wrote {}: {:.1} MB, which any browser opens\n", path.display(), bytes as f64 / 1e6))?;
    }
    Ok(Outcome::Done)
}
