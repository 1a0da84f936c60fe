//! From a case to the line at every frequency of its band.

use super::{IN_PARALLEL, Progress};
use crate::load::{Case, IdentifyCase, MeasuredNoise};
use frfit::c64;
use frfit::frequency::bands_hz;
use frfit::identify::{
    Context, Frfs, Identification, Line, Method, Noise, Problem, ProblemError, ReducedBand, SmoothCurve,
    Stage, Status, error_by_order, identify_on,
};
use frfit::material::OutsideTable;
use frfit::response::FullModel;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// What a run does beside identifying.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RunOptions {
    /// At how many frequencies of the band the error is mapped over the orders, each order a direct solve.
    /// `None`: 60 up to 300 degrees of freedom, 30 up to 5000, and none above, where it would cost more than the identification.
    pub error_map: Option<usize>,
    /// Bytes of memory that may be used. `None`: what the system says is available.
    pub memory_bytes: Option<u64>,
    /// A file for the reduced model as the run leaves it, for other runs.
    pub keep_reduced: Option<PathBuf>,
}

/// ε over frequency and order: the paper's Figs 3, 8 and 12.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// Some of the band's frequencies.
    pub frequency_hz: Vec<f64>,
    /// ε after order k + 1 at frequency i is `error[i][k]`; `None` where that order has no root.
    pub error: Vec<Vec<Option<f64>>>,
}

/// Wall-clock seconds of each stage.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Seconds {
    /// Reading the files.
    pub load: f64,
    /// Looking for what is wrong with the data.
    pub check: f64,
    /// Training of the subspace.
    pub subspace: f64,
    /// Solutions at every frequency.
    pub solutions: f64,
    /// The choice among them.
    pub selection: f64,
    /// Laws.
    pub laws: f64,
    /// The error map.
    pub error_map: f64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifyRun {
    /// The identification; its lines are all measured frequencies of the band, ascending.
    pub found: Identification,
    /// The error map, where one was made. Its work is not in that of the identification.
    pub error_map: Option<ErrorMap>,
    /// How long it took.
    pub seconds: Seconds,
}

/// Columns of the error map where none are asked for.
fn map_columns(dofs: usize) -> usize {
    match dofs {
        0..=300 => 60,
        301..=5000 => 30,
        _ => 0,
    }
}

/// Identifies over the case's band, on all cores and on a reduced model that is shared with the check of the case; the result does not depend on the number of cores.
///
/// # Errors
/// [`ProblemError`] where the case has a fault that was not seen when it was loaded. Numerical trouble is a status of its frequency, never an error.
pub(crate) fn identify_with<'a>(
    reduced: &mut ReducedBand<'a>,
    problem: &'a Problem<'a>,
    case: &Case,
    identify: &IdentifyCase,
    (options, progress): (&RunOptions, Progress<'_>),
) -> Result<IdentifyRun, ProblemError> {
    let clock = StageClock::default();
    let last = (AtomicUsize::new(0), AtomicUsize::new(problem.frfs().frequency_hz.len()));
    let context = Context {
        for_each: &|n, each| {
            (0..n).into_par_iter().for_each(|i| {
                // Who cancels by unwinding from here is not to wait for what has not begun.
                progress(last.0.load(Ordering::Relaxed), last.1.load(Ordering::Relaxed));
                each(i);
            });
        },
        progress: &|stage, done, total| {
            clock.enter(Some(stage));
            last.0.store(done, Ordering::Relaxed);
            last.1.store(total, Ordering::Relaxed);
            progress(done, total);
        },
    };
    let mut found = identify_on(reduced, problem, &identify.options, context)?;
    found.lines = Used::among_all(identify, found.lines)?;
    found.free = if found.free.is_empty() { found.free } else { Used::among_all(identify, found.free)? };
    if let Some(curve) = &found.curve {
        bridge(&mut found.lines, curve, identify);
    }
    let mut seconds = clock.seconds();
    let start = Instant::now();
    let error_map = error_map(case, identify, options)?;
    seconds.error_map = start.elapsed().as_secs_f64();
    Ok(IdentifyRun { found, error_map, seconds })
}

