//! The forward response of a case at its nominal factors.

use super::{Progress, RunError};
use crate::load::Case;
use frfit::c64;
use frfit::response::{FullModel, Response};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The response of a model as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct RespondRun {
    /// Frequencies, as the case lists them.
    pub frequency_hz: Vec<f64>,
    /// Receptance in m/N, \[frequency\]\[sensor\].
    pub receptance: Vec<Vec<c64>>,
}

/// One direct solve a frequency, P-7, on all cores.
///
/// # Errors
/// [`RunError`], naming the frequency at which the system could not be solved.
pub fn respond(case: &Case, progress: Progress<'_>) -> Result<RespondRun, RunError> {
    let done = AtomicUsize::new(0);
    let receptance = case
        .respond_hz
        .par_iter()
        .map(|&frequency_hz| {
            let at = case.model.at(frequency_hz, &[])?;
            let broken = |breakdown| RunError::Breakdown { frequency_hz, breakdown };
            let system = FullModel::new(at, &case.experiment).map_err(broken)?;
            let mut x = system.load().to_vec();
            system.solve_nominal(&mut x).map_err(broken)?;
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, case.respond_hz.len());
            Ok(system.observe(&x))
        })
        .collect::<Result<Vec<_>, RunError>>()?;
    Ok(RespondRun { frequency_hz: case.respond_hz.clone(), receptance })
}
