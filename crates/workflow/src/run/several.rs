//! From a case of several unknowns to what they are.

use super::Progress;
use super::identify::StageClock;
use super::{IdentifyRun, noise_of};
use crate::load::{Case, SeveralCase};
use frfit::identify::{Context, Frfs, Options, Problem, ProblemError};
use rayon::prelude::*;

/// Identifies several unknowns, on all cores; the result does not depend on their number.
///
/// # Errors
/// [`ProblemError`] where the case has a fault that was not seen when it was loaded.
pub fn several(
    case: &Case,
    wanted: &SeveralCase,
    progress: Progress<'_>,
) -> Result<IdentifyRun, ProblemError> {
    let clock = StageClock::default();
    let frfs = Frfs {
        frequency_hz: &wanted.frequency_hz,
        receptance: &wanted.measured,
        noise: noise_of(&wanted.noise),
    };
    let problem = Problem::new(&case.model, &case.experiment, &wanted.unknowns, &[], frfs)?;
    let hooks = Context {
        for_each: &|n, each| (0..n).into_par_iter().for_each(each),
        progress: &|stage, done, total| {
            clock.enter(Some(stage));
            progress(done, total);
        },
    };
    let found = frfit::identify::identify(&problem, &Options::default(), hooks)?;
    Ok(IdentifyRun { found, error_map: None, seconds: clock.seconds() })
}
