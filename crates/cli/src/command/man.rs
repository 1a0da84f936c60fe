//! `frfit man`

use super::{say, say_json};
use crate::args::{Args, Man};
use crate::outcome::{Failure, Outcome};
use clap::{Command, CommandFactory};
use frfit_workflow::Reads;
use frfit_workflow::output::{File, write_all};
use serde_json::json;

pub(crate) fn run(args: &Args, wanted: &Man) -> Result<Outcome, Failure> {
    let mut command = Args::command();
    command.build();
    let mut pages = Vec::new();
    add(&command, "frfit", &mut pages)?;
    let names: Vec<String> = pages.iter().map(|page| page.path.display().to_string()).collect();
    write_all(&wanted.folder, pages, &Reads::default())?;
    if args.json {
        say_json(&json!({"wrote": names}))?;
    } else if !args.quiet {
        say(&format!("wrote {}: {}\n", wanted.folder.display(), names.join(", ")))?;
    }
    Ok(Outcome::Done)
}

/// The page of a command and those below it, named as in `frfit-batch-status.1`.
fn add(command: &Command, name: &str, pages: &mut Vec<File>) -> Result<(), Failure> {
    let mut page = Vec::new();
    // A page needs a name of static lifetime, and the process ends after the last.
    let title: &'static str = name.to_owned().leak();
    let rendered = clap_mangen::Man::new(command.clone().name(title)).render(&mut page);
    rendered.map_err(|error| Failure::Internal(error.to_string()))?;
    pages.push(File::new(format!("{name}.1"), page));
    command
        .get_subcommands()
        .filter(|below| below.get_name() != "help")
        .try_for_each(|below| add(below, &format!("{name}-{}", below.get_name()), pages))
}
