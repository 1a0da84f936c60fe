//! `frfit export`

use super::say;
use crate::args::{Args, Export};
use crate::outcome::{Failure, Outcome};
use frfit_workflow::export::{ExportOptions, export};
use frfit_workflow::output::{File, write_all};
use serde_json::{Map, Value, json};
use std::path::Path;

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
    };
    let done = export(&wanted.table, wanted.law.as_deref(), &options)?;
    write_all(Path::new(""), &[File::new(wanted.out.clone(), done.text)])?;
    let (modulus, out) = (done.modulus, wanted.out.display());
    let ([first, last], count) = (modulus.band_hz(), modulus.rows.len());
    if args.json {
        let left_out: Map<String, Value> =
            modulus.left_out.iter().map(|(status, count)| (status.clone(), json!(count))).collect();
        let told = json!({
            "wrote": out.to_string(),
            "unit_system": wanted.unit_system.name(),
            "frequencies": count,
            "range_hz": [first, last],
            "left_out": left_out,
            "law": modulus.law,
        });
        say(&format!("{told:#}\n"))?;
    } else if !args.quiet {
        let units = wanted.unit_system;
        let mut text = format!(
            "wrote {out}: {count} frequencies, {first} to {last} Hz, in {} ({})\n",
            units.name(),
            units.modulus_unit()
        );
        if let Some(law) = &modulus.law {
            text += &format!("  law       {law}\n");
        }
        if let Some(words) = modulus.left_out_words() {
            let hint = if wanted.all { "" } else { " (--all takes those with a modulus)" };
            text += &format!("  left out  {words}{hint}\n");
        }
        say(&text)?;
    }
    Ok(Outcome::Done)
}
