//! Whole jobs: from the path of a case to files in a folder. What the command line and other front ends share.

use crate::check::{check_on, findings_json, others_json};
use crate::convert::{OR_TO, ending_of};
use crate::error::{InputError, Place};
use crate::figures::{identify_figures, measured_figures, respond_figures};
pub use crate::job_error::JobError;
use crate::load::{Case, Check, IdentifyCase, Overrides, Purpose, load};
use crate::memory::{fit_full, fit_identify};
use crate::modes::beside_identification;
use crate::output::{
    File, IDENTIFIED, Words, candidates_csv, check_file, check_folder, error_map_csv, identified_csv,
    impact_reasons, is_stream, measured_csv, measured_summary, measured_text, measured_uff, reference_csv,
    respond_csv, respond_uff, response_csv, summary_json, updated_uff, write_one, write_result,
};
use crate::records::{ChannelOptions, Records, read_records};
use crate::reduced::reduced_file;
use crate::report::report_of;
use crate::run::{
    IN_PARALLEL, IdentifyRun, Progress, RespondRun, RunOptions, Used, identify_with, problem_of, reduced_of,
    respond,
};
use frfit::diagnostics::{Depth, Diagnosis};
use frfit::identify::Explained;
use frfit::response::Work;
use frfit::signal::{self, Measured, SignalError, estimate_frf};
use frfit::subspace::KeptSubspace;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The files of an identification, beside its figures.
const IDENTIFIED_FILES: [&str; 11] = [
    "identified.csv",
    "candidates.csv",
    "reference.csv",
    "response.csv",
    "free.csv",
    "law.json",
    "error_map.csv",
    "updated.uff",
    "summary.json",
    "identify-manifest.json",
    "report.html",
];

/// An identification that was done and written.
#[derive(Debug)]
pub struct IdentifyJob {
    /// The case.
    pub case: Case,
    /// What is wrong with the data; `None` where the case says `check = false`.
    pub diagnosis: Option<Diagnosis>,
    /// What came out.
    pub run: IdentifyRun,
    /// `summary.json`.
    pub summary: Value,
}

impl IdentifyJob {
    /// The part of the case that was identified.
    pub fn identify(&self) -> Option<&IdentifyCase> {
        self.case.identify.as_ref()
    }
}

/// Loads a case, looks for what is wrong with its data, identifies, and writes tables, figures, summary and report into `out`: all of them, or nothing.
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
    check_folder(out, &IDENTIFIED_FILES, &case.reads)?;
    let computed = compute(case, options, seconds_load, progress)?;
    let (files, summary) = result_files(&computed, Pictures::of(&computed)?, out)?;
    let Computed { case, diagnosis, run } = computed;
    let page = report_of(&files, out);
    write_result(out, IDENTIFIED, files, page.as_ref().ok().cloned(), &case.reads)?;
    page.map_err(JobError::Report)?;
    Ok(IdentifyJob { case, diagnosis, run, summary })
}

/// What a person looks at beside the tables.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    figures: Vec<File>,
    /// Modes of model and measurement, which show what may be wrong where the band is not explained.
    modes: Value,
    seconds: f64,
}

impl Pictures {
    fn of(computed: &Computed) -> Result<Self, JobError> {
        let Computed { case, run, .. } = computed;
        let start = Instant::now();
        let wanted = case.identify.as_ref().expect("a case loaded to identify has something to identify");
        let figures = identify_figures(case, wanted, run)?;
        let seconds = start.elapsed().as_secs_f64();
        let unexplained = run.found.fit.is_some_and(|fit| fit.verdict == Explained::No);
        let modes = if unexplained { beside_identification(case, wanted) } else { Value::Null };
        Ok(Self { figures, modes, seconds })
    }
}

