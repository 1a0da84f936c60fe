//! The `frfit` command: arguments, progress, exit codes; nothing else.

mod args;
mod command;
mod outcome;
mod progress;
mod report;

use args::{Args, Command};
use clap::Parser;
use frfit_workflow::terminal::printable;
use outcome::{Failure, Outcome};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return outcome::usage(&error),
    };
    // A panic is a fault of this program: exit code 3, after the message that the default hook prints.
    match std::panic::catch_unwind(|| run(&args)) {
        Ok(Ok(outcome)) => outcome.code(),
        Ok(Err(failure)) => {
            // Nothing can be done where standard error is closed.
            let _ = writeln!(std::io::stderr(), "frfit: {}", printable(&failure.to_string()));
            failure.code()
        }
        Err(_) => ExitCode::from(3),
    }
}

fn run(args: &Args) -> Result<Outcome, Failure> {
    match &args.command {
        Command::Demo(demo) => command::demo::run(args, demo),
        Command::Example(example) => command::example::run(args, example),
        Command::Frf(frf) => command::frf::run(args, frf),
        Command::Check(check) => command::check::run(args, check),
        Command::Identify(identify) => command::identify::run(args, identify),
        Command::Batch(batch) => command::batch::run(args, batch),
        Command::Train(train) => command::train::run(args, train),
        Command::Fit(fit) => command::fit::run(args, fit),
        Command::Report(report) => command::report::run(args, report),
        Command::Export(export) => command::export::run(args, export),
        Command::Respond(respond) => command::respond::run(args, respond),
        Command::Modes(wanted) => command::modes::run(args, wanted),
        Command::Sensitivities(wanted) => command::sensitivities::run(args, wanted),
        Command::Inspect(inspect) => command::inspect::run(args, inspect),
        Command::Convert(convert) => command::convert::run(args, convert),
        Command::Completions(wanted) => command::completions::run(wanted),
        Command::Man(man) => command::man::run(args, man),
    }
}
