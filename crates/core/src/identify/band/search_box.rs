//! Where solutions are looked for: near the nominal, and in the whole of the bounds.

use super::outcome::BandOutcome;
use super::reduced_band::ReducedBand;
use crate::identify::choice::{Reduction, Selection};
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::options::Options;
use crate::response::Work;

/// Options to look near the nominal, and in the whole of the bounds.
pub(super) fn near_and_far(options: &Options) -> [Options; 2] {
    [*options, Options { whole_box: true, ..*options }]
}

/// The same for a joint selection on the subspace, whatever the options say.
pub(super) fn on_subspace(options: &Options) -> [Options; 2] {
    near_and_far(&Options { reduction: Reduction::Subspace, selection: Selection::Joint, ..*options })
}

/// What is found near the nominal; where a path through that leaves out most of the band, the nominal is too far, and the bounds are all that is left:
/// the one with more answers then, with the work of both. The reduced model has the whole of the bounds then, and first some frequencies say whether
/// more is to be expected there: `pilots` is how many of them have an answer, or none where that is not known.
pub(super) fn near_or_far<'a, 'o, T>(
    band: &Band<'_>,
    [near, far]: &[Options; 2],
    reduced: &mut Option<ReducedBand<'a, 'o>>,
    context: Context<'_>,
    pilots: impl Fn(&Options, &mut ReducedBand<'a, 'o>) -> usize,
    mut run: impl FnMut(&Options, &mut Option<ReducedBand<'a, 'o>>) -> (BandOutcome, T),
) -> (BandOutcome, T) {
    let mut found = run(near, reduced);
    let wider =
        near.selection == Selection::Joint && band.unknown.bounds.storage.is_some() && !near.whole_box;
    if !wider || 2 * found.0.answered() >= found.0.outcomes.len() {
        return found;
    }
    let mut before = Work::default();
    let is_worth_it = match reduced {
        Some(reduced) => {
            let near_pilots = pilots(near, reduced);
            before = reduced.work();
            let trained = reduced.widen(far, context);
            trained.is_ok() && (near_pilots == 0 || pilots(far, reduced) > near_pilots)
        }
        None => true,
    };
    let mut is_far = false;
    if is_worth_it {
        let mut other = run(far, reduced);
        is_far = other.0.answered() > found.0.answered();
        other.0.work = other.0.work.since(before);
        if is_far {
            std::mem::swap(&mut found, &mut other);
        }
        found.0.work += other.0.work;
    } else if let Some(reduced) = reduced {
        found.0.work += reduced.work().since(before);
    }
    if let Some(reduced) = reduced.as_mut().filter(|_| !is_far) {
        reduced.look_in(near);
    }
    found
}
