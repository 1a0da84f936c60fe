//! One frequency: what it has of its own, found for given values of what holds for the band.

use super::neighbourhoods::Responded;
use crate::c64;
use crate::identify::unknown::Unknown;
use crate::least_squares::{Minimum, Search, descend};
use std::cell::RefCell;

/// What is measured at a frequency and unknown there.
pub(super) struct FrequencyProblem<'t> {
    pub(super) unknowns: &'t [Unknown],
    pub(super) measured: &'t [c64],
    /// Of real and imaginary part each.
    pub(super) sigma: &'t [f64],
    /// |p̄|: what the coordinates of an unknown are counted in.
    pub(super) size: Vec<f64>,
}

/// A solution at a frequency, for given values of what holds for the band.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solution {
    /// All unknowns.
    pub(super) values: Vec<c64>,
    /// Coordinates of those that the frequency has of its own.
    pub(super) own: Vec<f64>,
    /// Σ |u_m − x_m|²/σ_m².
    pub(super) misfit: f64,
    /// Residuals over σ, real and imaginary parts in turn.
    pub(super) residuals: Vec<f64>,
    /// Their slopes by its own coordinates, column after column.
    pub(super) of_own: Vec<f64>,
    /// Their slopes by the complex values of what holds for the band: ∂x_m/∂p_j over σ_m, `[unknown][sensor]`.
    pub(super) of_values: Vec<Vec<c64>>,
    pub(super) response: Vec<c64>,
}

/// Evaluations for each start and coordinate: from where it leads somewhere a dozen are enough for four coordinates.
const EVALUATIONS_PER_START_AND_COORDINATE: usize = 8;

/// A least misfit that is larger than the best by this factor is no rival of it, whatever the noise …
const MAX_RIVAL_MISFIT_RATIO: f64 = 1e4;

/// … where the best leaves more than roundoff: this part of Σ |u_m|²/σ_m².
const EXACT_MISFIT_RATIO: f64 = 1e-20;

/// Solutions of a frequency that are kept at most: as many equations as unknowns may have a dozen of them.
const MAX_SOLUTIONS: usize = 16;

/// Solutions nearer than this, in coordinates of size one, are one.
const SOLUTION_MERGE_TOL: f64 = 1e-7;

