//! What explains a band: a right model, errors of the model, or another model.

use super::band_search::{NEIGHBOURHOOD_TOL, ROUGH_NEIGHBOURHOOD_TOL, Search};
use super::curve::Curves;
use super::estimated::Estimated;
use super::fit::{ADDED_NOISE, Explained, FIRST_LEVELS, Fit, RIGHT_MODEL_NATS};
use super::fitting::{Fitting, Place};
use super::found::Leverage;
use super::kinds::Kinds;
use super::measured::{Measured, SAME_START, distance};
use super::small_errors::{About, SmallErrors};
use crate::for_each::ForEach;
use crate::subspace::{Modes, Point, Projection};

/// The first level of added noise where coordinates were tried one by one: more would let go what was found.
const TUNED_LEVELS: usize = 2;

/// The first level of added noise where only errors of damping and masses are to be found.
const LAST_LEVELS: usize = 5;

/// No material scatters from line to line, and jumps and narrow peaks, which a smooth curve lacks, are rare: where errors of the model explain a band better than a
/// right model does, a modulus that scatters has to explain it better than they do by so many nats.
const SCATTER_NATS: f64 = 20.0;

/// A model is not right where errors of any size, however small, explain the band better by more nats than this. In 40 cases of right models the most was 1.8.
const CONTRADICTED_NATS: f64 = 2.5;

/// Starts with more mismatch over the least of all are far from the answer.
const MAX_MISMATCH_OVER_LEAST: f64 = 1.2;

/// What explains a band.
pub(in crate::identify) enum Explanation {
    /// A right model does as well as one with errors.
    RightModel,
    /// One with small errors.
    Errors(Box<Estimated>),
    /// One whose errors are no small ones: it is another model.
    OtherModel,
}

/// The errors of a model by the data of a band, and how far those of known factors would move the unknowns.
pub(in crate::identify) fn estimate(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    for_each: ForEach<'_>,
) -> (Explanation, Vec<Leverage>) {
    let nothing = || (Explanation::RightModel, Vec::new());
    let starts = data.starts(curves);
    let Some(start) = starts.first() else { return nothing() };
    let centre = curves.straight(start);
    let Some(search) = Search::new(model, data, (curves, &centre), start, for_each) else { return nothing() };
    let search = search.with_meshes(start);
    let explanation = explanation(&search, &starts).unwrap_or(Explanation::RightModel);
    (explanation, search.leverage(start))
}

