//! `frfit convert`

use super::say;
use crate::args::{Args, Convert};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::convert::{ConvertOptions, convert};
use frfit_workflow::output::{File, write_all};
use std::path::Path;

pub(crate) fn run(args: &Args, wanted: &Convert) -> Result<Outcome, Failure> {
    let options = ConvertOptions {
        name: wanted.name.clone(),
        record: wanted.record,
        quantity: wanted.quantity,
        response: wanted.response,
        reference: wanted.reference,
        binary: wanted.binary,
    };
    let bytes = convert(&wanted.input, &wanted.output, &options)?;
    let size = bytes.len();
    write_all(Path::new(""), &[File::new(wanted.output.clone(), bytes)])?;
    if !args.quiet && !args.json {
        say(&format!("wrote {} ({size} bytes)\n", wanted.output.display()))?;
    }
    Ok(Outcome::Done)
}
