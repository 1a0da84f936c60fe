//! Where solutions are searched: near the nominal, where natural frequencies say, and in the whole of the bounds.

use super::joint::answered_pilots;
use super::neighbourhoods::Neighbourhoods;
use super::outcome::BandOutcome;
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::frfs::standard_deviations;
use crate::identify::choice::{Reduction, Selection};
use crate::identify::context::Context;
use crate::identify::dead_channel::dead_channels;
use crate::identify::far_nominal::{MeasuredShapes, are_stiffnesses};
use crate::identify::measured::Band;
use crate::identify::noise::without;
use crate::identify::options::Options;
use crate::model::ModelAt;
use crate::response::Work;
use crate::subspace::Point;

/// Options of a joint selection on the subspace, whatever the options say.
pub(super) fn on_subspace(options: &Options) -> Options {
    Options { reduction: Reduction::Subspace, selection: Selection::Joint, ..*options }
}

/// Of the frequencies, how many have an answer near a nominal that is not far off.
const USUAL_ANSWERED: f64 = 0.9;

/// What is found near the nominal, and with which options. Where the path leaves out some of the band or does not explain it, the natural frequencies say whether the nominal is
/// far off, and answers are searched near the value where they are the measured ones. Where they do not say and most of the band has no answer, they are
/// searched in the whole of the bounds, or thirty times to either side.
///
/// Of the two the one with more answers is taken, with the work of both; where natural frequencies say so, theirs, unless it has far fewer; without
/// bounds and natural frequencies the far one only where several sensors agree on it.
pub(super) fn near_or_far<'a, 'o, T>(
    (band, at): (&Band<'a>, &'o [ModelAt<'a>]),
    near: &Options,
    reduced: &mut Option<Neighbourhoods<'a, 'o>>,
    are_calibrated: bool,
    context: Context<'_>,
    mut run: impl FnMut(&Options, &mut Option<Neighbourhoods<'a, 'o>>) -> (BandOutcome, T),
) -> (BandOutcome, T, Options) {
    let (found, more) = run(near, reduced);
    if near.selection != Selection::Joint || near.whole_box {
        return (found, more, *near);
    }
    let by_modes = if is_certain(&found) { None } else { far_factor((band, at), near, reduced, context) };
    let far = match by_modes {
        Some(about) => Options { about, ..*near },
        None if 2 * found.answered() < found.lines.len() => Options { whole_box: true, ..*near },
        None => return (found, more, *near),
    };
    let work = |reduced: &Option<Neighbourhoods<'_, '_>>| {
        reduced.as_ref().map_or_else(Work::default, |reduced| reduced.work())
    };
    let before = work(reduced);
    let promises_more = reduced.as_mut().is_none_or(|reduced| {
        let pilots = |options: &Options, reduced: &mut Neighbourhoods<'_, '_>| {
            answered_pilots(band, at, reduced, options, context)
        };
        // Some frequencies over the band are tried in the box that is not as good a guess.
        let near_pilots = if are_calibrated && by_modes.is_none() { pilots(near, reduced) } else { 0 };
        let is_trained = reduced.widen(&far, context).is_ok();
        // Where none of them has an answer, they say nothing.
        is_trained && (near_pilots == 0 || pilots(&far, reduced) > near_pilots)
    });
    let other = promises_more.then(|| run(&far, reduced));
    let spent = other.as_ref().map_or_else(|| work(reduced), |other| other.0.work).since(before);
    // Without bounds and natural frequencies many a wrong value explains a wrong model.
    let is_bounded = band.unknown.bounds.storage.is_some();
    let is_better = |other: &BandOutcome| match by_modes {
        Some(_) => 2 * other.answered() > found.answered(),
        None => other.answered() > found.answered() && (is_bounded || is_certain(other)),
    };
    let better = other.filter(|other| is_better(&other.0));
    let mut both = found.work;
    both += spent;
    match better {
        Some((other, more)) => (BandOutcome { work: both, about: by_modes, ..other }, more, far),
        None => {
            reduced.iter_mut().for_each(|reduced| reduced.look_in(near));
            (BandOutcome { work: both, ..found }, more, *near)
        }
    }
}

/// Whether nearly all frequencies have an answer on which several sensors agree.
fn is_certain(found: &BandOutcome) -> bool {
    let answered = found.answered() as f64 >= USUAL_ANSWERED * found.lines.len() as f64;
    answered && found.fit.is_some_and(|fit| fit.is_explained())
}

/// By which factor the nominal is far off, where natural frequencies say that it is.
fn far_factor<'a, 'o>(
    (band, at): (&Band<'a>, &'o [ModelAt<'a>]),
    options: &Options,
    reduced: &Option<Neighbourhoods<'a, 'o>>,
    context: Context<'_>,
) -> Option<f64> {
    if !are_stiffnesses(band.model, band.unknown.dependence.terms()) {
        return None;
    }
    let own;
    let reduced = match reduced {
        Some(reduced) => reduced,
        // A tiny model that answers itself has no modes at hand: they are those of a reduced one.
        None => {
            own = Neighbourhoods::on_trained(band, at, &mut None, options, context)?;
            &own
        }
    };
    let omegas: Vec<f64> = band.frequency_hz.iter().map(|&f| omega_rad_s(f)).collect();
    let std = without(
        &standard_deviations(band.frequency_hz, band.measured, band.noise),
        &dead_channels(band.measured),
    );
    let measured = (band.measured, std.as_slice());
    let shapes = MeasuredShapes::new(&omegas, measured, band.model.decay_per_s(), context.for_each)?;
    let nominal: Vec<(f64, c64)> = at.iter().map(|at| (at.frequency_hz, at.parameters[0].nominal)).collect();
    let middle = &at[at.len() / 2];
    let point = |factor: f64| {
        Some(Point { at: middle.clone(), correction: middle.parameters[0].nominal * (factor - 1.0) })
    };
    Some(shapes.far(reduced.whole(), &nominal, &point)?.factor)
}
