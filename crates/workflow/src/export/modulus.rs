//! The modulus that is written: of a table, or of a law at the frequencies of a table.

use super::options::ExportOptions;
use crate::case::law_of_snippet;
use crate::error::{InputError, Place};
use crate::load::{load_bytes, table_of_unknown};
use crate::reads::Reads;
use crate::units::{FactorUnit, TableUnits, UnitSystem};
use frfit::c64;
use frfit::identify::Status;
use frfit::material::loss_factor;
use frfit_formats::csv::{ModulusRow, ModulusRows, read_modulus_rows};
use serde_json::Value;
use std::path::Path;

/// What is exported, in SI units, or relative to the modulus that a matrix was made with.
#[derive(Debug, Clone, PartialEq)]
pub struct Modulus {
    /// The rows, by frequency.
    pub rows: Vec<ModulusRow>,
    /// How many rows of the table are not among them, by status; those without one as `no modulus`.
    pub left_out: Vec<(String, usize)>,
    /// The law that the rows are of, as a case file has it.
    pub law: Option<String>,
    /// The units of the case that the table came of, where the folder of the table has its summary.
    pub units: Option<UnitSystem>,
    /// Whether the numbers are factors without a unit.
    pub is_relative: bool,
    /// What the numbers of the law are.
    of_law: FactorUnit,
}

impl Modulus {
    /// First and last frequency.
    pub fn band_hz(&self) -> [f64; 2] {
        let hz = |row: Option<&ModulusRow>| row.map_or(f64::NAN, |row| row.frequency_hz);
        [hz(self.rows.first()), hz(self.rows.last())]
    }

    /// A storage modulus as it is written in some units.
    pub(super) fn in_units(&self, units: UnitSystem, storage: f64) -> f64 {
        if self.is_relative { storage } else { units.modulus(storage) }
    }

    /// The unit of what is written: `1` of relative factors.
    pub fn unit(&self, units: UnitSystem) -> &'static str {
        if self.is_relative { "1" } else { units.modulus_unit() }
    }

    /// What the numbers of the law are, in words.
    pub(super) fn law_unit(&self) -> String {
        match self.of_law {
            FactorUnit::Modulus(units) => format!("moduli in {}, times in s", units.modulus_unit()),
            FactorUnit::Relative | FactorUnit::Other => "relative moduli, times in s".into(),
        }
    }

    /// `12 ambiguous, 3 no_root`; nothing where every row is there.
    pub fn left_out_words(&self) -> Option<String> {
        let words: Vec<String> =
            self.left_out.iter().map(|(status, count)| format!("{count} {status}")).collect();
        (!words.is_empty()).then(|| words.join(", "))
    }
}

/// Reads a table; with a law, the values are the law's at every frequency of the table, whatever its rows say.
///
/// # Errors
/// What [`read_modulus_rows`] refuses; a file that holds no law; no row to write; a storage modulus that is not above zero; for a solver, moduli too small for any solid.
pub fn modulus(
    table: &Path,
    law: Option<&Path>,
    options: &ExportOptions,
    reads: &mut Reads,
) -> Result<Modulus, InputError> {
    let unknown = options.unknown.as_deref();
    let bytes = table_of_unknown(load_bytes(table, reads)?, unknown, table)?;
    let rows = read_modulus_rows(&bytes).map_err(|error| InputError::in_file(table, error))?;
    let beside = TableUnits::beside(table, unknown)?;
    // A table that names its unit was converted to Pa. One without unit and summary is taken as in Pa.
    let own = beside.map(|units| units.factor).filter(|_| !rows.names_unit);
    let (mut modulus, of) = match law {
        Some(law) => {
            let modulus = of_law(law, &rows, reads)?;
            let of = modulus.of_law;
            (modulus, Some(of))
        }
        None => (of_table(rows, options.all), own),
    };
    modulus.units = modulus.units.or(beside.map(|units| units.system));
    if modulus.rows.is_empty() {
        let found = modulus.left_out_words().unwrap_or_else(|| "none".into());
        let expected = if options.all { "a row with a modulus" } else { "a row that is ok (or --all)" };
        return Err(InputError::at(&Place::file(table), expected, found));
    }
    let scale = match (options.modulus, of) {
        (Some(made_with), _) => made_with,
        (None, Some(FactorUnit::Modulus(system))) => system.modulus_pa(),
        (None, _) => 1.0,
    };
    for row in &mut modulus.rows {
        row.storage *= scale;
        row.std = row.std.map(|[storage, eta]| [scale * storage, eta]);
    }
    if let Some(row) = modulus.rows.iter().find(|row| !(row.storage > 0.0 && row.storage.is_finite())) {
        let found = format!("{:e} at {} Hz", row.storage, row.frequency_hz);
        return Err(InputError::at(&Place::file(table), "finite storage moduli above 0", found));
    }
    let largest = modulus.rows.iter().map(|row| row.storage).fold(0.0, f64::max);
    let unitless = matches!(of, Some(FactorUnit::Relative | FactorUnit::Other));
    modulus.is_relative = options.modulus.is_none() && unitless;
    if options.target.is_solver() && (largest < SOFTEST || modulus.is_relative) {
        let found = match modulus.is_relative {
            true => format!("factors without a unit, at most {largest:?}"),
            false => format!("at most {largest:?}"),
        };
        let expected = "moduli in Pa (--modulus gives the one that the matrix was made with, where factors are relative to it; factor_is = \"modulus\" in the case says that they are not)";
        return Err(InputError::at(&Place::file(table), expected, found));
    }
    Ok(modulus)
}

