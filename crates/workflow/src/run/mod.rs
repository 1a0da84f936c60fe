//! The computations of a case, frequency by frequency, on all cores.

mod identify;
mod respond;

pub use identify::{ErrorMap, IdentifyRun, RunOptions, Seconds, identify};
pub(crate) use identify::{Used, identify_with, problem_of};
pub use respond::{RespondRun, respond};

/// Called before and after each frequency with how many are done, of how many; from any thread. Who unwinds from it cancels.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);
