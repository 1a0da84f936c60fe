//! `frfit convert`

use super::{one_on_standard_output, say_beside};
use crate::args::{Args, Convert};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::Reads;
use frfit_workflow::convert::{ConvertOptions, convert};
use frfit_workflow::output::{Words, write_one};

pub(crate) fn run(args: &Args, wanted: &Convert) -> Result<Outcome, Failure> {
    let options = ConvertOptions {
        name: wanted.name.clone(),
        records: wanted.record.clone(),
        columns: wanted.columns.clone(),
        quantity: wanted.quantity,
        response: wanted.response,
        reference: wanted.reference,
        to: wanted.to.clone(),
        binary: wanted.binary,
    };
    one_on_standard_output(args, &wanted.output)?;
    let mut reads = Reads::default();
    let bytes = convert(&wanted.input, &wanted.output, &options, &mut reads)?;
    let size = bytes.len();
    write_one(&wanted.output, bytes, &reads)?;
    if !args.json {
        let mut words = Words::default();
        words.say(&format!("wrote {} ({size} bytes)\n", wanted.output.display()));
        say_beside(args, &wanted.output, &words)?;
    }
    Ok(Outcome::Done)
}
