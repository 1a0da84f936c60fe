//! Whole jobs: from the path of a case to files in a folder. What the command line and other front ends share.

use crate::error::InputError;
use crate::figures::{identify_figures, respond_figures};
use crate::load::{Case, IdentifyCase, Overrides, Purpose, load};
use crate::memory::{MemoryError, check_full, check_identify};
use crate::output::{
    File, WriteError, candidates_csv, identified_csv, respond_csv, respond_uff, response_csv, summary_json,
    write_all,
};
use crate::run::{IdentifyRun, Progress, RespondRun, RunOptions, identify, respond};
use frfit::material::OutsideTable;
use frfit_figures::PngError;
use std::fmt;
use std::path::Path;
use std::time::Instant;

/// Why a job was not done.
#[derive(Debug)]
pub enum JobError {
    /// The user's input is at fault.
    Input(InputError),
    /// A table of a factor does not reach a frequency of the band.
    OutsideTable(OutsideTable),
    /// The model does not fit into memory.
    Memory(MemoryError),
    /// The output folder cannot be written.
    Write(WriteError),
    /// A figure could not be drawn: a fault of this program.
    Figure(PngError),
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => write!(f, "{error}"),
            Self::OutsideTable(error) => write!(f, "{error}"),
            Self::Memory(error) => write!(f, "{error}"),
            Self::Write(error) => write!(f, "{error}"),
            Self::Figure(error) => write!(f, "a figure could not be drawn: {error}"),
        }
    }
}

impl std::error::Error for JobError {}

macro_rules! from {
    ($($kind:ident($error:ty)),*) => {
        $(impl From<$error> for JobError {
            fn from(error: $error) -> Self {
                Self::$kind(error)
            }
        })*
    };
}

from!(
    Input(InputError),
    OutsideTable(OutsideTable),
    Memory(MemoryError),
    Write(WriteError),
    Figure(PngError)
);

/// An identification that was done and written.
#[derive(Debug)]
pub struct IdentifyJob {
    /// The case.
    pub case: Case,
    /// What came out.
    pub run: IdentifyRun,
    /// `summary.json`.
    pub summary: serde_json::Value,
}

impl IdentifyJob {
    /// The part of the case that was identified.
    pub fn identify(&self) -> Option<&IdentifyCase> {
        self.case.identify.as_ref()
    }
}

/// Loads a case, identifies, and writes tables, figures and summary into `out`: all of them, or nothing.
///
/// # Errors
/// [`JobError`]. Numerical trouble at a frequency is its status, not an error.
pub fn identify_case(
    case_file: &Path,
    overrides: &Overrides,
    options: RunOptions,
    out: &Path,
    progress: Progress<'_>,
) -> Result<IdentifyJob, JobError> {
    let start = Instant::now();
    let case = load(case_file, overrides, Purpose::Identify)?;
    let seconds_load = start.elapsed().as_secs_f64();
    let wanted = case.identify.as_ref().expect("a case loaded to identify has something to identify");
    check_identify(&case, wanted, options.memory_bytes)?;
    let run = identify(&case, wanted, options, progress)?;
    let start = Instant::now();
    let mut files = identify_figures(&case, wanted, &run)?;
    let summary = summary_json(&case, wanted, &run, seconds_load, start.elapsed().as_secs_f64());
    files.push(File::new("identified.csv", identified_csv(&run.outcomes)));
    files.push(File::new("candidates.csv", candidates_csv(&run.outcomes)));
    files.push(File::new("response.csv", response_csv(&case, wanted, &run.outcomes)));
    files.push(File::new("summary.json", format!("{summary:#}\n")));
    write_all(out, &files)?;
    Ok(IdentifyJob { case, run, summary })
}

/// Loads a case, computes its forward response, and writes table, UFF file and figure into `out`.
///
/// # Errors
/// [`JobError`], also where the model does not fit into `memory_bytes`, or without them into what there is. A frequency at which the system cannot be solved has empty cells, not an error.
pub fn respond_case(
    case_file: &Path,
    overrides: &Overrides,
    memory_bytes: Option<u64>,
    out: &Path,
    progress: Progress<'_>,
) -> Result<(Case, RespondRun), JobError> {
    let case = load(case_file, overrides, Purpose::Respond)?;
    check_full(&case, memory_bytes)?;
    let run = respond(&case, progress)?;
    let mut files = respond_figures(&case, &run)?;
    files.push(File::new("response.csv", respond_csv(&case, &run)));
    let uff = respond_uff(&case, &run).map_err(|error| InputError::in_file(&out.join("frf.uff"), error))?;
    files.push(File::new("frf.uff", uff));
    write_all(out, &files)?;
    Ok((case, run))
}
