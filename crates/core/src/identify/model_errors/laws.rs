//! Errors of a model whose unknowns follow laws.

use super::band_search::{NEIGHBOURHOOD_TOL, ROUGH_NEIGHBOURHOOD_TOL, Search};
use super::curve::Curves;
use super::estimated::Estimated;
use super::explanation::{Explanation, estimate};
use super::fit::{ADDED_NOISE, FIRST_LEVELS};
use super::fitting::{Fitting, Place};
use super::measured::Measured;
use crate::for_each::ForEach;
use crate::subspace::Projection;

/// The errors of a model by the data of a band whose unknown follows a law, where a right model explains the band with a smooth modulus (`smooth`) and not with
/// the law at θ (`curves`). `None` unless they and the law are likelier than that smooth modulus.
pub(in crate::identify) fn estimate_beside_a_smooth_modulus(
    model: &Projection,
    data: &Measured<'_, '_>,
    (smooth, curves): (&Curves, &Curves),
    theta: &[f64],
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let of_smooth = evidence_of_right_model(model, data, smooth, &data.starts(smooth), for_each)?;
    // A law does not scatter from line to line.
    let given = [theta.to_vec()];
    let data = &Measured { given: &given, own: &[], ..*data };
    let of_law = evidence_of_right_model(model, data, curves, &given, for_each)?;
    match estimate(model, data, curves, for_each).0 {
        Explanation::Errors(errors) if 2.0 * errors.evidence > of_law - of_smooth => Some(*errors),
        _ => None,
    }
}

/// −2 ln of the evidence of a right model.
fn evidence_of_right_model(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    starts: &[Vec<f64>],
    for_each: ForEach<'_>,
) -> Option<f64> {
    let start = starts.first()?;
    let centre = curves.straight(start);
    let search = Search::new(model, data, (curves, &centre), start, for_each)?;
    let (near, _) = search.smaller(&search.points(start), ROUGH_NEIGHBOURHOOD_TOL);
    Some(search.right_from(&near, start)?.evidence)
}

/// The errors of a model once more, with laws in place of smooth curves: they say more of what the errors are. Of several places to begin with
/// that of largest evidence; `None` where these errors are no small ones.
pub(in crate::identify) fn estimate_with_laws(
    model: &Projection,
    data: &Measured<'_, '_>,
    before: &Estimated,
    curves: &Curves,
    starts: &[Vec<f64>],
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let each = starts.iter().filter_map(|theta| {
        let search = Search {
            modes: before.modes.in_larger(model),
            factors: before.factors.clone(),
            mesh: before.mesh.clone(),
            ..Search::new(model, data, (curves, theta), theta, for_each)?
        };
        let near = search.smaller(&search.points(theta), NEIGHBOURHOOD_TOL);
        let fitting = Fitting { kinds: before.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
        let place: Place = theta.iter().chain(&before.place[before.curves.count()..]).copied().collect();
        let found = data.explain(&fitting, place, &ADDED_NOISE[FIRST_LEVELS..])?;
        Some((search, near, found))
    });
    let (search, near, found) = each.min_by(|a, b| a.2.evidence.total_cmp(&b.2.evidence))?;
    let fitting = Fitting { kinds: before.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
    if !fitting.are_small(&found.found.place) {
        return None;
    }
    let estimated = data.posterior(&fitting, found, before.evidence)?;
    Some(Estimated { modes: search.modes.clone(), ..estimated })
}
