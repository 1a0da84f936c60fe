//! Fits: the least squares at levels of the noise, and the sizes of largest evidence.

use super::curve::Curves;
use super::descent::Minimum;
use super::fitting::{Fitting, Place};
use super::kinds::Kinds;
use super::linearised::Linearised;
use super::measured::{MAX_REST, MIN_NOISE_OVER_RESPONSE, Measured, NOISE_CHI_SQUARED_STD, is_chance};
use super::sizes::Sizes;
use super::whitening::{Rest, Whitening};
use crate::thinned::thinned;
use frfit_linalg::dense::Cholesky;

/// A fit at a level of the noise.
pub(super) struct Explained {
    pub(super) found: Minimum,
    pub(super) sizes: Sizes,
    pub(super) kinds: Kinds,
    pub(super) level: f64,
    /// What the response has beside noise and errors.
    pub(super) rest: Rest,
    /// −2 ln of the evidence, up to what all explanations share.
    pub(super) evidence: f64,
}

/// A fit from a place.
pub(super) type Fit<'f> = &'f dyn Fn(&Fitting<'_, '_>, Place) -> Option<Explained>;

/// Noise that is added to begin with, relative to the response.
pub(super) const ADDED_NOISE: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// Levels of added noise until all lines are used.
pub(super) const FIRST_LEVELS: usize = 4;

/// Lines on which a search begins.
pub(super) const FIRST_LINES: usize = 60;

/// Stages in which a band is gone through upwards, noise that is added at each, and steps.
const MAX_STAGES: usize = 8;
const ADDED_STAGE_NOISE: [f64; 2] = [1.0, 0.2];
const STAGE_STEPS: usize = 3;

/// Steps at each level of the noise, and at the last.
const STEPS_PER_LEVEL: usize = 5;
pub(super) const STEPS_AT_LAST_LEVEL: usize = 15;

/// Rounds at most in which sizes and errors are estimated in turn. They end earlier where −2 ln of the evidence changes by less than this from one to the next.
const MAX_SIZE_ROUNDS: usize = 8;
const EVIDENCE_TOL: f64 = 0.2;

/// The same as [`MIN_NOISE_OVER_RESPONSE`] of a single sensor, whose noise is not given: it cannot contradict itself.
const MIN_NOISE_OF_ONE_SENSOR: f64 = 5e-3;

/// A right model is one only where it explains a band by so many nats better: before the data errors are a hundred times as likely as none, and where
/// the data cannot decide, they are in the bars.
pub(super) const RIGHT_MODEL_NATS: f64 = 5.0;

impl Measured<'_, '_> {
    /// From a start to where all lines are used: the cost and the place.
    pub(super) fn approach(&self, coarse: &Fitting<'_, '_>, place: Place) -> Option<(f64, Place)> {
        let precision = coarse.precision(&Sizes::prior(coarse.known));
        let own = if self.known() { 1.0 } else { 0.0 };
        let (mut at, mut end) = (coarse.linearised(place)?, None);
        for added in &ADDED_NOISE[..FIRST_LEVELS] {
            let noise = self.noise_at(coarse.lines, own, *added);
            let (found, near) = coarse.descend(at, &noise, &precision, STEPS_PER_LEVEL)?;
            at = near;
            end = Some((found.normal.chi_squared + found.prior, found.place));
        }
        end
    }

    /// From a start to where lines are used from the lowest on, mode after mode: where a mode is off by many half-widths it has no slope towards
    /// its place, and the modes below it say where that is.
    pub(super) fn upwards(&self, whole: &Fitting<'_, '_>, start: &[f64]) -> Option<Place> {
        let precision = whole.precision(&Sizes::prior(whole.known));
        let own = if self.known() { 1.0 } else { 0.0 };
        let mut place = whole.start(start);
        for below in whole.stages(MAX_STAGES) {
            let lines: Vec<usize> = thinned(below, FIRST_LINES).copied().collect();
            let stage = Fitting { lines: &lines, ..*whole };
            let mut at = stage.linearised(place)?;
            for added in ADDED_STAGE_NOISE {
                let noise = self.noise_at(&lines, own, added);
                at = stage.descend(at, &noise, &precision, STAGE_STEPS)?.1;
            }
            place = at.place;
        }
        Some(place)
    }

    /// The least squares with the noise approached from above, and the sizes of largest evidence.
    pub(super) fn explain(
        &self,
        fitting: &Fitting<'_, '_>,
        place: Place,
        from_above: &[f64],
    ) -> Option<Explained> {
        let known = self.known();
        let sizes = Sizes::prior(fitting.known).of_kinds(fitting.kinds, fitting.known);
        let numbers = self.numbers(fitting.lines) as f64;
        let (mut at, mut level, mut rest) = (fitting.linearised(place)?, 1.0, Rest::NONE);
        for &added in from_above {
            let noise = self.noise_at(fitting.lines, if known { 1.0 } else { 0.0 }, added);
            let (found, near) = fitting.descend(at, &noise, &fitting.precision(&sizes), STEPS_PER_LEVEL)?;
            at = near;
            // What is left is larger than what would come next: with less noise, errors would only follow it.
            let left = (found.normal.chi_squared / numbers).sqrt();
            if !known {
                level = added * left.max(1.0);
            }
            if left > 1.0 {
                rest = Rest { std: added.min(MAX_REST), ..Rest::NONE };
                break;
            }
        }
        self.settled(fitting, at, sizes, (level, rest))
    }

