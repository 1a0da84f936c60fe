//! The computations of a case, frequency by frequency, on all cores.

mod identify;
mod respond;

pub use identify::{ErrorMap, IdentifyRun, RunOptions, Seconds, identify};
pub use respond::{RespondRun, respond};

use frfit::material::OutsideTable;
use frfit_linalg::solve::Breakdown;
use std::fmt;

/// Called after each frequency with how many are done, of how many; from any thread.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Why a run could not be made.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    /// A table of a factor does not reach a frequency of the band.
    OutsideTable(OutsideTable),
    /// A forward response could not be solved at a frequency.
    Breakdown {
        /// The frequency.
        frequency_hz: f64,
        /// Why.
        breakdown: Breakdown,
    },
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideTable(outside) => write!(f, "{outside}"),
            Self::Breakdown { frequency_hz, breakdown } => write!(f, "at {frequency_hz} Hz: {breakdown}"),
        }
    }
}

impl std::error::Error for RunError {}

impl From<OutsideTable> for RunError {
    fn from(outside: OutsideTable) -> Self {
        Self::OutsideTable(outside)
    }
}
