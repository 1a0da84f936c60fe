//! Where solutions are looked for: near the nominal, and in the whole of the bounds.

use super::outcome::BandOutcome;
use crate::identify::choice::{Reduction, Selection};
use crate::identify::measured::Band;
use crate::identify::options::Options;

/// Options to look near the nominal, and in the whole of the bounds.
pub(super) fn near_and_far(options: &Options) -> [Options; 2] {
    [*options, Options { whole_box: true, ..*options }]
}

/// The same for a joint selection on the subspace, whatever the options say.
pub(super) fn on_subspace(options: &Options) -> [Options; 2] {
    near_and_far(&Options { reduction: Reduction::Subspace, selection: Selection::Joint, ..*options })
}

/// What is found near the nominal; where a path through that leaves out most of the band, the nominal is too far, and the bounds are all that is left:
/// the one with more answers then, with the work of both.
pub(super) fn near_or_far<'o, T>(
    band: &Band<'_>,
    [near, far]: &'o [Options; 2],
    mut run: impl FnMut(&'o Options) -> (BandOutcome, T),
) -> (BandOutcome, T) {
    let mut found = run(near);
    let wider =
        near.selection == Selection::Joint && band.unknown.bounds.storage.is_some() && !near.whole_box;
    if wider && 2 * found.0.answered() < found.0.outcomes.len() {
        let mut other = run(far);
        if other.0.answered() > found.0.answered() {
            std::mem::swap(&mut found, &mut other);
        }
        found.0.work += other.0.work;
    }
    found
}
