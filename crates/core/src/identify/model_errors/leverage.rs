//! How far an error of a known factor moves the unknowns.

use super::search::{FactorPrior, Fitting, Sizes};
use super::{Leverage, Search, USUAL_NOISE};
use crate::c64;
use crate::for_each::map;
use crate::median::median;
use crate::model::FactorPart;
use crate::subspace::Modes;
use frfit_linalg::dense::Cholesky;

/// ∂ln p/∂ν, `[factor][unknown]`.
type Moved = Vec<Vec<c64>>;

impl Search<'_, '_> {
    /// The leverage of every known factor on every unknown.
    ///
    /// A single unknown that each frequency has a value of its own of follows by itself,
    /// $$ \frac{\partial p}{\partial \nu_t} = -\frac{\sum_m \sigma_m^{-2} \\, \overline{\partial_p x_m} \\, \partial_{\nu_t} x_m}{\sum_m \sigma_m^{-2} \\, |\partial_p x_m|^2}; $$
    /// others by the least squares of the band, as constants, laws and smooth curves.
    pub(super) fn leverage(&self, theta: &[f64]) -> Vec<Leverage> {
        let storage = |factor: &&FactorPrior| factor.is_known && factor.part == FactorPart::Storage;
        let factors: Vec<FactorPrior> = self.factors.iter().filter(storage).copied().collect();
        let none = Modes::none(self.model);
        let fitting = Fitting { factors: &factors, ..self.fitting(self.model, &none, &self.lines) };
        let unknowns = self.data.nominal[0].len();
        let by_line = unknowns == 1 && self.data.own.len() == 1;
        let moved =
            if by_line { self.moved_by_line(&fitting, theta) } else { self.moved_by_band(&fitting, theta) };
        let of = |t: usize, unknown: usize| {
            let change = median(moved.iter().map(|moved| moved[t][unknown].norm()).collect());
            change.map(|change| Leverage { term: factors[t].term, unknown, change })
        };
        let each = (0..factors.len()).flat_map(|t| (0..unknowns).map(move |unknown| (t, unknown)));
        each.filter_map(|(t, unknown)| of(t, unknown)).collect()
    }

    /// At the lines that have an answer.
    fn moved_by_line(&self, fitting: &Fitting<'_, '_>, theta: &[f64]) -> Vec<Moved> {
        let errors = fitting.errors(&fitting.start(&vec![0.0; self.curves.count()]));
        let at_line = |&i: &usize| -> Option<Moved> {
            let value = self.data.free[i].values[0].value.filter(|_| self.data.free[i].on_path)?;
            let point = (self.data.point)(i, &[value])?;
            let at = (fitting.modes, &errors);
            let slopes = self.model.respond_with_error_slopes(at, &point.at, point.correction).ok()?;
            let slopes = slopes.shown(&self.curves.shares(theta, self.data.omegas[i]));
            let own = &slopes.slopes[0];
            let weight = |m: usize| 1.0 / self.data.sigma[i][m].powi(2);
            let all = || (0..own.len()).filter(|&m| self.data.sigma[i][m].is_finite());
            let size: f64 = all().map(|m| weight(m) * own[m].norm_sqr()).sum();
            let pull =
                |t: usize| -> c64 { all().map(|m| weight(m) * own[m].conj() * slopes.factors[m][t]).sum() };
            Some((0..fitting.factors.len()).map(|t| vec![pull(t) / (size * value)]).collect())
        };
        let lines = map(self.for_each, self.lines.len(), |k| at_line(&self.lines[k]));
        lines.into_iter().flatten().collect()
    }

    /// At all lines, by the least squares of the band; nothing where it has no least.
    fn moved_by_band(&self, fitting: &Fitting<'_, '_>, theta: &[f64]) -> Vec<Moved> {
        self.moved_theta(fitting, theta).map_or(Vec::new(), |moved| {
            let at_line = |&i: &usize| -> Option<Moved> {
                let (values, slopes) = self.curves.values(theta, i, self.data.omegas[i])?;
                let of = |moved: &Vec<f64>| {
                    let mut sums = vec![c64::default(); values.len()];
                    slopes.iter().zip(moved).for_each(|((j, slope), by)| sums[*j] += slope * by / values[*j]);
                    sums
                };
                Some(moved.iter().map(of).collect())
            };
            self.lines.iter().filter_map(at_line).collect()
        })
    }

    /// ∂θ/∂ν of each factor.
    fn moved_theta(&self, fitting: &Fitting<'_, '_>, theta: &[f64]) -> Option<Vec<Vec<f64>>> {
        let (n, m) = (fitting.count(), theta.len());
        let level = if self.data.known() { 1.0 } else { USUAL_NOISE };
        let sigma = self.data.sigma_at(&self.lines, level, 0.0);
        let normal = fitting.normal(&fitting.start(theta), &sigma)?;
        let prior = fitting.precision(&Sizes::prior(fitting.known));
        let of = |a: usize, b: usize| normal.information[a * n + b];
        let block = (0..m * m).map(|k| of(k / m, k % m) + prior[k / m * n + k % m]).collect::<Vec<f64>>();
        let factor = Cholesky::new(m, &block).ok()?;
        let moved = |t: usize| {
            let mut by: Vec<f64> = (0..m).map(|a| -of(a, m + t)).collect();
            factor.solve(&mut by);
            by
        };
        Some((0..n - m).map(moved).collect())
    }
}
