//! The units of a table of moduli: those of the case that it came of.

use super::{FactorUnit, UnitSystem};
use crate::error::{InputError, Place};
use serde_json::Value;
use std::io::ErrorKind;
use std::path::Path;

/// The units of the numbers of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TableUnits {
    pub(crate) system: UnitSystem,
    pub(crate) factor: FactorUnit,
}

impl TableUnits {
    /// Of a table of `frfit identify`, or of one of its unknowns, from the `summary.json` beside it; `None` for any other table, as one of an instrument.
    ///
    /// # Errors
    /// A summary that lists the table, with units that this version does not know.
    pub(crate) fn beside(table: &Path, unknown: Option<&str>) -> Result<Option<Self>, InputError> {
        let path = table.with_file_name("summary.json");
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => {
                return Err(InputError::at(
                    &Place::file(&path),
                    "a file that can be read",
                    error.to_string(),
                ));
            }
        };
        // A folder may have a file of this name from elsewhere.
        let Ok(mut summary) = serde_json::from_slice::<Value>(&bytes) else { return Ok(None) };
        let one =
            unknown.and_then(|name| summary["unknowns"].as_array()?.iter().find(|one| one["name"] == name));
        if let Some(unit) = one.map(|one| one["unit"].clone()) {
            summary["factor_unit"] = unit;
        }
        let name = table.file_name().and_then(|name| name.to_str());
        let listed =
            summary["tables"].as_array().is_some_and(|all| all.iter().any(|one| one.as_str() == name));
        match listed {
            true => Self::of_json(&summary, &path),
            false => Ok(None),
        }
    }

    /// From `units` and `factor_unit` of a `summary.json` or `law.json`; `None` where it has no `units`.
    pub(crate) fn of_json(json: &Value, path: &Path) -> Result<Option<Self>, InputError> {
        let Some(system) = json["units"]["system"].as_str() else { return Ok(None) };
        let system: UnitSystem = system.parse().map_err(|error: super::UnknownSystem| {
            InputError::at(&Place::file(path).below("units.system"), error.expected, error.found)
        })?;
        let factor = match json["factor_unit"].as_str() {
            None => FactorUnit::Other,
            Some("1") => FactorUnit::Relative,
            Some(_) => FactorUnit::Modulus(system),
        };
        Ok(Some(Self { system, factor }))
    }
}
