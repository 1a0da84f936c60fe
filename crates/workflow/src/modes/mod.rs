//! `frfit modes`: natural frequencies, damping and shapes of the model and of what was measured, side by side.
//!
//! | file | contents |
//! |---|---|
//! | `run` | the computation |
//! | `table` | `modes.csv`, `stabilisation.csv`, `correlation.csv` |
//! | `shapes` | `modes.uff` |
//! | `summary` | `modes.json` |
//! | `report` | the words on the screen |

mod report;
mod run;
mod shapes;
mod summary;
mod table;

use run::modes_of;
pub use run::{ModesOptions, ModesRun};

use crate::error::{InputError, Place};
use crate::figures::modes_figures;
use crate::job_error::JobError;
use crate::load::{Case, IdentifyCase, ModesCase, Overrides, Purpose, load};
use crate::memory::check_subspace;
use crate::output::{File, Words, check_folder, write_result};
use frfit::subspace::NaturalModesError;
use frfit_linalg::modes::ModesError;
use serde_json::{Value, json};
use std::path::Path;

/// Modes that were found and, where a folder was given, written.
#[derive(Debug)]
pub struct ModesJob {
    /// The case.
    pub case: Case,
    /// What came out.
    pub run: ModesRun,
    /// `modes.json`.
    pub summary: serde_json::Value,
    /// The same for a person.
    pub text: Words,
}

/// Beyond so many rows the modes of a model cost more than what they show of an identification.
const MAX_ROWS_BESIDE_IDENTIFICATION: usize = 100_000;

/// The model at its nominal factors and what was measured, side by side, of a case that was loaded to be identified; null where the model has no modes that can be found.
pub(crate) fn beside_identification(case: &Case, identify: &IdentifyCase) -> Value {
    if case.model.dim() > MAX_ROWS_BESIDE_IDENTIFICATION {
        return Value::Null;
    }
    let view = ModesCase::of_identification(identify, &case.model);
    let Ok(run) = modes_of(case, &view, &ModesOptions::default()) else { return Value::Null };
    let mut all = summary::json(case, &run);
    let mut kept = |key: &str| all.get_mut(key).map_or(Value::Null, Value::take);
    json!({"model": kept("model"), "measured": kept("measured"), "seconds": kept("seconds")})
}

/// Loads a case, finds the modes of its model and of its measurements, and writes tables and figures into `out`, where there is one: all of them, or nothing.
///
/// # Errors
/// [`JobError`]; a model whose undamped modes cannot be found is an input at fault.
pub fn modes_case(
    case_file: &Path,
    overrides: &Overrides,
    options: &ModesOptions,
    out: Option<&Path>,
) -> Result<ModesJob, JobError> {
    let case = load(case_file, overrides, Purpose::Modes)?;
    if let Some(out) = out {
        check_folder(out, &["modes.json", "modes.csv"], &case.reads)?;
    }
    let job = modes_loaded(case, &Place::file(case_file), options)?;
    if let Some(out) = out {
        let ModesJob { case, run, summary, .. } = &job;
        let shapes = shapes::uff(case, run);
        let shapes = shapes.map_err(|error| InputError::in_file(case_file, error))?;
        let mut files = vec![
            File::new("modes.json", format!("{summary:#}\n")),
            File::new("modes.csv", table::modes(case, run)),
            File::new("modes.uff", shapes),
        ];
        if run.measured.is_some() {
            files.push(File::new("stabilisation.csv", table::stabilisation(run)));
            files.push(File::new("correlation.csv", table::correlation(run)));
        }
        files.extend(modes_figures(case, run)?);
        write_result(out, "modes", files, None, &case.reads)?;
    }
    Ok(job)
}

/// The same of a case that was loaded, or made of arrays, at `place`; nothing is written.
///
/// # Errors
/// As [`modes_case`], but for what is written.
///
/// # Panics
/// Where the case was loaded for something else.
pub fn modes_loaded(case: Case, place: &Place, options: &ModesOptions) -> Result<ModesJob, JobError> {
    // Undamped modes are found with a factor of their own, and counted: single precision might count wrong.
    check_subspace(&case, 2, options.memory_bytes)?;
    let wanted = case.modes.as_ref().expect("a case that was loaded for its modes");
    let run = modes_of(&case, wanted, options).map_err(|error| {
        let expected = match error {
            NaturalModesError::Undamped(ModesError::NotConverged { .. }) => {
                "a band that ends where the model still has modes (--band sets its end)"
            }
            _ => "a real symmetric stiffness and mass whose modes can be found",
        };
        InputError::at(place, expected, error.to_string())
    })?;
    let summary = summary::json(&case, &run);
    let text = report::text(&case, &run);
    Ok(ModesJob { case, run, summary, text })
}
