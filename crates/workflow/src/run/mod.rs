//! The computations of a case, frequency by frequency, on all cores.

mod identify;
mod respond;

pub use identify::{ErrorMap, IdentifyRun, RunOptions, Seconds};
pub(crate) use identify::{Used, identify_with, noise_of, problem_of, reduced_of};
pub use respond::{RespondRun, respond};

use frfit::identify::Context;
use rayon::prelude::*;

/// Stack of a thread that does whole jobs, that of the main thread of most systems: dissections recurse.
pub const STACK_BYTES: usize = 8 << 20;

/// All pieces at once, on all cores: how core's work is done.
pub(crate) fn in_parallel(n: usize, each: &(dyn Fn(usize) + Sync)) {
    (0..n).into_par_iter().for_each(each);
}

/// The same, without progress.
pub(crate) const IN_PARALLEL: Context<'static> = Context { for_each: &in_parallel, progress: &|_, _, _| {} };

/// Called before and after each frequency with how many are done, of how many; from any thread. Who unwinds from it cancels.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);
