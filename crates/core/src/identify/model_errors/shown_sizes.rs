//! Sizes of errors that the data show: those of largest evidence, by the number of errors that the data determine.

use super::fitting::Fitting;
use super::kinds::Damping;
use super::sizes::{
    CALIBRATION_PRIOR_STD, FREQUENCY_PRIOR_STD, LARGE_FREQUENCY_STD, LARGE_SHAPE_STD, MAX_COMMON_STD,
    MODAL_LOSS_FACTOR_PRIOR_STD, SENSOR_MASS_PRIOR_STD, SHAPE_PRIOR_STD, Sizes, TRENDS, UNDAMPED_SHARE_RATIO,
};

/// By how much bends of a smooth curve may be less or more than the usual ones.
const BEND_RANGE: [f64; 2] = [0.01, 3.0];

/// A size is estimated from the data from this many modes on.
const PRIOR_MODES: f64 = 0.05;

/// The same of a trend, and of one that is larger than what all modes usually have in common: a mesh may err by twice as much, and not by ten times.
const PRIOR_TREND: f64 = 0.5;
const PRIOR_LARGE_TREND: f64 = 8.0;

/// The same of calibrations, that of the force and as a rule few sensors, and of masses at these.
const PRIOR_CALIBRATIONS: f64 = 1.0;

impl Fitting<'_, '_> {
    /// The sizes that the errors at a place show, where those `before` were assumed. `covariance` is that of the coordinates there, n × n.
    pub(super) fn shown_sizes(&self, before: Sizes, place: &[f64], covariance: &[f64]) -> Sizes {
        let bend = [0, 1].map(|part| self.shown_bend(part, before.bend[part], place, covariance));
        let mut sizes = Sizes { bend, ..before };
        if self.shapes().is_empty() {
            return sizes;
        }
        let n = self.count();
        // The size that some errors show; what was known of it counts as so many errors. Sizes s that are `large` have the prior exp(−s²/2 large²).
        let shown = |of: Vec<usize>, size: f64, (prior, count): (f64, f64), large: f64| {
            let squares: f64 = of.iter().map(|&i| (place[i] / self.growth(i)).powi(2)).sum();
            let share = |i: usize| covariance[i * n + i] / (size * self.growth(i)).powi(2);
            let determined: f64 = of.iter().map(|&i| (1.0 - share(i)).clamp(0.0, 1.0)).sum();
            let (squares, count) = (squares + count * prior * prior, determined + count);
            (2.0 * squares / (count + (count * count + 4.0 * squares / (large * large)).sqrt())).sqrt()
        };
        let fresh = |of: Vec<usize>, size: f64, prior: (f64, f64)| shown(of, size, prior, f64::INFINITY);
        let given = self.known.given;
        if given.frequency.is_none() {
            let own = self.elastic(true).collect();
            let prior = (FREQUENCY_PRIOR_STD, PRIOR_MODES);
            sizes.frequency =
                shown(own, sizes.frequency, prior, LARGE_FREQUENCY_STD).min(self.known.most_of_modes);
        }
        if self.kinds.damping == Damping::Own {
            let own = self.elastic(false).collect();
            sizes.loss_factor = fresh(own, sizes.loss_factor, (MODAL_LOSS_FACTOR_PRIOR_STD, PRIOR_MODES));
        }
        if given.shape.is_none() {
            let prior = (SHAPE_PRIOR_STD, PRIOR_MODES);
            sizes.shape = shown(self.shapes().collect(), sizes.shape, prior, LARGE_SHAPE_STD);
        }
        if given.calibration.is_none() {
            let prior = (CALIBRATION_PRIOR_STD, PRIOR_CALIBRATIONS);
            sizes.calibration = fresh(self.gains().collect(), sizes.calibration, prior);
        }
        if self.kinds.masses {
            // A light structure carries a large one: a narrow prior would make other errors and the unknown take a part of it.
            let prior = (SENSOR_MASS_PRIOR_STD, PRIOR_CALIBRATIONS);
            sizes.mass = fresh(self.masses().collect(), sizes.mass, prior);
        }
        sizes = sizes.with_common(self.known);
        if given.frequency.is_none() {
            // The band shows how large trends are. It does not show what all natural frequencies are off by alike: a modulus of another size would do the same.
            // Each trend has a size of its own: with one for all, those of a mesh and of a support grow together until they stand in for such a modulus.
            let usual = sizes.trends;
            let shown_with = |count: f64| -> [f64; TRENDS] {
                std::array::from_fn(|kind| {
                    let prior = (usual[kind], count);
                    usual[kind].max(fresh(self.trend(kind).collect(), before.trends[kind], prior))
                })
            };
            let (there, large) = (shown_with(PRIOR_TREND), shown_with(PRIOR_LARGE_TREND));
            sizes.trends = std::array::from_fn(|kind| there[kind].min(MAX_COMMON_STD.max(large[kind])));
            // A stiffness that shifts all natural frequencies may have no damping, or more than the structure.
            let there = Sizes { trends: there, ..sizes }.usual_trend();
            sizes.common_loss = sizes.common_loss.max(UNDAMPED_SHARE_RATIO * there);
        }
        sizes
    }

    /// How large bends of ln|E|, or of the phase, are over the usual ones, where `before` was assumed.
    fn shown_bend(&self, part: usize, before: f64, place: &[f64], covariance: &[f64]) -> f64 {
        let (bends, count) = self.curves.bends(part);
        let (n, m) = (self.count(), self.curves.count());
        let sum = |of: &dyn Fn(usize, usize) -> f64| -> f64 {
            (0..m * m).map(|k| bends[k] * of(k / m, k % m)).sum()
        };
        let squares = sum(&|i, j| place[i] * place[j]);
        let undetermined = sum(&|i, j| covariance[i * n + j]) / before.powi(2);
        let determined = (count as f64 - undetermined).clamp(0.0, count as f64);
        let [least, most] = BEND_RANGE;
        ((squares + PRIOR_MODES) / (determined + PRIOR_MODES)).sqrt().clamp(least, most)
    }
}
