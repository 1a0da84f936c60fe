//! Laws fitted to a table of moduli.

use crate::error::{InputError, Place};
use crate::figures::law_figures;
use crate::job_error::JobError;
use crate::load::load_bytes;
use crate::output::{File, Misfit, check_folder, law_json, laws_text, write_result};
use crate::reads::Reads;
use crate::terminal::short;
use crate::units::{FactorUnit, TableUnits, UnitSystem};
use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::laws::{Datum, LawFit, LawKind, best, fit_modulus};
use frfit_formats::csv::{ModulusData, read_modulus_data, read_modulus_data_where};
use serde_json::{Value, json};
use std::path::Path;

/// Laws that were fitted to a table.
#[derive(Debug)]
pub struct FitJob {
    /// What was read.
    pub data: ModulusData,
    /// One for each law with fewer parameters than there are numbers.
    pub fits: Vec<LawFit>,
    /// `law.json`.
    pub summary: Value,
    /// The same for a person.
    pub text: String,
}

/// Fits laws, each once and all where none is named, to a table of moduli, or of it the rows with a value in a column (`only`), and writes `law.json` and a figure into `out`, if there is one: all of them, or nothing.
///
/// With columns `storage_std` and `loss_factor_std` χ² is in their units; without them every modulus counts relative to its size, and the scatter about the law gives
/// the standard deviations.
///
/// # Errors
/// [`JobError`]: what [`read_modulus_data`] refuses, no law with fewer parameters than numbers, an output folder that cannot be written.
pub fn fit_table(
    table: &Path,
    only: Option<(&str, &str)>,
    kinds: &[LawKind],
    out: Option<&Path>,
) -> Result<FitJob, JobError> {
    let mut reads = Reads::default();
    let bytes = load_bytes(table, &mut reads)?;
    if let Some(out) = out {
        check_folder(out, &["law.json"], &reads)?;
    }
    let read = match only {
        Some((column, value)) => read_modulus_data_where(&bytes, column, value),
        None => read_modulus_data(&bytes),
    };
    let data = read.map_err(|error| InputError::in_file(table, error))?;
    let of = match TableUnits::beside(table, None)? {
        // A table that names its unit was converted to Pa.
        Some(units) if !data.names_unit => units,
        _ => TableUnits { system: UnitSystem::Si, factor: FactorUnit::Modulus(UnitSystem::Si) },
    };
    let mut wanted: Vec<LawKind> = Vec::new();
    for &kind in if kinds.is_empty() { &LawKind::ALL } else { kinds } {
        if !wanted.contains(&kind) {
            wanted.push(kind);
        }
    }
    let points = points(&data);
    let fits: Vec<LawFit> =
        wanted.iter().filter_map(|&family| fit_modulus(&points, family, data.std.is_some())).collect();
    if fits.is_empty() {
        let least = wanted.iter().map(|family| family.count()).min().unwrap_or(0);
        let expected = format!("at least {} moduli, for {least} parameters", least.div_ceil(2));
        return Err(InputError::at(&Place::file(table), expected, data.storage.len().to_string()).into());
    }
    let misfits: Vec<Option<Misfit>> = fits.iter().map(|fit| misfit(fit, &data)).collect();
    let summary = summary(table, &data, &fits, &misfits, of);
    let name = table.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(out) = out {
        let mut files = law_figures(&format!("{name}: laws of the modulus"), &data, &fits, of.factor)?;
        files.push(File::new("law.json", format!("{summary:#}\n")));
        write_result(out, "fit", files, None, &reads)?;
    }
    let text = format!("{}\n{}", heading(&name, &data), laws_text(&fits, &misfits, of.factor));
    Ok(FitJob { data, fits, summary, text })
}

fn points(data: &ModulusData) -> Vec<Datum> {
    let values = data.frequency_hz.iter().zip(data.storage.iter().zip(&data.loss_factor)).enumerate();
    values
        .map(|(i, (&f, (&storage, &eta)))| match &data.std {
            // What identifies a modulus gives no correlation of its parts in a table.
            Some(std) => Datum::storage_and_loss(f, [storage, eta], std[i], 0.0),
            None => Datum::relative(omega_rad_s(f), c64::new(storage, storage * eta)),
        })
        .collect()
}

/// |E_law − E|/|E| over the table.
fn misfit(fit: &LawFit, data: &ModulusData) -> Option<Misfit> {
    let rows = data.frequency_hz.iter().zip(data.storage.iter().zip(&data.loss_factor));
    let relative = |(&f, (&storage, &eta)): (&f64, (&f64, &f64))| {
        let modulus = c64::new(storage, storage * eta);
        Some((fit.at(f)?.modulus - modulus).norm() / modulus.norm())
    };
    Misfit::of(rows.map(relative).collect::<Option<_>>()?)
}

fn summary(
    table: &Path,
    data: &ModulusData,
    fits: &[LawFit],
    misfits: &[Option<Misfit>],
    of: TableUnits,
) -> Value {
    let laws = fits.iter().zip(misfits).map(|(fit, misfit)| {
        let mut law = law_json(fit, of.factor);
        law["misfit"] = json!({"worst": misfit.map(|m| m.worst), "median": misfit.map(|m| m.median)});
        law
    });
    json!({
        "frfit": env!("CARGO_PKG_VERSION"),
        "table": table.display().to_string(),
        "units": of.system.json(),
        "factor_unit": of.factor.word(),
        "moduli": data.storage.len(),
        "left_out": data.left_out,
        "range_hz": [data.frequency_hz.first(), data.frequency_hz.last()],
        "criterion": "bic",
        "best": best(fits).map(|fit| fit.kind.to_string()),
        "laws": laws.collect::<Vec<_>>(),
    })
}

fn heading(name: &str, data: &ModulusData) -> String {
    let (first, last) = (data.frequency_hz[0], data.frequency_hz[data.frequency_hz.len() - 1]);
    let left_out = match data.left_out {
        0 => String::new(),
        count => format!(", {count} rows left out"),
    };
    let weights = match &data.std {
        Some(_) => "weighted by their standard deviations",
        None => "weighted by their size",
    };
    let (first, last) = (short(first), short(last));
    format!("{name}: {} moduli, {first} to {last} Hz{left_out}, {weights}", data.storage.len())
}
