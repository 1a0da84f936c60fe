//! Where to begin: everything constant over the band, and the logarithms of the responses compared.
//!
//! Near resonances a response is a steep function of what is unknown, and the misfit of responses has a valley for each coincidence of a measured with a computed
//! resonance. Logarithms see how far two curves are apart, not only that they are: valleys are wide.

use super::Task;
use super::coordinates::Coordinates;
use super::reduced_band::{ReducedBand, in_box};
use crate::c64;
use crate::for_each::map;
use crate::identify::thinned::thinned;
use crate::identify::unknown::Variation;
use crate::laws::{Search, minimise};

/// Frequencies at most at which logarithms are compared.
const LOG_RESPONSE_FREQUENCIES: usize = 48;

/// Points of the box for each number, and how many of the best are followed.
const POINTS_PER_NUMBER: usize = 24;
const FOLLOWED_POINTS: usize = 8;

/// Evaluations for each start and number.
const EVALUATIONS_PER_START_AND_NUMBER: usize = 12;

/// Weight of a coordinate's way from the nominal one, beside logarithms of responses: a millionth of what a coordinate that is told moves.
const NOMINAL_WEIGHT: f64 = 1e-3;

/// Ends that are kept: later steps tell which is right.
const MAX_KEPT_ENDS: usize = 4;

impl Task<'_, '_> {
    /// Values of all unknowns, constant over the band, the likeliest first.
    pub(super) fn starts(&self, space: &ReducedBand<'_>) -> Vec<Vec<c64>> {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let which: Vec<usize> = thinned(&all, LOG_RESPONSE_FREQUENCIES).copied().collect();
        let rough = map(self.hooks.for_each, which.len(), |k| space.rough(which[k]));
        let middle = &self.nominal[all.len() / 2];
        let constants =
            Coordinates::new(self.problem.unknowns, |_| Variation::Constant, middle, &self.omegas);
        let of = |values: &[c64]| constants.of(values, |_, _| Vec::new());
        let points =
            (1..=POINTS_PER_NUMBER * constants.count).map(|k| of(&in_box(&space.composite, middle, k)));
        let begin: Vec<Vec<f64>> = std::iter::once(of(middle)).chain(points).collect();
        let evaluate = |theta: &[f64]| {
            let one = |k: usize| {
                let i = which[k];
                let own = constants.each.iter().map(|own| own.value(theta, self.omegas[i]));
                let (values, slopes): (Vec<c64>, Vec<Vec<c64>>) =
                    own.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                let (x, of_values) = space.respond_on(&rough[k], i, &values)?;
                let u = &self.problem.frfs.receptance[i];
                // A zero has no logarithm, and a sensor that is left out no say.
                let kept: Vec<usize> =
                    (0..u.len()).filter(|&m| self.sigma[i][m].is_finite() && u[m].norm() > 0.0).collect();
                let rest: Vec<c64> = kept.iter().map(|&m| (x[m] / u[m]).ln()).collect();
                let column = |(j, slope): (usize, c64)| -> Vec<c64> {
                    kept.iter().map(|&m| of_values[j][m] * slope / x[m]).collect()
                };
                let all =
                    slopes.iter().enumerate().flat_map(|(j, own)| own.iter().map(move |&slope| (j, slope)));
                Some((rest, all.map(column).collect::<Vec<_>>()))
            };
            let rows = map(self.hooks.for_each, which.len(), one).into_iter().collect::<Option<Vec<_>>>()?;
            let parts = |values: &[c64]| values.iter().flat_map(|v| [v.re, v.im]).collect::<Vec<f64>>();
            let count = constants.count;
            // What nothing tells stays where it was.
            let stay = theta.iter().zip(&begin[0]).map(|(t, t0)| NOMINAL_WEIGHT * (t - t0));
            let residuals: Vec<f64> = rows.iter().flat_map(|(rest, _)| parts(rest)).chain(stay).collect();
            let jacobian: Vec<f64> = (0..count)
                .flat_map(|c| {
                    let measured = rows.iter().flat_map(move |(_, columns)| parts(&columns[c]));
                    measured.chain((0..count).map(move |other| if other == c { NOMINAL_WEIGHT } else { 0.0 }))
                })
                .collect();
            let finite = residuals.iter().chain(&jacobian).all(|value| value.is_finite());
            finite.then_some((residuals, jacobian))
        };
        let search =
            Search { starts: FOLLOWED_POINTS, patience: EVALUATIONS_PER_START_AND_NUMBER, same: 0.0 };
        let Some(minima) = minimise(&begin, &evaluate, &search) else { return vec![middle.clone()] };
        let ends = std::iter::once(&minima.best).chain(&minima.others).take(MAX_KEPT_ENDS);
        let values = |theta: &[f64]| {
            let own = constants.each.iter().map(|own| Some(own.value(theta, self.omegas[all.len() / 2])?.0));
            own.collect::<Option<Vec<c64>>>()
        };
        ends.filter_map(|end| values(&end.theta)).collect()
    }
}
