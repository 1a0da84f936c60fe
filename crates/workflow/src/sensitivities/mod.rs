//! `frfit sensitivities`: what the response depends on, what the sensors identify, and where another one would add most.
//!
//! | file | contents |
//! |---|---|
//! | `run` | the computation |
//! | `ranking` | parameters by the size of their sensitivities |
//! | `words` | combinations of parameters as a person names them |
//! | `report` | what is written to the screen |
//! | `summary` | `sensitivities.json` |
//! | `table` | `sensitivities.csv` |

mod candidates;
mod ranking;
mod report;
mod run;
mod summary;
mod table;
mod words;

pub use candidates::{Candidates, UnknownCandidates};
pub use ranking::{Largest, Ranking};
pub use run::{NextSensor, NoiseFrom, Place, Sensitivity, SensitivityOptions, SensitivityRun, sensitivities};

use crate::figures::sensitivity_figure;
use crate::job_error::JobError;
use crate::load::{Case, Overrides, Purpose, load};
use crate::memory::fit_subspace;
use crate::output::{File, Words, check_folder, write_result};
use frfit_linalg::solve::Breakdown;
use std::path::Path;

/// Sensitivities that were computed and, where a folder was given, written.
#[derive(Debug)]
pub struct SensitivityJob {
    /// The case.
    pub case: Case,
    /// What came out, or why nothing could be solved.
    pub run: Result<SensitivityRun, Breakdown>,
    /// `sensitivities.json`.
    pub summary: serde_json::Value,
    /// The same for a person.
    pub text: Words,
}

/// Loads a case, computes its sensitivities, and writes tables and figure into `out`, where there is one: all of them, or nothing.
///
/// # Errors
/// [`JobError`]. A model that cannot be solved is an outcome, not an error.
pub fn sensitivities_case(
    case_file: &Path,
    overrides: &Overrides,
    options: &SensitivityOptions,
    out: Option<&Path>,
) -> Result<SensitivityJob, JobError> {
    let case = load(case_file, overrides, Purpose::Sensitivities)?;
    if let Some(out) = out {
        check_folder(out, &["sensitivities.json", "sensitivities.csv"], &case.reads)?;
    }
    let job = sensitivities_loaded(case, options)?;
    if let Some(out) = out {
        let SensitivityJob { case, run, summary, .. } = &job;
        let mut files = vec![File::new("sensitivities.json", format!("{summary:#}\n"))];
        if let Ok(run) = run {
            files.push(File::new("sensitivities.csv", table::csv(case, run)));
            files.extend(sensitivity_figure(case, run)?);
        }
        write_result(out, "sensitivities", files, None, &case.reads)?;
    }
    Ok(job)
}

/// The same of a case that was loaded, or made of arrays; nothing is written.
///
/// # Errors
/// As [`sensitivities_case`], but for what is written.
pub fn sensitivities_loaded(
    mut case: Case,
    options: &SensitivityOptions,
) -> Result<SensitivityJob, JobError> {
    fit_subspace(&mut case, 1, options.memory_bytes)?;
    let run = sensitivities(&case, options)?;
    let (summary, text) = match &run {
        Ok(run) => (summary::json(&case, run), report::text(&case, run)),
        Err(breakdown) => (summary::unsolved(&case, breakdown), report::unsolved(&case, breakdown)),
    };
    Ok(SensitivityJob { case, run, summary, text })
}
