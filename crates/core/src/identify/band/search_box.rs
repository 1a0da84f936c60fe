//! Where solutions are searched: near the nominal, and in the whole of the bounds.

use super::joint::answered_pilots;
use super::neighbourhoods::Neighbourhoods;
use super::outcome::BandOutcome;
use crate::identify::choice::{Reduction, Selection};
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::options::Options;
use crate::model::ModelAt;
use crate::response::Work;

/// Options to look near the nominal, and in the whole of the bounds.
pub(super) fn near_and_far(options: &Options) -> [Options; 2] {
    [*options, Options { whole_box: true, ..*options }]
}

/// The same for a joint selection on the subspace, whatever the options say.
pub(super) fn on_subspace(options: &Options) -> [Options; 2] {
    near_and_far(&Options { reduction: Reduction::Subspace, selection: Selection::Joint, ..*options })
}

/// What is found near the nominal. Where a path through that leaves out most of the band, the nominal is too far and the whole of the bounds is searched too:
/// the one with more answers is taken then, with the work of both.
///
/// The reduced model is made good in the wide box as well. Where channels are calibrated, some frequencies over the band are tried there first, and the rest is
/// left out where no more of them have an answer than near the nominal.
pub(super) fn near_or_far<'a, 'o, T>(
    (band, at): (&Band<'_>, &[ModelAt<'_>]),
    [near, far]: &[Options; 2],
    reduced: &mut Option<Neighbourhoods<'a, 'o>>,
    are_calibrated: bool,
    context: Context<'_>,
    mut run: impl FnMut(&Options, &mut Option<Neighbourhoods<'a, 'o>>) -> (BandOutcome, T),
) -> (BandOutcome, T) {
    let mut found = run(near, reduced);
    let wider =
        near.selection == Selection::Joint && band.unknown.bounds.storage.is_some() && !near.whole_box;
    if !wider || 2 * found.0.answered() >= found.0.lines.len() {
        return found;
    }
    let work = |reduced: &Option<Neighbourhoods<'_, '_>>| {
        reduced.as_ref().map_or_else(Work::default, |reduced| reduced.work())
    };
    let before = work(reduced);
    let promises_more = reduced.as_mut().is_none_or(|reduced| {
        let pilots = |options: &Options, reduced: &mut Neighbourhoods<'_, '_>| {
            answered_pilots(band, at, reduced, options, context)
        };
        let near_pilots = if are_calibrated { pilots(near, reduced) } else { 0 };
        let is_trained = reduced.widen(far, context).is_ok();
        // Where none of them has an answer, they say nothing.
        is_trained && (near_pilots == 0 || pilots(far, reduced) > near_pilots)
    });
    let other = promises_more.then(|| run(far, reduced));
    let spent = other.as_ref().map_or_else(|| work(reduced), |other| other.0.work).since(before);
    let better = other.filter(|other| other.0.answered() > found.0.answered());
    match better {
        Some(better) => {
            let own = std::mem::replace(&mut found, better).0.work;
            found.0.work = own;
        }
        None => reduced.iter_mut().for_each(|reduced| reduced.look_in(near)),
    }
    found.0.work += spent;
    found
}