/// The files of an identification beside its page: figures, tables, response and summary. `place` is where they will be.
pub(crate) fn result_files(
    computed: &Computed,
    pictures: Pictures,
    place: &Path,
) -> Result<(Vec<File>, Value), JobError> {
    let Computed { case, diagnosis, run } = computed;
    let wanted = case.identify.as_ref().expect("a case loaded to identify has something to identify");
    let mut files = pictures.figures;
    let found = &run.found;
    let mut summary = summary_json(case, wanted, run, pictures.seconds);
    summary["findings"] = diagnosis.as_ref().map_or(Value::Null, |d| findings_json(case, d));
    summary["other_explanations"] = diagnosis.as_ref().map_or(Value::Null, |d| others_json(case, d));
    summary["modes"] = pictures.modes;
    let mut tables = vec![
        File::new("identified.csv", identified_csv(wanted, &found.lines)),
        File::new("candidates.csv", candidates_csv(wanted, &found.lines)),
        File::new("reference.csv", reference_csv(wanted, &found.lines)),
        File::new("response.csv", response_csv(case, wanted, run)),
    ];
    if !found.free.is_empty() {
        tables.push(File::new("free.csv", identified_csv(wanted, &found.free)));
    }
    if let Some(map) = &run.error_map {
        tables.push(File::new("error_map.csv", error_map_csv(map)));
    }
    if wanted.is_law() {
        files.push(File::new("law.json", format!("{:#}\n", summary["laws"])));
    }
    // Beside them a folder may have tables of other runs.
    summary["tables"] = tables.iter().map(|table| table.path.display().to_string()).collect();
    files.extend(tables);
    let uff =
        updated_uff(case, run).map_err(|error| InputError::in_file(&place.join("updated.uff"), error))?;
    files.push(File::new("updated.uff", uff));
    files.push(File::new("summary.json", format!("{summary:#}\n")));
    Ok((files, summary))
}

/// An identification that was done, and not written.
#[derive(Debug)]
pub struct Computed {
    /// The case.
    pub case: Case,
    /// What is wrong with the data; `None` where the case says `check = false`.
    pub diagnosis: Option<Diagnosis>,
    /// What came out.
    pub run: IdentifyRun,
}

/// [`identify_case`] without its files, but for a reduced model that is to be kept: the numbers are the same.
///
/// # Errors
/// As [`identify_case`], but for what is written.
pub fn compute_case(
    case_file: &Path,
    overrides: &Overrides,
    options: RunOptions,
    progress: Progress<'_>,
) -> Result<Computed, JobError> {
    let start = Instant::now();
    let case = load(case_file, overrides, Purpose::Identify)?;
    let seconds_load = start.elapsed().as_secs_f64();
    compute(case, options, seconds_load, progress)
}

/// The same for a case that was loaded, or made of arrays.
///
/// # Errors
/// As [`compute_case`], and where the case has nothing to identify.
pub fn compute(
    mut case: Case,
    options: RunOptions,
    seconds_load: f64,
    progress: Progress<'_>,
) -> Result<Computed, JobError> {
    fit_identify(&mut case, options.memory_bytes)?;
    let Some(wanted) = &case.identify else {
        return Err(InputError::at(&Place::option("case"), "something to identify", "none").into());
    };
    if let Some(file) = &options.keep_reduced {
        check_file(file, &case.reads)?;
    }
    let used = Used::of(wanted);
    let problem = problem_of(&case, wanted, &used)?;
    // One reduced model answers for the check and the identification.
    let mut reduced = reduced_of(&case, wanted, &problem)?;
    let mut seconds_check = 0.0;
    let mut check = |reduced: &mut _| {
        let start = Instant::now();
        let diagnosis = check_on(reduced, Depth::Quick, &problem, &case, wanted);
        seconds_check += start.elapsed().as_secs_f64();
        diagnosis
    };
    let mut diagnosis = match wanted.check {
        Check::First => Some(check(&mut reduced)?),
        Check::IfUnexplained | Check::Never => None,
    };
    let mut run = identify_with(&mut reduced, &problem, &case, wanted, (&options, progress))?;
    let unexplained = run.found.fit.is_some_and(|fit| fit.verdict == Explained::No);
    if wanted.check == Check::IfUnexplained && unexplained {
        diagnosis = Some(check(&mut reduced)?);
    }
    if let Some((file, kept)) = options.keep_reduced.as_ref().zip(reduced.kept()) {
        write_reduced(file, &kept, &case)?;
    }
    (run.seconds.load, run.seconds.check) = (seconds_load, seconds_check);
    Ok(Computed { case, diagnosis, run })
}

