//! From a case to the outcome at every frequency of its band.

use super::Progress;
use crate::load::{Case, IdentifyCase};
use frfit::frequency::bands_hz;
use frfit::identify::{Identified, Status, error_by_order, identify_at};
use frfit::material::OutsideTable;
use frfit::response::{FullModel, Work};
use frfit::{c64, identify};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// What a run does beside identifying.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RunOptions {
    /// At how many frequencies of the band the error is mapped over the orders, each order a direct solve.
    /// `None`: 60 up to 300 degrees of freedom, 30 up to 5000, and none above, where it would cost more than the identification.
    pub error_map: Option<usize>,
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
    /// Identification over the band.
    pub identify: f64,
    /// The error map.
    pub error_map: f64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifyRun {
    /// One outcome a frequency, ascending.
    pub outcomes: Vec<Identified>,
    /// The error map, where one was made.
    pub error_map: Option<ErrorMap>,
    /// All work of the identification; that of the error map is not in it.
    pub work: Work,
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

/// Identifies at every frequency of the case's band; frequencies are independent and run on all cores.
///
/// The result does not depend on the number of cores.
///
/// # Errors
/// [`OutsideTable`] where a table of a factor does not reach a frequency. Numerical trouble is a status of its frequency, never an error.
pub fn identify(
    case: &Case,
    identify: &IdentifyCase,
    options: RunOptions,
    progress: Progress<'_>,
) -> Result<IdentifyRun, OutsideTable> {
    let start = Instant::now();
    let done = AtomicUsize::new(0);
    let outcomes = (0..identify.frequency_hz.len())
        .into_par_iter()
        .map(|i| {
            let outcome = at_frequency(case, identify, i)?;
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, identify.frequency_hz.len());
            Ok(outcome)
        })
        .collect::<Result<Vec<Identified>, OutsideTable>>()?;
    let mut work = Work::default();
    outcomes.iter().for_each(|outcome| work += outcome.work);
    let mut seconds = Seconds { identify: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let start = Instant::now();
    let error_map = error_map(case, identify, options)?;
    seconds.error_map = start.elapsed().as_secs_f64();
    Ok(IdentifyRun { outcomes, error_map, work, seconds })
}

fn at_frequency(case: &Case, identify: &IdentifyCase, i: usize) -> Result<Identified, OutsideTable> {
    let at = case.model.at(identify.frequency_hz[i], std::slice::from_ref(&identify.parameter))?;
    let nominal = at.parameters[0].nominal;
    Ok(match FullModel::new(at, &case.experiment) {
        Ok(system) => identify_at(&system, &identify.measured[i], &identify.options),
        Err(breakdown) => {
            Identified::broken(identify.frequency_hz[i], nominal, identify.options.order, breakdown)
        }
    })
}

fn error_map(
    case: &Case,
    identify: &IdentifyCase,
    options: RunOptions,
) -> Result<Option<ErrorMap>, OutsideTable> {
    let affordable = map_columns(case.model.dim());
    let columns = options.error_map.unwrap_or(affordable).min(identify.frequency_hz.len());
    if columns == 0 || identify.options.method != identify::Method::Series {
        return Ok(None);
    }
    let last = identify.frequency_hz.len() - 1;
    let picked: Vec<usize> = (0..columns).map(|k| k * last / (columns - 1).max(1)).collect();
    let error = picked
        .par_iter()
        .map(|&i| {
            let at = case.model.at(identify.frequency_hz[i], std::slice::from_ref(&identify.parameter))?;
            let none = || vec![None; identify.options.order];
            let Ok(system) = FullModel::new(at, &case.experiment) else { return Ok(none()) };
            let by_order = error_by_order(&system, &identify.measured[i], &identify.options);
            Ok(by_order.unwrap_or_else(|_| none()))
        })
        .collect::<Result<Vec<_>, OutsideTable>>()?;
    let frequency_hz = picked.iter().map(|&i| identify.frequency_hz[i]).collect();
    Ok(Some(ErrorMap { frequency_hz, error }))
}

impl IdentifyRun {
    /// How many frequencies have this status.
    pub fn count(&self, status: Status) -> usize {
        self.outcomes.iter().filter(|outcome| outcome.status == status).count()
    }

    /// The bands [first, last] in Hz of neighbouring frequencies with this status.
    pub fn bands_hz(&self, status: Status) -> Vec<[f64; 2]> {
        bands_hz(self.outcomes.iter().map(|outcome| (outcome.frequency_hz, outcome.status == status)))
    }

    /// Whether each frequency's updated factor is the truth to a relative tolerance; `None` where no truth is known.
    pub fn right(&self, truth: impl Fn(f64) -> Option<c64>, tolerance: f64) -> Option<Vec<bool>> {
        self.outcomes
            .iter()
            .map(|outcome| {
                let truth = truth(outcome.frequency_hz)?;
                let close = |factor: c64| (factor - truth).norm() <= tolerance * truth.norm();
                Some(outcome.factor().is_some_and(close))
            })
            .collect()
    }
}