/// The smooth modulus at the frequencies that were left out: their status stays, as nothing was measured there that counts.
fn bridge(lines: &mut [Line], curve: &SmoothCurve, identify: &IdentifyCase) {
    let out = |i: &usize| identify.left_out[*i] && identify.frequency_hz[*i] > 0.0;
    let out: Vec<usize> = (0..lines.len()).filter(out).collect();
    let frequency_hz: Vec<f64> = out.iter().map(|&i| identify.frequency_hz[i]).collect();
    for (&i, (factor, bars)) in out.iter().zip(curve.bridged(&frequency_hz)) {
        let value = &mut lines[i].values[0];
        (value.value, value.correction) = (Some(factor), Some(factor - value.nominal));
        value.uncertainty = Some(bars);
    }
}

/// What is not left out of a band.
pub(crate) struct Used {
    frequency_hz: Vec<f64>,
    measured: Vec<Vec<c64>>,
    noise: MeasuredNoise,
}

impl Used {
    pub(crate) fn of(identify: &IdentifyCase) -> Self {
        let rows = |all: &[Vec<f64>]| kept(all, identify).cloned().collect();
        Self {
            frequency_hz: kept(&identify.frequency_hz, identify).copied().collect(),
            measured: kept(&identify.measured, identify).cloned().collect(),
            noise: match &identify.noise {
                MeasuredNoise::Unknown => MeasuredNoise::Unknown,
                MeasuredNoise::Relative(std) => MeasuredNoise::Relative(rows(std)),
                MeasuredNoise::Known(std) => MeasuredNoise::Known(rows(std)),
            },
        }
    }

    /// One line for each measured frequency of the band, `out_of_band` where it is left out.
    fn among_all(identify: &IdentifyCase, lines: Vec<Line>) -> Result<Vec<Line>, OutsideTable> {
        let mut lines = lines.into_iter();
        let all = identify.frequency_hz.iter().zip(&identify.left_out);
        let mut whole = Vec::with_capacity(identify.frequency_hz.len());
        for (&frequency_hz, &out) in all {
            if out {
                let nominal = identify.unknowns.iter().map(|unknown| unknown.nominal.at(frequency_hz));
                whole.push(Line::out_of_band(frequency_hz, &nominal.collect::<Result<Vec<_>, _>>()?));
            } else {
                whole.extend(lines.next());
            }
        }
        Ok(whole)
    }
}

/// Those rows of a table over the band that are not left out.
fn kept<'i, T>(rows: &'i [T], identify: &'i IdentifyCase) -> impl Iterator<Item = &'i T> {
    rows.iter().zip(&identify.left_out).filter(|(_, out)| !**out).map(|(row, _)| row)
}

/// A case's band as the library takes it.
pub(crate) fn problem_of<'a>(
    case: &'a Case,
    identify: &'a IdentifyCase,
    used: &'a Used,
) -> Result<Problem<'a>, ProblemError> {
    let frfs =
        Frfs { frequency_hz: &used.frequency_hz, receptance: &used.measured, noise: noise_of(&used.noise) };
    let problem = Problem::new(&case.model, &case.experiment, &identify.unknowns, &identify.channels, frfs)?;
    match &case.coarser_mesh {
        Some(mesh) => problem.with_coarser_mesh(mesh),
        None => Ok(problem),
    }
}

/// The reduced model that was trained already, where the case comes with one; else one that will be.
pub(crate) fn reduced_of<'a>(
    case: &Case,
    identify: &IdentifyCase,
    problem: &'a Problem<'a>,
) -> Result<ReducedBand<'a>, ProblemError> {
    match &case.reduced {
        Some(kept) => ReducedBand::of_kept(kept, problem, &identify.options, IN_PARALLEL),
        None => Ok(ReducedBand::default()),
    }
}