fn write_reduced(file: &Path, kept: &KeptSubspace, case: &Case) -> Result<usize, JobError> {
    let bytes = reduced_file(kept, &case.model, &case.experiment);
    let bytes = bytes.map_err(|error| InputError::in_file(file, error))?;
    let count = bytes.len();
    write_one(file, bytes, &case.reads)?;
    Ok(count)
}

/// A reduced model that was trained and written.
#[derive(Debug)]
pub struct TrainJob {
    /// The case.
    pub case: Case,
    /// Its vectors.
    pub vectors: usize,
    /// Factorisations and solves of the training.
    pub work: Work,
    /// Bytes of the file.
    pub bytes: usize,
    /// How long the training took.
    pub seconds: f64,
}

impl TrainJob {
    /// What `frfit train --json` prints.
    pub fn json(&self) -> Value {
        json!({
            "dofs": self.case.model.dim(),
            "vectors": self.vectors,
            "factorisations": self.work.factorisations,
            "solves": self.work.solves,
            "bytes": self.bytes,
            "seconds": self.seconds,
        })
    }
}

/// Loads a case, trains the reduced model for its band and the box of its unknowns, and writes it.
///
/// # Errors
/// [`JobError`], also where no real stand-in for the dynamic stiffness can be factorised.
pub fn train_case(
    case_file: &Path,
    overrides: &Overrides,
    memory_bytes: Option<u64>,
    out: &Path,
) -> Result<TrainJob, JobError> {
    let mut case = load(case_file, overrides, Purpose::Train)?;
    check_file(out, &case.reads)?;
    fit_identify(&mut case, memory_bytes)?;
    let Some(wanted) = &case.identify else {
        return Err(InputError::at(&Place::file(case_file), "something to identify", "none").into());
    };
    let start = Instant::now();
    let used = Used::of(wanted);
    let problem = problem_of(&case, wanted, &used)?;
    let mut reduced = reduced_of(&case, wanted, &problem)?;
    reduced.train_for(&problem, &wanted.options, IN_PARALLEL)?;
    let seconds = start.elapsed().as_secs_f64();
    let Some(kept) = reduced.kept() else {
        let expected = "a stiffness that can be factorised, with some of the mass or at the last frequency";
        return Err(InputError::at(&Place::file(case_file), expected, "a singular one").into());
    };
    let (work, vectors) = (reduced.work(), kept.size());
    // The factors are not needed any more, and the file takes as much memory as the vectors.
    drop(reduced);
    let bytes = write_reduced(out, &kept, &case)?;
    Ok(TrainJob { case, vectors, work, bytes, seconds })
}

/// Loads a case, computes its forward response, and writes table, UFF file and figure into `out`, where there is one.
///
/// # Errors
/// [`JobError`], also where the model does not fit into `memory_bytes`, or without them into what there is. A frequency at which the system cannot be solved has empty cells, not an error.
pub fn respond_case(
    case_file: &Path,
    overrides: &Overrides,
    memory_bytes: Option<u64>,
    out: Option<&Path>,
    progress: Progress<'_>,
) -> Result<(Case, RespondRun), JobError> {
    let mut case = load(case_file, overrides, Purpose::Respond)?;
    if let Some(out) = out {
        check_folder(out, &["response.csv", "frf.uff"], &case.reads)?;
    }
    fit_full(&mut case, memory_bytes)?;
    let run = respond(&case, progress)?;
    let Some(out) = out else { return Ok((case, run)) };
    let mut files = respond_figures(&case, &run)?;
    files.push(File::new("response.csv", respond_csv(&case, &run)));
    let uff = respond_uff(&case, &run).map_err(|error| InputError::in_file(&out.join("frf.uff"), error))?;
    files.push(File::new("frf.uff", uff));
    write_result(out, "respond", files, None, &case.reads)?;
    Ok((case, run))
}