impl FrequencyProblem<'_> {
    /// Real numbers that the frequency has of its own.
    pub(super) fn count(&self) -> usize {
        self.unknowns.iter().map(Unknown::per_frequency).sum()
    }

    /// Σ |u_m|²/σ_m².
    fn size_of_measured(&self) -> f64 {
        self.measured.iter().zip(self.sigma).map(|(u, sigma)| (u / sigma).norm_sqr()).sum()
    }

    /// Coordinates of some values.
    pub(super) fn coordinates(&self, values: &[c64]) -> Vec<f64> {
        let mut own = Vec::with_capacity(self.count());
        for ((one, value), size) in self.unknowns.iter().zip(values).zip(&self.size) {
            match one.per_frequency() {
                2 => own.extend([value.re / size, value.im / size]),
                1 => own.push(value.re / size),
                _ => {}
            }
        }
        own
    }

    /// Values with these coordinates, the others as given.
    pub(super) fn values(&self, own: &[f64], given: &[c64]) -> Vec<c64> {
        let mut own = own.iter();
        let mut next = || own.next().copied().unwrap_or_default();
        let value = |((one, given), size): ((&Unknown, &c64), &f64)| match one.per_frequency() {
            2 => c64::new(next(), next()) * size,
            1 => c64::new(next() * size, 0.0),
            _ => *given,
        };
        self.unknowns.iter().zip(given).zip(&self.size).map(value).collect()
    }

    /// Everything about one point.
    pub(super) fn at(
        &self,
        own: &[f64],
        given: &[c64],
        respond: impl Fn(&[c64]) -> Option<Responded>,
    ) -> Option<Solution> {
        let values = self.values(own, given);
        let (response, slopes) = respond(&values)?;
        let parts = |of: &dyn Fn(usize) -> c64| -> Vec<f64> {
            (0..response.len()).map(|m| of(m) / self.sigma[m]).flat_map(|v| [v.re, v.im]).collect()
        };
        let residuals = parts(&|m| response[m] - self.measured[m]);
        let mut of_own = Vec::new();
        for ((one, slope), &size) in self.unknowns.iter().zip(&slopes).zip(&self.size) {
            for turn in &[c64::new(1.0, 0.0), c64::I][..one.per_frequency()] {
                of_own.extend(parts(&|m| slope[m] * turn * size));
            }
        }
        let misfit: f64 = residuals.iter().map(|r| r * r).sum();
        let weighed = |slope: &Vec<c64>| slope.iter().zip(self.sigma).map(|(s, sigma)| s / sigma).collect();
        let of_values = slopes.iter().map(weighed).collect();
        let finite = misfit.is_finite() && of_own.iter().all(|slope| slope.is_finite());
        finite.then_some(Solution {
            values,
            own: own.to_vec(),
            misfit,
            residuals,
            of_own,
            of_values,
            response,
        })
    }

    /// The nearest least misfit, by Levenberg and Marquardt's method; `None` where the search finds none.
    pub(super) fn settle(
        &self,
        start: &[f64],
        given: &[c64],
        respond: impl Fn(&[c64]) -> Option<Responded>,
    ) -> Option<Solution> {
        if start.is_empty() {
            return self.at(start, given, respond);
        }
        // a search asks for its end again
        let met: RefCell<Vec<Solution>> = RefCell::default();
        let at = |own: &[f64]| {
            let known = met.borrow().iter().find(|known| known.own == own).cloned();
            known.or_else(|| {
                let new = self.at(own, given, &respond)?;
                met.borrow_mut().push(new.clone());
                Some(new)
            })
        };
        let evaluate = |own: &[f64]| at(own).map(|here| (here.residuals, here.of_own));
        let search = Search { starts: 1, patience: EVALUATIONS_PER_START_AND_COORDINATE, same: 0.0 };
        let Minimum { theta, converged, .. } = descend(start, &evaluate, &search)?;
        at(&theta).filter(|_| converged)
    }

    /// The different solutions that some starts lead to and no bound excludes, by their misfit.
    pub(super) fn solutions(
        &self,
        starts: &[Vec<f64>],
        given: &[c64],
        respond: impl Fn(&[c64]) -> Option<Responded>,
    ) -> Vec<Solution> {
        let mut found: Vec<Solution> = Vec::new();
        for start in starts {
            let Some(new) = self.settle(start, given, &respond) else { continue };
            let within = |(one, &value): (&Unknown, &c64)| {
                one.per_frequency() == 0 || one.bounds.broken_by(value).is_none()
            };
            if !self.unknowns.iter().zip(&new.values).all(within) {
                continue;
            }
            match found.iter_mut().find(|old| distance(&old.own, &new.own) <= SOLUTION_MERGE_TOL) {
                Some(old) if new.misfit < old.misfit => *old = new,
                Some(_) => {}
                None => found.push(new),
            }
        }
        found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        let worst = found.first().map_or(0.0, |best| {
            MAX_RIVAL_MISFIT_RATIO * best.misfit.max(EXACT_MISFIT_RATIO * self.size_of_measured())
        });
        found.retain(|solution| solution.misfit <= worst);
        found.truncate(MAX_SOLUTIONS);
        found
    }
}

/// The largest difference of two points' coordinates.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Removes from columns of length m what the columns of `of` span, and returns how much of it each contained: coefficients x with `of` x ≈ column, for each column.
pub(super) fn eliminate(of: &[f64], columns: &mut [f64], m: usize) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let p = of.len() / m.max(1);
    // Q R = of by Gram and Schmidt's method, twice.
    let mut q = of.to_vec();
    let mut r = vec![0.0; p * p];
    for j in 0..p {
        let (before, rest) = q.split_at_mut(j * m);
        let column = &mut rest[..m];
        for _ in 0..2 {
            for (i, other) in before.chunks_exact(m).enumerate() {
                let overlap = dot(other, column);
                r[i + j * p] += overlap;
                column.iter_mut().zip(other).for_each(|(c, o)| *c -= overlap * o);
            }
        }
        let norm = dot(column, column).sqrt();
        r[j + j * p] = norm;
        if norm > 0.0 {
            column.iter_mut().for_each(|c| *c /= norm);
        }
    }
    let one = |column: &mut [f64]| {
        let mut x = vec![0.0; p];
        for _ in 0..2 {
            for (i, other) in q.chunks_exact(m).enumerate() {
                let overlap = dot(other, column);
                x[i] += overlap;
                column.iter_mut().zip(other).for_each(|(c, o)| *c -= overlap * o);
            }
        }
        for i in (0..p).rev() {
            let known: f64 = (i + 1..p).map(|k| r[i + k * p] * x[k]).sum();
            x[i] = if r[i + i * p] > 0.0 { (x[i] - known) / r[i + i * p] } else { 0.0 };
        }
        x
    };
    columns.chunks_exact_mut(m.max(1)).map(one).collect()
}
