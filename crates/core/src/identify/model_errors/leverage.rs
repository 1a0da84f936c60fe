//! How far an error of a known factor, or of the mesh, moves the unknowns.

use super::band_search::{ROUGH_NEIGHBOURHOOD_TOL, Search};
use super::factor_prior::FactorPrior;
use super::fitting::Fitting;
use super::found::{Leverage, LeverageOf};
use super::measured::USUAL_NOISE;
use super::sizes::Sizes;
use crate::c64;
use crate::for_each::map;
use crate::median::median;
use crate::model::FactorPart;
use crate::subspace::Modes;
use frfit_linalg::dense::Cholesky;

/// ∂ln p by each cause, `[cause][unknown]`.
type Moved = Vec<Vec<c64>>;

/// What may be off: the curves' derivatives by these.
#[derive(Clone, Copy)]
enum Cause {
    Factors,
    Mesh,
}

/// The end of the band at which an error of the mesh is given.
const UPPER_SHARE: f64 = 0.25;

impl Search<'_, '_> {
    /// The leverage of every known factor, and of the mesh where no coarser one says how far it is off, on every unknown.
    ///
    /// A single unknown that has a value of its own at each frequency is moved there by
    /// $$ \frac{\partial p}{\partial \nu_t} = -\frac{\sum_m \sigma_m^{-2} \\, \overline{\partial_p x_m} \\, \partial_{\nu_t} x_m}{\sum_m \sigma_m^{-2} \\, |\partial_p x_m|^2}; $$
    /// others by the least squares of the band, as constants, laws and smooth curves.
    pub(super) fn leverage(&self, theta: &[f64]) -> Vec<Leverage> {
        let storage = |factor: &&FactorPrior| factor.is_known && factor.part == FactorPart::Storage;
        let factors: Vec<FactorPrior> = self.factors.iter().filter(storage).copied().collect();
        let none = Modes::none(self.model);
        let fitting = Fitting { factors: &factors, ..self.fitting(self.model, &none, &self.lines) };
        let of_factors = self.moved(&fitting, theta, Cause::Factors);
        let mut all = self.leverages(&of_factors, |t| LeverageOf::Factor(factors[t].term));
        if self.mesh.is_none() && !self.modes.omega_rad_s.is_empty() {
            let near = self.smaller(&self.points(theta), ROUGH_NEIGHBOURHOOD_TOL);
            let fitting = Fitting { factors: &[], ..self.fitting(&near.0, &near.1, &self.lines) };
            let of_mesh = self.moved(&fitting, theta, Cause::Mesh);
            let upper = of_mesh.len() - (UPPER_SHARE * of_mesh.len() as f64).ceil() as usize;
            all.extend(self.leverages(&of_mesh[upper..], |_| LeverageOf::Mesh));
        }
        all
    }

    /// The median over some lines.
    fn leverages(&self, moved: &[Moved], of: impl Fn(usize) -> LeverageOf) -> Vec<Leverage> {
        let unknowns = self.data.nominal[0].len();
        let one = |(t, unknown): (usize, usize)| {
            let change = median(moved.iter().map(|moved| moved[t][unknown].norm()).collect());
            change.map(|change| Leverage { of: of(t), unknown, change })
        };
        let causes = moved.first().map_or(0, Vec::len);
        (0..causes).flat_map(|t| (0..unknowns).map(move |unknown| (t, unknown))).filter_map(one).collect()
    }

    fn moved(&self, fitting: &Fitting<'_, '_>, theta: &[f64], cause: Cause) -> Vec<Moved> {
        match self.data.nominal[0].len() == 1 && self.data.own.len() == 1 {
            true => self.moved_by_line(fitting, theta, cause),
            false => self.moved_by_band(fitting, theta, cause),
        }
    }

    /// At the lines that have an answer.
    fn moved_by_line(&self, fitting: &Fitting<'_, '_>, theta: &[f64], cause: Cause) -> Vec<Moved> {
        let place = fitting.start(&vec![0.0; self.curves.count()]);
        let errors = fitting.errors(&place);
        let trend = match cause {
            Cause::Factors => Vec::new(),
            Cause::Mesh => fitting.of_square_trend(),
        };
        let at_line = |&i: &usize| -> Option<Moved> {
            let value = self.data.free[i].values[0].value.filter(|_| self.data.free[i].on_path)?;
            let point = (self.data.point)(i, &[value])?;
            let at = (fitting.modes, &errors);
            let slopes = fitting.model.respond_with_error_slopes(at, &point.at, point.correction).ok()?;
            let slopes = slopes.shown(&self.curves.shares(theta, self.data.omegas[i]));
            let own = &slopes.slopes[0];
            let weight = |m: usize| 1.0 / self.data.sigma[i][m].powi(2);
            let all = || (0..own.len()).filter(|&m| self.data.sigma[i][m].is_finite());
            let size: f64 = all().map(|m| weight(m) * own[m].norm_sqr()).sum();
            let pull = |by: &dyn Fn(usize) -> c64| -> c64 {
                all().map(|m| weight(m) * own[m].conj() * by(m)).sum::<c64>() / (size * value)
            };
            let moved: Vec<c64> = match cause {
                Cause::Factors => {
                    (0..fitting.factors.len()).map(|t| pull(&|m| slopes.factors[m][t])).collect()
                }
                Cause::Mesh => {
                    let of_trend =
                        |m: usize| slopes.stiffness[m].iter().zip(&trend).map(|(s, t)| s * t).sum();
                    vec![pull(&of_trend)]
                }
            };
            Some(moved.into_iter().map(|moved| vec![moved]).collect())
        };
        let lines = map(self.for_each, self.lines.len(), |k| at_line(&self.lines[k]));
        lines.into_iter().flatten().collect()
    }

    /// At all lines, by the least squares of the band; nothing where it has no least.
    fn moved_by_band(&self, fitting: &Fitting<'_, '_>, theta: &[f64], cause: Cause) -> Vec<Moved> {
        self.moved_theta(fitting, theta, cause).map_or(Vec::new(), |moved| {
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

    /// ∂θ/∂ν of each factor, or ∂θ/∂δ of the mesh.
    fn moved_theta(&self, fitting: &Fitting<'_, '_>, theta: &[f64], cause: Cause) -> Option<Vec<Vec<f64>>> {
        let (n, m) = (fitting.count(), theta.len());
        let level = if self.data.known() { 1.0 } else { USUAL_NOISE };
        let noise = self.data.noise_at(&self.lines, level, 0.0);
        let normal = fitting.linearised(fitting.start(theta))?.normal(&noise, fitting.for_each)?;
        let prior = fitting.precision(&Sizes::prior(fitting.known));
        let of = |a: usize, b: usize| normal.information[a * n + b];
        let block = (0..m * m).map(|k| of(k / m, k % m) + prior[k / m * n + k % m]).collect::<Vec<f64>>();
        let factor = Cholesky::new(m, &block).ok()?;
        let causes: Vec<Vec<usize>> = match cause {
            Cause::Factors => (m..n).map(|column| vec![column]).collect(),
            Cause::Mesh => vec![fitting.square_trend().collect()],
        };
        let moved = |columns: &Vec<usize>| {
            let of_all = |a: usize| columns.iter().map(|&column| -of(a, column)).sum();
            let mut by: Vec<f64> = (0..m).map(of_all).collect();
            factor.solve(&mut by);
            by
        };
        Some(causes.iter().map(moved).collect())
    }
}