/// Softer than gels of a hundred pascal: such numbers are factors of a matrix that has its modulus in it.
const SOFTEST: f64 = 100.0;

fn of_table(rows: ModulusRows, all: bool) -> Modulus {
    let mut left_out: Vec<(String, usize)> = Vec::new();
    let mut leave_out = |status: &str| {
        let status = if status.is_empty() { "without a modulus" } else { status };
        match left_out.iter_mut().find(|(known, _)| known == status) {
            Some((_, count)) => *count += 1,
            None => left_out.push((status.to_owned(), 1)),
        }
    };
    let mut kept = Vec::new();
    for row in rows.answered {
        // A table of an instrument has no statuses: all of it was measured.
        if all || row.status == Status::Ok.name() || row.status.is_empty() {
            kept.push(row);
        } else {
            leave_out(&row.status);
        }
    }
    for (_, status) in &rows.empty {
        leave_out(status);
    }
    Modulus { rows: kept, left_out, law: None, units: None, is_relative: false, of_law: FactorUnit::Other }
}

fn of_law(file: &Path, rows: &ModulusRows, reads: &mut Reads) -> Result<Modulus, InputError> {
    let place = Place::file(file);
    let refuse = |found: String| InputError::at(&place, "a law.json of frfit fit or frfit identify", found);
    let bytes = load_bytes(file, reads)?;
    let found: Value = serde_json::from_slice(&bytes).map_err(|error| refuse(error.to_string()))?;
    let best = found["best"].as_str().ok_or_else(|| refuse("no law that is best".into()))?;
    let laws = found["laws"].as_array().map_or(&[][..], Vec::as_slice);
    let snippet = laws.iter().find(|law| law["law"] == best).and_then(|law| law["factor"].as_str());
    let snippet = snippet.ok_or_else(|| refuse(format!("no factor of the law {best:?}")))?;
    let law = law_of_snippet(file, snippet)?;
    let mut frequency_hz: Vec<f64> = rows.answered.iter().map(|row| row.frequency_hz).collect();
    frequency_hz.extend(rows.empty.iter().map(|(frequency_hz, _)| frequency_hz));
    frequency_hz.sort_by(f64::total_cmp);
    frequency_hz.dedup();
    let row = |frequency_hz: f64| {
        let e: c64 = law.at(frequency_hz).map_err(|error| refuse(error.to_string()))?;
        let (storage, loss_factor) = (e.re, loss_factor(e));
        Ok(ModulusRow { frequency_hz, storage, loss_factor, std: None, status: "law".into() })
    };
    let rows = frequency_hz.into_iter().map(row).collect::<Result<_, InputError>>()?;
    // A law.json without units is of a version that knew SI only.
    let units = TableUnits::of_json(&found, file)?;
    let of_law = units.map_or(FactorUnit::Modulus(UnitSystem::Si), |units| units.factor);
    let units = units.map(|units| units.system);
    let law = Some(snippet.to_owned());
    Ok(Modulus { rows, left_out: Vec::new(), law, units, is_relative: false, of_law })
}
