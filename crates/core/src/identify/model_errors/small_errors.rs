//! Small errors of a model about a place where a right model explains a band: what they promise, by the slopes there, and what they may do to the unknowns.
//!
//! A mesh that is 0.03 % off is not seen beside noise of 1 %. Where a right model explains a band as well as one with errors, its error bars are those of both: the posterior is
//! averaged over errors of all sizes and over none, each weighed by its evidence.
//!
//! # Source
//! J. A. Hoeting, D. Madigan, A. E. Raftery, C. T. Volinsky, Stat. Sci. 14 (1999) 382–417 (averaging over models).

use super::factor_prior::FactorPrior;
use super::fit::Explained;
use super::fitting::{Fitting, Place};
use super::linearised::Normal;
use super::measured::Measured;
use super::prior::NEGLIGIBLE_STD;
use super::sizes::Sizes;
use frfit_linalg::dense::Cholesky;

/// Of the sizes before the data, at which usual errors are tried, and smaller ones.
const USUAL_SIZE_PARTS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
const SMALL_SIZE_PARTS: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// How likely a model with errors is before the data, over one without.
const ODDS_OF_ERRORS: f64 = 1.0;

/// By how many nats errors of some size explain a band better than a right model does, by a linear model about that. It costs no search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SmallErrors {
    /// Errors of all kinds and of usual sizes.
    pub(super) usual_nats: f64,
    /// The same of all sizes, with the least ones that are assumed as much smaller, and of errors of natural frequencies alone: shapes and calibrations that
    /// agree with a right model say nothing of these.
    pub(super) small_nats: f64,
}

/// A size of errors, and of which ones.
#[derive(Clone, Copy)]
struct Tried {
    part: f64,
    /// Whether the least sizes that are assumed are as much smaller.
    with_least: bool,
    errors: Errors,
}

/// Which errors of a model are tried.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Errors {
    All,
    /// Those of natural frequencies alone.
    Frequencies,
    /// What natural frequencies have in common alone: elements that lack shear err by more from mode to mode, and by no scatter.
    Trend,
}

/// Where a right model explains a band.
pub(super) struct About<'t, 'a> {
    whole: &'t Fitting<'t, 'a>,
    right: &'t Explained,
    /// Coordinates that a right model has.
    of_right: Vec<usize>,
    pub(super) place: Place,
    normal: Normal,
}

/// What the band says where errors have some size.
struct Posterior {
    /// By how many nats they explain it better than a right model does.
    nats: f64,
    /// The inverse of the covariance of all coordinates, factored.
    precision: Cholesky,
    /// From the right model to where the errors fit best.
    step: Vec<f64>,
}

impl SmallErrors {
    /// About a right model.
    pub(super) fn new(about: &About<'_, '_>) -> Option<Self> {
        let usual = |part| Tried { part, with_least: false, errors: Errors::All };
        let usual = USUAL_SIZE_PARTS.into_iter().map(usual);
        let nats = |tried: Tried| Some(about.with_errors(tried)?.nats);
        Some(Self {
            usual_nats: usual.filter_map(nats).reduce(f64::max)?,
            small_nats: about.small().filter_map(nats).reduce(f64::max)?,
        })
    }
}

impl<'t, 'a> About<'t, 'a> {
    /// About a right model some of whose known factors may be in error.
    pub(super) fn new(
        data: &Measured<'_, '_>,
        whole: &'t Fitting<'t, 'a>,
        right: &'t Explained,
        given: &[FactorPrior],
    ) -> Option<Self> {
        let of_right = whole.coordinates_of(given);
        let mut place = whole.start(&right.found.place[..whole.curves.count()]);
        of_right.iter().zip(&right.found.place).for_each(|(&i, value)| place[i] = *value);
        let noise = data.noise_at(whole.lines, right.level, 0.0);
        let normal = whole.linearised(place.clone())?.normal(&noise, whole.for_each)?;
        Some(Self { whole, right, of_right, place, normal })
    }

    /// Small errors of all kinds, and of natural frequencies alone. A curve beside other unknowns takes most of what natural frequencies have in common, so that
    /// the data say little of that: it is tried alone too. Of one unknown that would make the bars of a right law many times as long.
    fn small(&self) -> impl Iterator<Item = Tried> {
        let of =
            |errors| SMALL_SIZE_PARTS.into_iter().map(move |part| Tried { part, with_least: true, errors });
        let trend = self.whole.curves.is_beside_others().then_some(Errors::Trend);
        [Errors::All, Errors::Frequencies].into_iter().chain(trend).flat_map(of)
    }

