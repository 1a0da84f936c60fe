//! The best place along the scale of each unknown.

use super::band_search::{NEIGHBOURHOOD_TOL, Search};
use super::descent::Minimum;
use super::fit::{ADDED_NOISE, Explained, FIRST_LEVELS, Fit, RIGHT_MODEL_NATS};
use super::fitting::{Fitting, Place};
use super::prior::NEGLIGIBLE_STD;
use super::sizes::Sizes;
use crate::subspace::{Modes, Projection};
use frfit_linalg::dense::Cholesky;

/// Steps along the scale of an unknown, in its logarithm, and by how much −2 ln of the evidence falls with a step that is taken.
const STEP_ALONG_SCALE: f64 = 0.15;
const MIN_GAIN_ALONG_SCALE: f64 = 1.0;

impl Search<'_, '_> {
    /// The best place along the scale of each smooth unknown. Errors of modes and other unknowns can stand in for that scale: the minimum is a long valley, in which a
    /// search ends where it comes down, with errors that suit there. Elsewhere in the valley the errors are searched anew while the unknowns are held, and then all
    /// together. With a model that is good near the place: the same where that is the same.
    pub(super) fn along_scales(
        &self,
        near: (Projection, Modes),
        mut best: Explained,
    ) -> ((Projection, Modes), Explained) {
        let (data, mut has_moved) = (self.data, false);
        let whole = Fitting { kinds: best.kinds, ..self.fitting(self.model, &self.modes, &self.lines) };
        let from = |best: &Explained, unknown: usize, by: f64| -> Option<Explained> {
            let place = whole.with_scale(&best.found, (unknown, by))?;
            let centre = place[..self.curves.count()].to_vec();
            let searched: Fit<'_> = &|fitting, place| {
                let held = Fitting { held: true, centre: &centre, ..*fitting };
                let errors = data.explain(&held, place, &ADDED_NOISE[FIRST_LEVELS..])?;
                data.settled(fitting, fitting.linearised(errors.found.place)?, errors.sizes, errors.level)
            };
            // Far along it the errors are those of another model, which has to explain the band clearly better.
            let are_small = |one: &Explained| whole.are_small(&one.found.place);
            let gain = if are_small(best) { MIN_GAIN_ALONG_SCALE } else { -2.0 * RIGHT_MODEL_NATS };
            let is_better = |other: &Explained| other.evidence < best.evidence - gain;
            self.near(place, best.kinds, searched).filter(|other| is_better(other) && are_small(other))
        };
        for unknown in self.curves.smooth() {
            for by in [STEP_ALONG_SCALE, -STEP_ALONG_SCALE] {
                while let Some(other) = from(&best, unknown, by) {
                    (best, has_moved) = (other, true);
                }
            }
        }
        let near =
            if has_moved { self.smaller(&self.points(&best.found.place), NEIGHBOURHOOD_TOL) } else { near };
        (near, best)
    }
}

impl Fitting<'_, '_> {
    /// From a minimum to where a smooth unknown as a whole is exp(by) times as large. All else is where it fits best beside that, with errors of usual sizes: of
    /// the mean s = cᵀp of its logarithms at the knots, Δp = C c Δs/(cᵀCc). What all modes have in common stays: together with the other unknowns it
    /// can stand in for any scale.
    fn with_scale(&self, from: &Minimum, (unknown, by): (usize, f64)) -> Option<Place> {
        let n = self.count();
        let usual = Sizes::prior(self.known).of_kinds(self.kinds, self.known);
        let mut whole = from.normal.with_prior(&self.precision(&usual));
        self.in_common(true).for_each(|i| whole[i * n + i] = NEGLIGIBLE_STD.powi(-2));
        let mut mean = vec![0.0; n];
        self.curves.scale(&mut mean, unknown, 1.0);
        let knots: f64 = mean.iter().sum();
        mean.iter_mut().for_each(|share| *share /= knots);
        let mut along = mean.clone();
        Cholesky::new(n, &whole).ok()?.solve(&mut along);
        let variance: f64 = mean.iter().zip(&along).map(|(a, b)| a * b).sum();
        let mut place: Place =
            from.place.iter().zip(&along).map(|(place, along)| place + by / variance * along).collect();
        self.curves.keep_within_bounds(&mut place);
        Some(place)
    }
}
