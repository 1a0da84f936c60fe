//! What explains a band: a right model, errors of the model, or another model.

use super::band_search::{NEIGHBOURHOOD_TOL, ROUGH_NEIGHBOURHOOD_TOL, Search};
use super::curve::Curves;
use super::error_search::ErrorSearch;
use super::estimated::Estimated;
use super::factor_prior::FactorPrior;
use super::fit::{Explained, RIGHT_MODEL_NATS};
use super::fitting::Fitting;
use super::found::Leverage;
use super::measured::Measured;
use super::small_errors::{About, SmallErrors};
use crate::for_each::ForEach;
use crate::subspace::{Modes, Point, Projection};

/// No material scatters from line to line, and jumps and narrow peaks, which a smooth curve lacks, are rare. Where errors of the model explain a band better than a
/// right model does, a modulus that scatters has to explain it better than they do by so many nats.
const SCATTER_NATS: f64 = 20.0;

/// A model is not right where errors of any size, however small, explain the band better by more nats than this. In 40 cases of right models the most was 1.8.
const CONTRADICTED_NATS: f64 = 2.5;

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
    let data = search.data;
    // Far from the answer a rough model is as good.
    let points: Vec<Point<'_>> = starts.iter().flat_map(|start| search.points(start)).collect();
    let rough = search.smaller(&points, ROUGH_NEIGHBOURHOOD_TOL);
    let given = search.given_factors();
    let right = search.right_from(&rough.0, &starts[0])?;
    let sized = data.given_sizes.any() || search.mesh.is_some();
    if !data.may_be_wrong || (!sized && data.is_exact()) {
        return right_model(search, &right, &given);
    }
    let small = if sized { None } else { Some(small_errors(search, &rough, &right, &given)?) };
    let contradicted = small.map(|small| small.small_nats).filter(|nats| *nats > CONTRADICTED_NATS);
    let is_right = small.is_some_and(|small| small.usual_nats <= -RIGHT_MODEL_NATS);
    let is_noise = || data.is_noise(&right, data.numbers(&search.lines), search.curves);
    if is_right && contradicted.is_none() && is_noise() {
        return right_model(search, &right, &given);
    }
    let errors = ErrorSearch::new(search, starts, &rough);
    let wrong = errors.of_stiffness()?;
    let near = search.smaller(&search.points(&wrong.found.place), NEIGHBOURHOOD_TOL);
    let (wrong, best) = errors.with_further_kinds(&near, wrong);
    let best = best.min(wrong.evidence);
    // The search assumes least sizes of errors. Smaller ones may explain the band better.
    let best = contradicted.map_or(best, |nats| best.min(right.evidence - 2.0 * nats));
    let without_errors = without_errors(search, &right, wrong.level, best);
    let evidence = 0.5 * (without_errors - best);
    if !sized && evidence <= -RIGHT_MODEL_NATS {
        // No material scatters from line to line. Where only that explains the band, and not all of it, it is another model.
        let scatters = without_errors < right.evidence - 2.0 * RIGHT_MODEL_NATS;
        let rest = data.fit.is_none_or(|fit| fit.is_nearly_explained());
        let is_other = scatters && rest;
        return if is_other { Some(Explanation::OtherModel) } else { right_model(search, &right, &given) };
    }
    let fine = Fitting { kinds: wrong.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
    if !fine.are_small(&wrong.found.place) {
        return Some(Explanation::OtherModel);
    }
    // The model is not right, and its errors have no covariance, so that the modulus has no error bars.
    let is_explained = errors.is_explained(&wrong);
    let is_of_modes = |estimated: &Estimated| is_explained || !errors.contradicts_modes(estimated);
    let Some(estimated) = data.posterior(&fine, wrong, evidence).filter(is_of_modes) else {
        return Some(Explanation::OtherModel);
    };
    Some(Explanation::Errors(Box::new(Estimated { modes: search.modes.clone(), ..estimated })))
}

/// A right model, with what is said of known factors in its error bars; `None` where nothing is said of them and curves are not the answer.
fn right_model(search: &Search<'_, '_>, right: &Explained, given: &[FactorPrior]) -> Option<Explanation> {
    if given.is_empty() && !search.data.wants_curves {
        return None;
    }
    let near = search.smaller(&search.points(&right.found.place), NEIGHBOURHOOD_TOL);
    let right = search.right(&near.0, given, right.found.place.clone())?;
    let none = Modes::none(&near.0);
    let fitting = Fitting { factors: given, ..search.fitting(&near.0, &none, &search.lines) };
    let estimated = search.data.posterior(&fitting, right, 0.0)?;
    let modes = Modes::none(search.model);
    Some(Explanation::Errors(Box::new(Estimated { modes, ..estimated })))
}

/// What small errors promise, by a linear model about a right one.
fn small_errors(
    search: &Search<'_, '_>,
    (model, modes): &(Projection, Modes),
    right: &Explained,
    given: &[FactorPrior],
) -> Option<SmallErrors> {
    let whole = search.fitting(model, modes, &search.lines);
    SmallErrors::new(&About::new(search.data, &whole, right, given)?)
}

/// −2 ln of the evidence of a model without errors, whose unknowns may scatter from line to line, beside errors of −2 ln of the evidence `best`. `level` is that of
/// the noise where one sensor cannot show it.
fn without_errors(search: &Search<'_, '_>, right: &Explained, level: f64, best: f64) -> f64 {
    // A modulus that scatters follows whatever errors do to single lines.
    let instead_of_errors = if best < right.evidence { 2.0 * SCATTER_NATS } else { 0.0 };
    let scattered = search.data.scattered(search, right, level);
    scattered.map_or(right.evidence, |scattered| right.evidence.min(scattered + instead_of_errors))
}