/// What explains a band; `None` where nothing can be compared.
fn explanation(search: &Search<'_, '_>, starts: &[Vec<f64>]) -> Option<Explanation> {
    let Search { model, data, curves, .. } = *search;
    // Far from the answer a rough model is as good.
    let points: Vec<Point<'_>> = starts.iter().flat_map(|start| search.points(start)).collect();
    let rough = search.smaller(&points, ROUGH_NEIGHBOURHOOD_TOL);
    let given = search.given_factors();
    let start = starts[0].iter().copied().chain(given.iter().map(|_| 0.0)).collect();
    let right = search.right(&rough.0, &given, start)?;
    // What is said of known factors is in the error bars of a right model too.
    let right_model = || -> Option<Explanation> {
        let near = search.smaller(&search.points(&right.found.place), NEIGHBOURHOOD_TOL);
        let right = search.right(&near.0, &given, right.found.place.clone())?;
        let none = Modes::none(&near.0);
        let fitting = Fitting { factors: &given, ..search.fitting(&near.0, &none, &search.lines) };
        let estimated = data.posterior(&fitting, right, 0.0)?;
        let modes = Modes::none(model);
        Some(Explanation::Errors(Box::new(Estimated { modes, ..estimated })))
    };
    let right_model = || if given.is_empty() && !data.wants_curves { None } else { right_model() };
    let whole = search.fitting(&rough.0, &rough.1, &search.lines);
    let sized = data.given_sizes.any() || search.mesh.is_some();
    if !data.may_be_wrong || (!sized && data.is_exact()) {
        return right_model();
    }
    let is_noise = || data.is_noise(&right, data.numbers(&search.lines), curves);
    let about = || About::new(data, &whole, &right, &given);
    let small = if sized { None } else { Some(SmallErrors::new(&about()?)?) };
    let contradicted = small.map(|small| small.small_nats).filter(|nats| *nats > CONTRADICTED_NATS);
    let is_right = small.is_some_and(|small| small.usual_nats <= -RIGHT_MODEL_NATS);
    if is_right && contradicted.is_none() && is_noise() {
        return right_model();
    }
    let coarse = Fitting { free_nodes: false, ..search.fitting(&rough.0, &rough.1, &search.some) };
    let from = |place: Place, kinds: Kinds, from_above: &[f64]| {
        search.near(place, kinds, &|fitting, place| data.explain(fitting, place, from_above))
    };
    let fitted = |places: Vec<Place>, kinds: Kinds| -> Option<Explained> {
        let coarse = Fitting { kinds, ..coarse };
        let ends = places.into_iter().filter_map(|place| data.approach(&coarse, place));
        let (_, place) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        from(place, kinds, &ADDED_NOISE[FIRST_LEVELS..])
    };
    let better = |a: Explained, b: Option<Explained>| match b {
        Some(b) if b.evidence < a.evidence => b,
        _ => a,
    };
    let usual_noise = data.usual_noise();
    let is_explained = |wrong: &Explained| data.is_explained(wrong, &search.lines, usual_noise);
    // Large errors may explain a band as well: those of modes at each other's places.
    let is_found =
        |wrong: &Explained| is_explained(wrong) && whole.are_small(&wrong.found.place, data.given_sizes);
    // Far from the answer damping that is free only hides that a mode is at another frequency, and masses may.
    let at_starts = || starts.iter().map(|start| coarse.start(start)).collect::<Vec<Place>>();
    let mut wrong = fitted(at_starts(), Kinds::STIFFNESS)?;
    let used = |line: usize, sensor: usize| data.sigma[line][sensor].is_finite();
    if !is_found(&wrong) {
        let paired = search.paired(&whole, &curves.straight(&starts[0]), &used);
        let settled: Fit<'_> = &|fitting, place| data.settled_near(fitting, place);
        wrong = better(wrong, paired.and_then(|place| search.near(place, Kinds::STIFFNESS, settled)));
    }
    if !is_found(&wrong) {
        wrong = better(wrong, fitted(at_starts(), Kinds::MASSES));
    }
    if !is_found(&wrong) {
        let stiffness = Fitting { kinds: Kinds::STIFFNESS, free_nodes: false, ..whole };
        let upwards = starts.iter().filter_map(|start| data.upwards(&stiffness, start)).collect();
        wrong = better(wrong, fitted(upwards, Kinds::STIFFNESS));
    }
    let mut scaled: Vec<(f64, Place)> = if is_found(&wrong) {
        Vec::new()
    } else {
        starts.iter().filter_map(|start| whole.scaled(whole.start(&curves.straight(start)), &used)).collect()
    };
    scaled.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = scaled.first().map_or(0.0, |(least, _)| MAX_MISMATCH_OVER_LEAST * least);
    scaled.dedup_by(|a, b| distance(&a.1, &b.1) <= SAME_START);
    for (_, mut place) in scaled.into_iter().filter(|(mismatch, _)| *mismatch <= most) {
        while !is_found(&wrong) {
            let tuned = from(whole.tuned(place, &used)?, Kinds::STIFFNESS, &ADDED_NOISE[TUNED_LEVELS..])?;
            if tuned.evidence > wrong.evidence - 2.0 * RIGHT_MODEL_NATS {
                break;
            }
            place = tuned.found.place.clone();
            wrong = tuned;
        }
    }
    // Errors that the data do not determine stay in the bars: masses and common damping are left out only where they are clearly worse.
    // Damping of single modes can stand in for a loss factor that varies with frequency, so it has to explain the band better.
    type With = fn(Kinds) -> Kinds;
    let further: [(With, f64); 3] = [
        (Kinds::with_masses, RIGHT_MODEL_NATS),
        (Kinds::with_common_damping, RIGHT_MODEL_NATS),
        (Kinds::with_own_damping, 0.0),
    ];
    let near = search.smaller(&search.points(&wrong.found.place), NEIGHBOURHOOD_TOL);
    let fine = search.fitting(&near.0, &near.1, &search.lines);
    // Whether there are errors is asked of the kinds that explain the band best.
    let mut best = wrong.evidence;
    for (with, nats) in further {
        let kinds = with(wrong.kinds);
        if kinds != wrong.kinds {
            let (place, fitting) = (wrong.found.place.clone(), Fitting { kinds, ..fine });
            // A minimum that explains the band is near. From any other one added noise leads away.
            let more = if is_explained(&wrong) {
                let sizes = wrong.sizes.with_kinds(kinds, fine.known);
                fitting.linearised(place).and_then(|at| data.settled(&fitting, at, sizes, wrong.level))
            } else {
                data.explain(&fitting, place, &ADDED_NOISE[LAST_LEVELS..])
            };
            best = more.as_ref().map_or(best, |more| best.min(more.evidence));
            wrong = more.filter(|more| more.evidence < wrong.evidence + 2.0 * nats).unwrap_or(wrong);
        }
    }
    // Where nothing explains the band, elsewhere in the valley is no better place.
    let (near, wrong) = if is_explained(&wrong) { search.along_scales(near, wrong) } else { (near, wrong) };
    best = best.min(wrong.evidence);
    let fine = Fitting { kinds: wrong.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
    // The search assumes least sizes of errors. Smaller ones may explain the band better.
    let best = contradicted.map_or(best, |nats| best.min(right.evidence - 2.0 * nats));
    let scattered = data.scattered(search, &right, wrong.level);
    // A modulus that scatters follows whatever errors do to single lines.
    let instead_of_errors = if best < right.evidence { 2.0 * SCATTER_NATS } else { 0.0 };
    let least =
        scattered.map_or(right.evidence, |scattered| right.evidence.min(scattered + instead_of_errors));
    let evidence = 0.5 * (least - best);
    if !sized && evidence <= -RIGHT_MODEL_NATS {
        // No material scatters from line to line. Where only that explains the band, and not all of it, it is another model.
        let scatters = least < right.evidence - 2.0 * RIGHT_MODEL_NATS;
        let rest = data.fit.is_none_or(|fit| fit.is_nearly_explained());
        return if scatters && rest { Some(Explanation::OtherModel) } else { right_model() };
    }
    if !fine.are_small(&wrong.found.place, data.given_sizes) {
        return Some(Explanation::OtherModel);
    }
    let estimated = data.posterior(&fine, wrong, evidence)?;
    Some(Explanation::Errors(Box::new(Estimated { modes: search.modes.clone(), ..estimated })))
}
