//! The identified modulus as the table that the next solver reads.

mod abaqus;
mod ansys;
mod modulus;
mod nastran;
mod options;
mod plain;
mod solid;

pub use crate::units::UnitSystem;
pub use modulus::{Modulus, modulus};
pub use options::{ExportOptions, Target, UnknownWord};

use crate::error::{InputError, Place};
use crate::reads::Reads;
use serde_json::{Map, Value, json};
use solid::{Solid, heading};
use std::path::Path;

/// What was made of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Export {
    /// The file's contents.
    pub text: String,
    /// Its modulus, in SI units.
    pub modulus: Modulus,
    /// The units in which it was written.
    pub units: UnitSystem,
}

impl Export {
    /// What `frfit export --json` prints of a file that was written.
    pub fn json(&self, wrote: &Path) -> Value {
        let left_out: Map<String, Value> =
            self.modulus.left_out.iter().map(|(status, count)| (status.clone(), json!(count))).collect();
        json!({
            "wrote": wrote.display().to_string(),
            "unit_system": self.units.name(),
            "frequencies": self.modulus.rows.len(),
            "range_hz": self.modulus.band_hz(),
            "left_out": left_out,
            "law": self.modulus.law,
        })
    }
}

/// A table of moduli, such as `identified.csv`, as the input of a solver, as a table or as JSON. With a law (a `law.json`) the values are those of the best law in it, at the
/// frequencies of the table.
///
/// | target | what is written |
/// |---|---|
/// | Nastran | MAT1 and the pair of TABLED1 for SDAMPING in SOL 108 |
/// | Abaqus | `*ELASTIC` and `*VISCOELASTIC, FREQUENCY=TABULAR` |
/// | Ansys | `TB,ELASTIC` and `TB,SDAMP` over `TBFIELD,FREQ` |
/// | CSV, JSON | frequency, E′, η, standard deviations, status, units |
///
/// # Errors
/// What [`modulus()`] refuses; for a solver Poisson's ratio that is missing or out of range, a density that is not above zero, a number or name that the solver does not take.
pub fn export(
    table: &Path,
    law: Option<&Path>,
    options: &ExportOptions,
    reads: &mut Reads,
) -> Result<Export, InputError> {
    if let Some(value) = options.modulus.filter(|&value| !(value > 0.0 && value.is_finite())) {
        return Err(InputError::at(&Place::option("--modulus"), "a modulus above 0 Pa", value.to_string()));
    }
    let modulus = modulus(table, law, options, reads)?;
    let units = options.units.or(modulus.units).unwrap_or_default();
    let source = table.file_name().unwrap_or_default().to_string_lossy();
    let solid = || Solid::new(&modulus, options, units);
    let heading = || heading(&modulus, options, units, &source);
    let text = match options.target {
        Target::Nastran => nastran::nastran(&solid()?, options.id, &heading(), table)?,
        Target::Abaqus => abaqus::abaqus(&solid()?, &options.name, &heading(), table)?,
        Target::Ansys => ansys::ansys(&solid()?, options.id, &heading(), table)?,
        Target::Csv => plain::csv(&modulus, units),
        Target::Json => plain::json(&modulus, units, &source),
    };
    Ok(Export { text, modulus, units })
}
