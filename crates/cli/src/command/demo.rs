//! `frfit demo`: the main job, offline.

use super::{example, identify, say};
use crate::args::{Args, Demo};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::load::Overrides;
use frfit_workflow::run::RunOptions;

/// The paper's first case: a wrong modulus of rubber, corrected over two decades of frequency.
const CASE: &str = "rubber-bar";

pub(crate) fn run(args: &Args, demo: &Demo) -> Result<Outcome, Failure> {
    example::write(CASE, &demo.out)?;
    if !args.quiet && !args.json {
        say(&format!(
            "The case is in {}: a rubber bar whose modulus is 50 % off, and its measured response.\n\n",
            demo.out.display()
        ))?;
    }
    let (case, out) = (demo.out.join("case.toml"), demo.out.join("out"));
    identify::carry_out(args, &case, &Overrides::default(), RunOptions::default(), &out)?;
    Ok(Outcome::Done)
}