/// A hammer test that was evaluated and written.
#[derive(Debug)]
pub struct FrfJob {
    /// What was read.
    pub records: Records,
    /// What came out.
    pub measured: Measured,
    /// `<name>-summary.json`.
    pub summary: Value,
    /// The same for a person.
    pub text: Words,
}

/// Reads the records of a hammer test and writes its FRF as UFF or table, by the ending `to`, or else that of `out`, with
/// `<name>-summary.json` and `<name>-figures/` beside it: all of them, or nothing. Beside what is no plain file (`-`, which is standard output, a device, a
/// pipe) there is nothing.
///
/// # Errors
/// [`JobError`]: what [`read_records`] refuses, no impact without fault, an ending that is neither, several responses for a table.
pub fn frf_of_records(
    files: &[PathBuf],
    channels: &ChannelOptions,
    options: &signal::Options,
    out: &Path,
    to: Option<&str>,
) -> Result<FrfJob, JobError> {
    let (place, ending) = ending_of(out, to);
    let is_table = match ending.as_deref() {
        Some("csv") => true,
        Some("uff" | "unv" | "uf") => false,
        found => {
            let found = found.map_or("none".into(), |ending| format!(".{ending}"));
            let expected =
                format!("an ending that names a format: .uff, .unv or .uf (UFF), .csv (table){OR_TO}");
            return Err(InputError::at(&place, expected, found).into());
        }
    };
    let records = read_records(files, channels)?;
    let name = out.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = out.parent().unwrap_or(Path::new(""));
    check_file(out, &records.reads)?;
    if !is_stream(out) {
        check_folder(
            folder,
            &[&format!("{name}-summary.json"), &format!("{name}-manifest.json")],
            &records.reads,
        )?;
    }
    if is_table && records.responses.len() > 1 {
        let expected = "one response for a table (--response), or the ending .uff";
        return Err(InputError::at(&Place::file(out), expected, records.responses.len().to_string()).into());
    }
    let measured =
        estimate_frf(&records.recordings, options).map_err(|error| refusal(error, &records, files))?;
    let summary = measured_summary(&records, &measured, options);
    let bytes = match is_table {
        true => measured_csv(&measured).into_bytes(),
        false => measured_uff(&records, &measured, &title(files))
            .map_err(|error| InputError::in_file(out, error))?,
    };
    if is_stream(out) {
        write_one(out, bytes, &records.reads)?;
    } else {
        let mut written = measured_figures(&records, &measured, &format!("{name}-figures"))?;
        written.push(File::new(format!("{name}-summary.json"), format!("{summary:#}\n")));
        written.push(File::new(out.file_name().unwrap_or_default(), bytes));
        write_result(folder, &name, written, None, &records.reads)?;
    }
    let text = measured_text(&records, &measured, options);
    Ok(FrfJob { records, measured, summary, text })
}

/// The names of the files.
fn title(files: &[PathBuf]) -> String {
    let names = files.iter().filter_map(|file| file.file_name());
    names.map(|name| name.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Where to put right what is wrong with the records or the options.
fn refusal(error: SignalError, records: &Records, files: &[PathBuf]) -> InputError {
    let file = |k: usize| records.origins.get(k).or(files.first()).map_or(Path::new(""), PathBuf::as_path);
    match error {
        SignalError::Options(error) => {
            let place = Place::option(&format!("--{}", error.name.replace('_', "-")));
            InputError::at(&place, error.expected, error.found.to_string())
        }
        SignalError::Recording(k, error) => {
            let found = format!("in its recordings: {error}");
            InputError::at(&Place::file(file(k)), "recordings that fit together", found)
        }
        SignalError::NoSuchImpact(number, count) => {
            InputError::at(&Place::option("--keep"), format!("impacts from 1 to {count}"), number.to_string())
        }
        SignalError::NoImpact(impacts) => {
            let reasons = impact_reasons(records, &impacts);
            InputError::at(&Place::file(file(0)), "an impact without fault", format!("none: {reasons}"))
        }
        other => InputError::at(&Place::file(file(0)), "records of a hammer test", other.to_string()),
    }
}
