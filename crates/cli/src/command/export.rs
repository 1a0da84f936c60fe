//! `frfit export`

use super::{one_on_standard_output, say_beside, say_json};
use crate::args::{Args, Export};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::Reads;
use frfit_workflow::export::{ExportOptions, export};
use frfit_workflow::output::{Words, write_one};
use frfit_workflow::terminal::short;

pub(crate) fn run(args: &Args, wanted: &Export) -> Result<Outcome, Failure> {
    let options = ExportOptions {
        target: wanted.format,
        units: wanted.unit_system,
        poisson: wanted.poisson,
        density: wanted.density,
        modulus: wanted.modulus,
        id: wanted.id,
        name: wanted.name.clone(),
        all: wanted.all,
        unknown: wanted.unknown.clone(),
    };
    one_on_standard_output(args, &wanted.out)?;
    let mut reads = Reads::default();
    let done = export(&wanted.table, wanted.law.as_deref(), &options, &mut reads)?;
    write_one(&wanted.out, done.text.as_bytes().to_vec(), &reads)?;
    if args.json {
        say_json(&done.json(&wanted.out))?;
    } else {
        let (modulus, units, out) = (done.modulus, done.units, wanted.out.display());
        let ([first, last], count) = (modulus.band_hz().map(short), modulus.rows.len());
        let mut words = Words::default();
        words.say(&format!(
            "wrote {out}: {count} frequencies, {first} to {last} Hz, in {} ({})\n",
            units.name(),
            modulus.unit(units)
        ));
        if let Some(law) = &modulus.law {
            words.say(&format!("  law       {law}\n"));
        }
        if let Some(left_out) = modulus.left_out_words() {
            let hint = if wanted.all { "" } else { " (--all takes those with a modulus)" };
            words.warn(&format!("  left out  {left_out}{hint}\n"));
        }
        say_beside(args, &wanted.out, &words)?;
    }
    Ok(Outcome::Done)
}
