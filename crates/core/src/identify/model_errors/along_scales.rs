//! The best place along the scale of each unknown.

use super::band_search::{NEIGHBOURHOOD_TOL, Search};
use super::fit::{ADDED_NOISE, Explained, FIRST_LEVELS, Fit, RIGHT_MODEL_NATS};
use super::fitting::Fitting;
use crate::subspace::{Modes, Projection};

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
            let are_small = |one: &Explained| whole.are_small(&one.found.place, data.given_sizes);
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
