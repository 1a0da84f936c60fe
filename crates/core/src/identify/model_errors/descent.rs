//! The descent to a minimum of χ² and the prior.

use super::fitting::{Fitting, Place};
use super::linearised::{Linearised, Normal};
use super::whitening::Whitening;
use frfit_linalg::dense::Cholesky;

/// Steps that are refused before a search ends.
const MAX_REFUSED_STEPS: usize = 6;

/// The largest step of a coordinate of θ.
const MAX_THETA_STEP: f64 = 0.5;

/// A descent ends where a step lowers the cost, −2 ln of a probability, by less than this part of it or by less than this.
const COST_RTOL: f64 = 1e-5;
const COST_ATOL: f64 = 0.01;

/// Damping to begin with, over the diagonal of the normal equations.
const FIRST_DAMPING: f64 = 1e-4;

/// Parts of a step that are tried along a bend.
const PARTS_OF_BEND: [f64; 3] = [1.0, 0.5, 0.25];

/// A minimum.
pub(super) struct Minimum {
    pub(super) place: Place,
    pub(super) normal: Normal,
    pub(super) prior: f64,
}

/// Where a descent is: the responses near there, χ² with its slopes, the prior with its own.
struct Reached {
    at: Linearised,
    normal: Normal,
    prior: f64,
    pull: Vec<f64>,
}

impl Reached {
    /// −2 ln of the probability.
    fn cost(&self) -> f64 {
        self.normal.chi_squared + self.prior
    }

    /// Half of its downward slope.
    fn slope(&self) -> Vec<f64> {
        self.normal.gradient.iter().zip(&self.pull).map(|(data, prior)| data - prior).collect()
    }
}

/// A step within the bounds.
struct Bounded {
    step: Vec<f64>,
    /// Coordinates that stop at a bound.
    stopped: Vec<usize>,
    /// Of the matrix of the step, without what belongs to them.
    factor: Cholesky,
}

impl Fitting<'_, '_> {
    /// Levenberg and Marquardt's method from a place: where it ends, and the responses near there.
    ///
    /// Unknowns and errors that can stand in for them leave a narrow valley, which bends. Where a step s is refused, the response at its end shows the bend
    /// b = x(p + s) − x(p) − J s, and the place p + t s + t² c is tried with c = −(JᵀJ + P)⁻¹ Jᵀ b, which stays in the valley to second order.
    ///
    /// # Source
    /// M. K. Transtrum, J. P. Sethna, arXiv:1201.5885 (2012) (geodesic acceleration; the bend is that of the whole step here, and costs no further response).
    pub(super) fn descend(
        &self,
        at: Linearised,
        whitening: &Whitening,
        precision: &[f64],
        steps: usize,
    ) -> Option<(Minimum, Linearised)> {
        let n = self.count();
        let reached = |at: Linearised| -> Option<Reached> {
            let normal = at.normal(whitening, self.for_each)?;
            let off: Vec<f64> = (0..n).map(|i| at.place[i] - self.expected(i)).collect();
            let pull: Vec<f64> =
                precision.chunks_exact(n).map(|row| row.iter().zip(&off).map(|(p, o)| p * o).sum()).collect();
            let prior = pull.iter().zip(&off).map(|(p, o)| p * o).sum();
            Some(Reached { at, normal, prior, pull })
        };
        let mut here = reached(at)?;
        // Damping is a part of what the data say, and in a valley it would stop what only the prior drives: the last steps have none, unless that is refused.
        let (mut damping, mut refused, mut may_be_undamped) = (FIRST_DAMPING, 0, true);
        for _ in 0..steps {
            let mut matrix = here.normal.with_prior(precision);
            (0..n).for_each(|i| matrix[i * n + i] *= 1.0 + damping);
            let Some(Bounded { step, stopped, factor }) = self.bounded(&here.at.place, matrix, here.slope())
            else {
                damping = (damping * 10.0).max(1e-9);
                continue;
            };
            let longest = step[..self.curves.count()].iter().fold(0.0f64, |most, s| most.max(s.abs()));
            let part = (MAX_THETA_STEP / longest).min(1.0);
            let step: Vec<f64> = step.iter().map(|s| part * s).collect();
            let along = |t: f64, bend: &[f64]| -> Option<Reached> {
                let path = here.at.place.iter().zip(&step).zip(bend);
                let mut there: Place = path.map(|((p, s), c)| p + t * s + t * t * c).collect();
                // A bend may leave them.
                self.curves.keep_within_bounds(&mut there);
                reached(self.linearised(there)?)
            };
            let is_lower = |there: &Reached| there.cost() <= here.cost();
            let straight = along(1.0, &vec![0.0; n]);
            let next = match straight {
                Some(there) if !is_lower(&there) && damping <= FIRST_DAMPING => {
                    let mut back = here.at.bend(&there.at, &step, whitening);
                    stopped.iter().for_each(|&i| back[i] = 0.0);
                    factor.solve(&mut back);
                    PARTS_OF_BEND.iter().filter_map(|&t| along(t, &back)).find(is_lower)
                }
                straight => straight.filter(is_lower),
            };
            match next {
                Some(there) => {
                    let gain = here.cost() - there.cost();
                    let is_small = gain <= (COST_RTOL * here.cost()).max(COST_ATOL) && part == 1.0;
                    here = there;
                    refused = 0;
                    if is_small && (damping == 0.0 || !may_be_undamped) {
                        break;
                    }
                    damping = if is_small { 0.0 } else { 0.1 * damping };
                }
                None => {
                    may_be_undamped &= damping > 0.0;
                    damping = (damping * 10.0).max(1e-6);
                    refused += 1;
                    if refused == MAX_REFUSED_STEPS {
                        break;
                    }
                }
            }
        }
        let Reached { at, normal, prior, .. } = here;
        Some((Minimum { place: at.place.clone(), normal, prior }, at))
    }

    /// The step to where a quadratic form is least within the bounds: coordinates that would leave them stop there.
    fn bounded(&self, place: &[f64], mut matrix: Vec<f64>, mut slope: Vec<f64>) -> Option<Bounded> {
        let n = slope.len();
        let mut stopped = Vec::new();
        loop {
            let mut step = slope.clone();
            let factor = Cholesky::new(n, &matrix).ok()?;
            factor.solve(&mut step);
            // Bounds are those of a few coordinates, and each stops once.
            let beyond = self.curves.stopped(place, &step);
            if beyond.is_empty() {
                return Some(Bounded { step, stopped, factor });
            }
            for (i, by) in beyond {
                for j in (0..n).filter(|&j| j != i) {
                    slope[j] -= matrix[i * n + j] * by;
                    (matrix[i * n + j], matrix[j * n + i]) = (0.0, 0.0);
                }
                (matrix[i * n + i], slope[i]) = (1.0, by);
                stopped.push(i);
            }
        }
    }
}