    /// Second moments of all coordinates about the right model, n × n: Σ p_s (C_s + Δ_s Δ_sᵀ) with the posterior C_s and the step Δ_s of errors of each size s, and of none. `None`
    /// where a right model has no covariance.
    ///
    /// # Limits
    /// Linear about the right model: errors that move a mode by more than its half-width are searched, not averaged.
    pub(super) fn second_moments(&self) -> Option<Vec<f64>> {
        let n = self.whole.count();
        let each: Vec<Posterior> = self.small().filter_map(|tried| self.with_errors(tried)).collect();
        // Of none the evidence is 0 nats.
        let most = each.iter().map(|one| one.nats).fold(0.0, f64::max);
        let weight = |one: &Posterior| ODDS_OF_ERRORS / each.len() as f64 * (one.nats - most).exp();
        let weight_of_none = (-most).exp();
        let sum = weight_of_none + each.iter().map(weight).sum::<f64>();
        let of_none = self.of_none()?;
        let mut moments = vec![0.0; n * n];
        let pairs = self.of_right.iter().flat_map(|&a| self.of_right.iter().map(move |&b| a * n + b));
        pairs.zip(of_none).for_each(|(at, covariance)| moments[at] = weight_of_none / sum * covariance);
        for one in &each {
            let (share, covariance) = (weight(one) / sum, one.precision.inverse());
            for (k, moment) in moments.iter_mut().enumerate() {
                *moment += share * (covariance[k] + one.step[k / n] * one.step[k % n]);
            }
        }
        Some(moments).filter(|moments| moments.iter().all(|moment| moment.is_finite()))
    }

    /// The covariance of the coordinates of a right model.
    pub(super) fn of_none(&self) -> Option<Vec<f64>> {
        let prior = self.precision(Tried { part: 1.0, with_least: true, errors: Errors::All });
        let precision = self.block(&self.normal.with_prior(&prior));
        Some(Cholesky::new(self.of_right.len(), &precision).ok()?.inverse())
    }

    /// Of a matrix, n × n, what belongs to the coordinates of a right model.
    fn block(&self, matrix: &[f64]) -> Vec<f64> {
        let n = self.whole.count();
        let row = |&i: &usize| self.of_right.iter().map(move |j| matrix[i * n + j]);
        self.of_right.iter().flat_map(row).collect()
    }

    fn with_errors(&self, tried: Tried) -> Option<Posterior> {
        let Self { whole, of_right, place, normal, .. } = self;
        let n = whole.count();
        let prior = self.precision(tried);
        let sum = normal.with_prior(&prior);
        let off = |j: usize| place[j] - whole.expected(j);
        let pull = |i: usize| -> f64 { of_right.iter().map(|&j| prior[i * n + j] * off(j)).sum() };
        let slope: Vec<f64> = (0..n).map(|i| normal.gradient[i] - pull(i)).collect();
        let precision = Cholesky::new(n, &sum).ok()?;
        let mut step = slope.clone();
        precision.solve(&mut step);
        let gained: f64 = slope.iter().zip(&step).map(|(g, s)| g * s).sum();
        let volume = |n: usize, matrix: &[f64]| Some(Cholesky::new(n, matrix).ok()?.log_determinant());
        let of_errors = precision.log_determinant() - volume(n, &prior)?;
        let of_curves =
            volume(of_right.len(), &self.block(&sum))? - volume(of_right.len(), &self.block(&prior))?;
        Some(Posterior { nats: 0.5 * (gained - of_errors + of_curves), precision, step })
    }

    /// The prior's precision, n × n.
    fn precision(&self, Tried { part, with_least, errors }: Tried) -> Vec<f64> {
        let Self { whole, right, of_right, .. } = self;
        let usual = Sizes::prior(whole.known);
        let sizes = Sizes {
            frequency: part * usual.frequency,
            loss_factor: part * usual.loss_factor,
            scale: part * usual.scale,
            trends: usual.trends.map(|size| part * size),
            common_loss: part * usual.common_loss,
            shape: part * usual.shape,
            calibration: part * usual.calibration,
            mass: usual.mass,
            bend: right.sizes.bend,
        };
        let known = if with_least { whole.known.smaller(part) } else { whole.known };
        let mut precision = Fitting { known, ..**whole }.precision(&sizes);
        let n = whole.count();
        let mut leave_out = |coordinates: Vec<usize>| {
            let others = coordinates.into_iter().filter(|i| !of_right.contains(i));
            others.for_each(|i| precision[i * n + i] = NEGLIGIBLE_STD.powi(-2));
        };
        if errors != Errors::All {
            leave_out(whole.beside_frequencies().collect());
        }
        if errors == Errors::Trend {
            leave_out(whole.own().collect());
        }
        precision
    }
}
