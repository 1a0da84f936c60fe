//! The descent to a minimum of χ² and the prior.

use super::fitting::{Fitting, Place};
use super::linearised::{Linearised, Normal};
use frfit_linalg::dense::Cholesky;

/// Steps that are refused before a search ends.
const MAX_REFUSED_STEPS: usize = 6;

/// The largest step of a coordinate of θ.
const MAX_THETA_STEP: f64 = 0.5;

/// A descent ends where a step lowers the cost, −2 ln of a probability, by less than this part of it or by less than this.
const COST_RTOL: f64 = 1e-5;
const COST_ATOL: f64 = 0.01;

/// A minimum.
pub(super) struct Minimum {
    pub(super) place: Place,
    pub(super) normal: Normal,
    pub(super) prior: f64,
}

impl Fitting<'_, '_> {
    /// Levenberg and Marquardt's method from a place: where it ends, and the responses near there.
    pub(super) fn descend(
        &self,
        mut at: Linearised,
        sigma: &[Vec<f64>],
        precision: &[f64],
        steps: usize,
    ) -> Option<(Minimum, Linearised)> {
        let n = self.count();
        let prior = |place: &[f64]| -> (f64, Vec<f64>) {
            let off: Vec<f64> = (0..n).map(|i| place[i] - self.expected(i)).collect();
            let times: Vec<f64> =
                precision.chunks_exact(n).map(|row| row.iter().zip(&off).map(|(p, o)| p * o).sum()).collect();
            (times.iter().zip(&off).map(|(p, o)| p * o).sum(), times)
        };
        let mut normal = at.normal(sigma, self.for_each)?;
        let (mut of_prior, mut pull) = prior(&at.place);
        let (mut damping, mut refused) = (1e-4, 0);
        for _ in 0..steps {
            let mut matrix = normal.with_prior(precision);
            (0..n).for_each(|i| matrix[i * n + i] *= 1.0 + damping);
            let mut slope: Vec<f64> = normal.gradient.iter().zip(&pull).map(|(g, p)| g - p).collect();
            let Some(step) = self.step(&at.place, &mut matrix, &mut slope) else {
                damping *= 10.0;
                continue;
            };
            let longest = step[..self.curves.count()].iter().fold(0.0f64, |most, s| most.max(s.abs()));
            let part = (MAX_THETA_STEP / longest).min(1.0);
            let mut there: Place = at.place.iter().zip(&step).map(|(p, s)| p + part * s).collect();
            // Roundoff.
            self.curves.keep_within_bounds(&mut there);
            let (other_prior, other_pull) = prior(&there);
            let cost = normal.chi_squared + of_prior;
            let other = self.linearised(there).and_then(|there| {
                let normal = there.normal(sigma, self.for_each)?;
                (normal.chi_squared + other_prior <= cost).then_some((there, normal))
            });
            match other {
                Some((there, other)) => {
                    let gain = cost - other.chi_squared - other_prior;
                    (at, normal, of_prior, pull) = (there, other, other_prior, other_pull);
                    damping = (damping * 0.1).max(1e-9);
                    refused = 0;
                    if gain <= (COST_RTOL * cost).max(COST_ATOL) && part == 1.0 {
                        break;
                    }
                }
                None => {
                    damping = (damping * 10.0).max(1e-6);
                    refused += 1;
                    if refused == MAX_REFUSED_STEPS {
                        break;
                    }
                }
            }
        }
        Some((Minimum { place: at.place.clone(), normal, prior: of_prior }, at))
    }

    /// The step to where a quadratic form is least within the bounds: coordinates that would leave them stop there. Both are used up.
    fn step(&self, place: &[f64], matrix: &mut [f64], slope: &mut [f64]) -> Option<Vec<f64>> {
        let n = slope.len();
        loop {
            let mut step = slope.to_vec();
            Cholesky::new(n, matrix).ok()?.solve(&mut step);
            // Bounds are those of a few coordinates, and each stops once.
            let stopped = self.curves.stopped(place, &step);
            if stopped.is_empty() {
                return Some(step);
            }
            for (i, by) in stopped {
                for j in (0..n).filter(|&j| j != i) {
                    slope[j] -= matrix[i * n + j] * by;
                    (matrix[i * n + j], matrix[j * n + i]) = (0.0, 0.0);
                }
                (matrix[i * n + i], slope[i]) = (1.0, by);
            }
        }
    }
}