/// How well it was measured, as core takes it.
pub(crate) fn noise_of(noise: &MeasuredNoise) -> Noise<'_> {
    match noise {
        MeasuredNoise::Unknown => Noise::Unknown,
        MeasuredNoise::Relative(std) => Noise::Relative(std),
        MeasuredNoise::Known(std) => Noise::Known(std),
    }
}

/// Wall-clock time by stage: each lasts until another is heard of.
struct StageClock(Mutex<(Seconds, Option<Stage>, Instant)>);

impl Default for StageClock {
    fn default() -> Self {
        Self(Mutex::new((Seconds::default(), None, Instant::now())))
    }
}

impl StageClock {
    fn enter(&self, next: Option<Stage>) {
        // A thread that panicked with the lock takes the run down with it: the clock is beside the point.
        let mut guard = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (seconds, current, since) = &mut *guard;
        if *current == next {
            return;
        }
        let now = Instant::now();
        let elapsed = now.duration_since(*since).as_secs_f64();
        match current {
            Some(Stage::Subspace) => seconds.subspace += elapsed,
            Some(Stage::Solutions) => seconds.solutions += elapsed,
            Some(Stage::Selection) => seconds.selection += elapsed,
            Some(Stage::Law) => seconds.laws += elapsed,
            Some(_) | None => {}
        }
        (*current, *since) = (next, now);
    }

    fn seconds(&self) -> Seconds {
        self.enter(None);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).0
    }
}

impl Seconds {
    /// Of the identification: neither what comes before it nor the error map.
    pub fn identify(&self) -> f64 {
        self.subspace + self.solutions + self.selection + self.laws
    }
}

fn error_map(
    case: &Case,
    identify: &IdentifyCase,
    options: &RunOptions,
) -> Result<Option<ErrorMap>, OutsideTable> {
    let affordable = map_columns(case.model.dim());
    let used: Vec<usize> = (0..identify.frequency_hz.len()).filter(|&i| !identify.left_out[i]).collect();
    let columns = options.error_map.unwrap_or(affordable).min(used.len());
    let parameter = identify.unknowns[0].parameter();
    let Some(parameter) = parameter.filter(|_| columns > 0 && identify.options.method == Method::Series)
    else {
        return Ok(None);
    };
    let last = used.len() - 1;
    let picked: Vec<usize> = (0..columns).map(|k| used[k * last / (columns - 1).max(1)]).collect();
    let error = picked
        .par_iter()
        .map(|&i| {
            let at = case.model.at(identify.frequency_hz[i], std::slice::from_ref(&parameter))?;
            let none = || vec![None; identify.options.order];
            let Ok(system) = FullModel::new(at, &case.experiment) else { return Ok(none()) };
            let by_order =
                error_by_order(&system, &identify.measured[i], &identify.unknowns[0], &identify.options);
            Ok(by_order.unwrap_or_else(|_| none()))
        })
        .collect::<Result<Vec<_>, OutsideTable>>()?;
    let frequency_hz = picked.iter().map(|&i| identify.frequency_hz[i]).collect();
    Ok(Some(ErrorMap { frequency_hz, error }))
}

impl IdentifyRun {
    /// How many frequencies have this status.
    pub fn count(&self, status: Status) -> usize {
        self.found.count(status)
    }

    /// What was measured at a frequency, as receptance, with the scales and delays that were found.
    pub fn measured(&self, frequency_hz: f64, receptance: &[c64]) -> Vec<c64> {
        receptance.iter().enumerate().map(|(m, &u)| self.measured_by(m, frequency_hz, u)).collect()
    }

    /// The same of one sensor.
    pub fn measured_by(&self, sensor: usize, frequency_hz: f64, receptance: c64) -> c64 {
        self.found
            .channels
            .get(sensor)
            .map_or(receptance, |channel| channel.factor(frequency_hz) * receptance)
    }

    /// The bands [first, last] in Hz of neighbouring frequencies with this status.
    pub fn bands_hz(&self, status: Status) -> Vec<[f64; 2]> {
        bands_hz(self.found.lines.iter().map(|line| (line.frequency_hz, line.status == status)))
    }
}
