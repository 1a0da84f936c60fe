//! From a case of several unknowns to what they are.

use super::Progress;
use super::identify::StageClock;
use super::{Seconds, noise_of};
use crate::load::{Case, SeveralCase};
use frfit::identify::{Context, Options, Several, SeveralOutcome, Status, identify_several};
use frfit::material::OutsideTable;
use rayon::prelude::*;

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct SeveralRun {
    /// Everything.
    pub outcome: SeveralOutcome,
    /// How long it took.
    pub seconds: Seconds,
}

impl SeveralRun {
    /// How many frequencies have this status.
    pub fn count(&self, status: Status) -> usize {
        self.outcome.at.iter().filter(|at| at.status == status).count()
    }
}

/// Identifies several unknowns, on all cores; the result does not depend on their number.
///
/// # Errors
/// [`OutsideTable`] where a table of a factor does not reach a frequency.
pub fn several(
    case: &Case,
    wanted: &SeveralCase,
    progress: Progress<'_>,
) -> Result<SeveralRun, OutsideTable> {
    let clock = StageClock::default();
    let band = Several {
        model: &case.model,
        experiment: &case.experiment,
        unknowns: &wanted.unknowns,
        frequency_hz: &wanted.frequency_hz,
        measured: &wanted.measured,
        noise: noise_of(&wanted.noise),
    };
    let hooks = Context {
        for_each: &|n, each| (0..n).into_par_iter().for_each(each),
        progress: &|stage, done, total| {
            clock.enter(Some(stage));
            progress(done, total);
        },
    };
    let outcome = identify_several(&band, &Options::default(), hooks)?;
    Ok(SeveralRun { outcome, seconds: clock.seconds() })
}