    /// The same from a place that is near, with the noise that it leaves: more would let go what was found.
    pub(super) fn settled_near(&self, fitting: &Fitting<'_, '_>, place: Place) -> Option<Explained> {
        self.settled_with(fitting, place, Sizes::prior(fitting.known))
    }

    /// The same with these sizes to begin with.
    pub(super) fn settled_with(
        &self,
        fitting: &Fitting<'_, '_>,
        place: Place,
        sizes: Sizes,
    ) -> Option<Explained> {
        let sizes = sizes.of_kinds(fitting.kinds, fitting.known);
        let at = fitting.linearised(place)?;
        let (residuals, numbers) = (at.residuals(), self.numbers(fitting.lines) as f64);
        let begin = if self.known() {
            (1.0, self.rest(fitting.lines, &residuals, numbers))
        } else {
            let sigma = fitting.lines.iter().map(|&line| self.sigma[line].clone()).collect();
            let left = Whitening::of_noise(sigma).chi_squared(&residuals) / numbers;
            (left.sqrt().max(MIN_NOISE_OVER_RESPONSE), Rest::NONE)
        };
        self.settled(fitting, at, sizes, begin)
    }

    /// The least squares near a place, with the noise and the sizes of largest evidence: those to begin with are nearly right.
    pub(super) fn settled(
        &self,
        fitting: &Fitting<'_, '_>,
        mut at: Linearised,
        mut sizes: Sizes,
        (mut level, mut rest): (f64, Rest),
    ) -> Option<Explained> {
        let known = self.known();
        let numbers = self.numbers(fitting.lines) as f64;
        // A right model has no such part.
        let has_rest = known && !fitting.shapes().is_empty();
        rest = if has_rest { rest } else { Rest::NONE };
        let mut last = None;
        for _ in 0..MAX_SIZE_ROUNDS {
            let whitening = self.noise_and_rest(fitting.lines, level, rest);
            let precision = fitting.precision(&sizes);
            let found;
            (found, at) = fitting.descend(at, &whitening, &precision, STEPS_AT_LAST_LEVEL)?;
            let (n, place) = (fitting.count(), &at.place);
            let whole = found.normal.with_prior(&precision);
            let factor = Cholesky::new(n, &whole).ok()?;
            let inverse = factor.inverse();
            let variance = |i: usize| inverse[i * n + i];
            let of_prior = Cholesky::new(n, &precision).ok()?.log_determinant();
            let misfit = whitening.log_determinant() + found.normal.chi_squared + found.prior;
            let evidence = misfit + factor.log_determinant() - of_prior + sizes.improbability();
            let determined: f64 =
                (0..n).map(|i| 1.0 - precision[i * n + i] * variance(i)).map(|t| t.clamp(0.0, 1.0)).sum();
            let chi_squared = found.normal.chi_squared;
            let before = (level, sizes, rest);
            if has_rest {
                rest = self.rest(fitting.lines, &at.residuals(), (numbers - determined).max(1.0));
            }
            let same = last
                .as_ref()
                .is_some_and(|last: &Explained| (last.evidence - evidence).abs() <= EVIDENCE_TOL);
            last = Some(Explained { found, sizes, kinds: fitting.kinds, level, rest: before.2, evidence });
            if same {
                break;
            }
            if !known {
                level = (level * (chi_squared / (numbers - determined).max(1.0)).sqrt())
                    .max(MIN_NOISE_OVER_RESPONSE);
            }
            sizes = fitting.shown_sizes(sizes, place, &inverse);
            let settled = |a: f64, b: f64| (a - b).abs() <= 0.03 * b;
            if settled(level, before.0)
                && (rest.std - before.2.std).abs() <= 0.03 * rest.std
                && rest.length_rad_s == before.2.length_rad_s
                && settled(sizes.frequency, before.1.frequency)
                && settled(sizes.loss_factor, before.1.loss_factor)
                && settled(sizes.shape, before.1.shape)
                && (0..2).all(|part| (sizes.bend[part] / before.1.bend[part] - 1.0).abs() < 0.2)
            {
                break;
            }
        }
        last
    }

    /// Whether the residual is noise: of the given size, or of the usual size.
    pub(super) fn is_explained(&self, wrong: &Explained, lines: &[usize], usual_noise: f64) -> bool {
        let n = self.numbers(lines) as f64;
        match self.known() {
            true => wrong.rest == Rest::NONE && is_chance(wrong.found.normal.chi_squared, n),
            false => wrong.level <= usual_noise,
        }
    }

    /// Whether noise is all that a smooth modulus leaves.
    pub(super) fn is_noise(&self, right: &Explained, numbers: usize, curves: &Curves) -> bool {
        let n = numbers as f64;
        match self.known() {
            true => is_chance(right.found.normal.chi_squared, n),
            false => {
                let contradicted = self.counted_sensors().count() > 1 || curves.smooth().is_empty();
                let least = if contradicted { MIN_NOISE_OVER_RESPONSE } else { MIN_NOISE_OF_ONE_SENSOR };
                let usual = self.level_per_frequency.map_or(0.0, |level_per_frequency| {
                    level_per_frequency * (1.0 + NOISE_CHI_SQUARED_STD / n.sqrt())
                });
                right.level <= least.max(usual)
            }
        }
    }
}
