//! The forward response of a case at its nominal factors.

use super::Progress;
use crate::load::Case;
use frfit::c64;
use frfit::material::OutsideTable;
use frfit::response::{FullModel, Response};
use frfit_linalg::solve::Breakdown;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The response of a model as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct RespondRun {
    /// Frequencies, as the case lists them.
    pub frequency_hz: Vec<f64>,
    /// Receptance in m/N, \[frequency\]\[sensor\], or why the system could not be solved there.
    pub receptance: Vec<Result<Vec<c64>, Breakdown>>,
}

impl RespondRun {
    /// The frequencies at which the system could not be solved, with the reason.
    pub fn unsolved(&self) -> Vec<String> {
        let rows = self.frequency_hz.iter().zip(&self.receptance);
        rows.filter_map(|(frequency_hz, x)| Some(format!("at {frequency_hz} Hz {}", x.as_ref().err()?)))
            .collect()
    }
}

/// One direct solve a frequency, P-7, on all cores.
///
/// # Errors
/// [`OutsideTable`] where a table of a factor does not reach a frequency.
pub fn respond(case: &Case, progress: Progress<'_>) -> Result<RespondRun, OutsideTable> {
    let done = AtomicUsize::new(0);
    let at_frequency = |&frequency_hz: &f64| {
        // Before the work too: who cancels by unwinding from here is not to wait for what has not begun.
        progress(done.load(Ordering::Relaxed), case.respond_hz.len());
        let at = case.model.at(frequency_hz, &[])?;
        let receptance = FullModel::new(at, &case.experiment).and_then(|system| system.respond_nominal());
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, case.respond_hz.len());
        Ok(receptance)
    };
    let receptance =
        case.respond_hz.par_iter().map(at_frequency).collect::<Result<Vec<_>, OutsideTable>>()?;
    Ok(RespondRun { frequency_hz: case.respond_hz.clone(), receptance })
}
