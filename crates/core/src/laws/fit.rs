//! A fitted law: its parameters, how well they are known, and how well it explains the data.

use super::correlated::{Correlated, LineResidual, correlation, shared_covariance};
use super::{Datum, LawKind, Parametrization, starts};
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::least_squares::{LocalMinima, Search, inverse_information, minimise};
use crate::material::{Law, loss_factor};

/// A parameter of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// As case files write it.
    pub name: String,
    /// Its unit, with the modulus in Pa; empty without one.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation by the delta rule; `None` where it is not identifiable.
    pub std: Option<f64>,
}

/// A law's modulus at a frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusEstimate {
    /// E′ + iE″.
    pub modulus: c64,
    /// Standard deviation of E′; `None` where the parameters are not identifiable.
    pub storage_std: Option<f64>,
    /// Standard deviation of η.
    pub loss_factor_std: Option<f64>,
    /// Correlation of E′ and η; `None` where one of them has no standard deviation.
    pub correlation: Option<f64>,
}

/// What a fit had to go by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Evidence {
    /// Real numbers that were fitted.
    pub(crate) residuals: usize,
    /// Whether the standard deviations are known, not only what they are in proportion to.
    pub(crate) sigma_known: bool,
}

/// A law fitted to data by weighted least squares.
#[derive(Debug, Clone, PartialEq)]
pub struct LawFit {
    /// Which law.
    pub kind: LawKind,
    /// The law with its parameters.
    pub law: Law,
    /// The parameters.
    pub parameters: Vec<Estimate>,
    /// Correlation of the parameters, by the delta rule; `None` where some are not identifiable.
    pub correlation: Option<Vec<Vec<f64>>>,
    /// χ² = Σ r²: with known standard deviations about as many as there are degrees of freedom. With unknown ones it is in units of what they are in proportion to.
    pub chi_squared: f64,
    /// Real numbers that were fitted: two for a complex one.
    pub residuals: usize,
    /// Whether the standard deviations are known.
    pub sigma_known: bool,
    /// Whether the search ended because there was nothing more to gain.
    pub converged: bool,
    /// Starts that were followed.
    pub starts: usize,
    /// How many of them ended here. Where most did not, there may be a better minimum still.
    pub agreeing: usize,
    /// What neighbouring lines leave in common, by which the standard deviations are wider than noise alone would have them; `None` where noise of each line explains the residuals.
    pub correlated: Option<Correlated>,
    parametrization: Parametrization,
    theta: Vec<f64>,
    /// Other minima that the data cannot exclude.
    rivals: Vec<Vec<f64>>,
    /// Of θ; NaN for coordinates that are not identifiable.
    covariance: Option<Vec<Vec<f64>>>,
}

/// Sums of squares that differ by this share of a degree of freedom are one minimum.
const MINIMUM_MERGE_TOL: f64 = 1e-3;

/// Residuals of this size squared count as zero: of data without noise every end is roundoff, each its own.
const EXACT_SUM_OF_SQUARES: f64 = 1e-20;

/// Starts that are followed, of those that there are.
const MODULUS_LAW_STARTS: usize = 5;

/// Evaluations for each start and unknown: with branches too many, valleys are long.
const EVALUATIONS_PER_START_AND_UNKNOWN: usize = 50;

/// Weighted least squares of one law on data; `None` where there are fewer numbers than parameters, or no start has a finite misfit.
///
/// Where neighbouring rows leave the same, the error bars are wider ([`Correlated`]).
///
/// # Limits
/// The error bars of a wrong law say how far its parameters would move if an error as large and over as many rows came about again by chance; they do not say that the law is right.
pub fn fit_modulus(data: &[Datum], kind: LawKind, sigma_known: bool) -> Option<LawFit> {
    let omegas: Vec<f64> = data.iter().map(|datum| datum.omega_rad_s).collect();
    let parametrization = Parametrization::about(kind, &omegas);
    let evidence = Evidence { residuals: 2 * data.len(), sigma_known };
    if evidence.residuals < kind.count() {
        return None;
    }
    let evaluate = |theta: &[f64]| parametrization.residuals(data, theta);
    let search =
        Search { starts: MODULUS_LAW_STARTS, patience: EVALUATIONS_PER_START_AND_UNKNOWN, same: 0.0 };
    let minima = minimise(&starts(&parametrization, data), &evaluate, &search)?;
    let fit = LawFit::new(parametrization, minima, evidence);
    let lines = fit.parametrization.lines(data, &fit.theta);
    Some(fit.widened(&lines))
}

impl Parametrization {
    /// About the middle of some frequencies, in the sense of ratios.
    pub(crate) fn about(kind: LawKind, omegas_rad_s: &[f64]) -> Self {
        let logs: f64 = omegas_rad_s.iter().map(|omega| omega.ln()).sum();
        let reference_rad_s = (logs / omegas_rad_s.len().max(1) as f64).exp();
        Self { kind, reference_rad_s, decay_per_s: 0.0 }
    }

    /// The same for moduli that are seen through a window e^{−αt}.
    pub(crate) fn through_window(self, decay_per_s: f64) -> Self {
        Self { decay_per_s, ..self }
    }
}

/// Nats by which another minimum may be behind and still be the answer, as in the selection of solutions.
const RIVAL_NATS: f64 = 7.0;

impl LawFit {
    pub(crate) fn new(parametrization: Parametrization, minima: LocalMinima, evidence: Evidence) -> Self {
        let LocalMinima { best, others, followed, agreeing } = minima;
        let Evidence { residuals, sigma_known } = evidence;
        let n = parametrization.kind.count();
        let unit = scale(best.sum, residuals, n, sigma_known);
        // Ends that differ by less than a thousandth of what noise makes of χ² are one.
        let same = MINIMUM_MERGE_TOL * unit + EXACT_SUM_OF_SQUARES * residuals as f64;
        let near = others.iter().filter(|other| other.sum - best.sum <= same).count();
        let behind = |sum: f64| 0.5 * (sum - best.sum) / unit.max(f64::MIN_POSITIVE);
        let rivals = others.iter().filter(|other| other.converged && behind(other.sum) <= RIVAL_NATS);
        let rivals = rivals.map(|other| other.theta.clone()).collect();
        let theta = parametrization.sorted(&best.theta);
        // The branches' order is that of θ, and so is the Jacobian's.
        let jacobian = reordered(&parametrization, &best.theta, &theta, &best.jacobian);
        let covariance = inverse_information(&jacobian, n).map(|mut inverse| {
            inverse.iter_mut().flatten().for_each(|value| *value *= unit);
            inverse
        });
        let Reported { p, parameters, correlation } = reported(&parametrization, &theta, covariance.as_ref());
        Self {
            kind: parametrization.kind,
            law: parametrization.kind.law(&p),
            parameters,
            correlation,
            chi_squared: best.sum,
            residuals,
            sigma_known,
            converged: best.converged,
            starts: followed,
            agreeing: agreeing + near,
            correlated: None,
            parametrization,
            theta,
            rivals,
            covariance,
        }
    }

    /// With the standard deviations that residuals have which neighbouring lines share; `lines` at this law, in its coordinates.
    pub(crate) fn widened(mut self, lines: &[LineResidual]) -> Self {
        let n = self.theta.len();
        let unit = scale(self.chi_squared, self.residuals, n, self.sigma_known);
        let found = self.covariance.as_ref().zip(correlation(lines)).filter(|_| unit > 0.0);
        let Some((covariance, process)) = found else { return self };
        let inverse: Vec<Vec<f64>> =
            covariance.iter().map(|row| row.iter().map(|value| value / unit).collect()).collect();
        let shared = shared_covariance(lines, process, &inverse);
        let wider: Vec<Vec<f64>> = covariance
            .iter()
            .zip(&shared)
            .map(|(own, shared)| own.iter().zip(shared).map(|(own, shared)| own + shared).collect())
            .collect();
        let Reported { parameters, correlation, .. } =
            reported(&self.parametrization, &self.theta, Some(&wider));
        let factor =
            |(wide, own): (&Estimate, &Estimate)| Some(wide.std? / own.std?).filter(|by| by.is_finite());
        self.correlated = Some(Correlated {
            lines: -1.0 / process.persistence.ln(),
            size: process.variance.sqrt(),
            widened: parameters.iter().zip(&self.parameters).map(factor).collect(),
        });
        (self.parameters, self.correlation, self.covariance) = (parameters, correlation, Some(wider));
        self
    }

    /// With another covariance of θ, as that with errors of the model in it.
    pub(crate) fn with_covariance(mut self, covariance: Vec<Vec<f64>>) -> Self {
        let Reported { parameters, correlation, .. } =
            reported(&self.parametrization, &self.theta, Some(&covariance));
        (self.parameters, self.correlation, self.covariance) = (parameters, correlation, Some(covariance));
        self
    }

    /// With what else θ is uncertain by.
    pub(crate) fn with_larger_covariance(self, by: &[f64]) -> Self {
        let sum = |(own, by): (&Vec<f64>, &[f64])| own.iter().zip(by).map(|(own, by)| own + by).collect();
        let larger = |own: &Vec<Vec<f64>>| own.iter().zip(by.chunks_exact(own.len())).map(sum).collect();
        match self.covariance.as_ref().map(larger) {
            Some(covariance) => self.with_covariance(covariance),
            None => self,
        }
    }

    /// With noise that is larger by the factor `times`.
    pub(crate) fn with_noise(self, times: f64) -> Self {
        let scaled = |covariance: &Vec<Vec<f64>>| {
            covariance.iter().map(|row| row.iter().map(|value| times * times * value).collect()).collect()
        };
        match self.covariance.as_ref().map(scaled) {
            Some(covariance) if times > 1.0 => self.with_covariance(covariance),
            _ => self,
        }
    }

    /// The moduli that other minima, which the data cannot exclude, have at a frequency.
    pub(crate) fn rivals_at(&self, frequency_hz: f64) -> Vec<c64> {
        let at = |theta: &Vec<f64>| self.parametrization.modulus(theta, omega_rad_s(frequency_hz));
        self.rivals.iter().filter_map(at).map(|(modulus, _)| modulus).collect()
    }

    /// Residuals less parameters.
    pub fn degrees_of_freedom(&self) -> usize {
        self.residuals.saturating_sub(self.parameters.len())
    }

    /// χ² per degree of freedom: about one where the standard deviations are known and the law is right. `None` without a degree of freedom.
    pub fn reduced_chi_squared(&self) -> Option<f64> {
        let freedom = self.degrees_of_freedom();
        (freedom > 0).then(|| self.chi_squared / freedom as f64)
    }

    /// Bayes' information criterion, up to what all laws share: χ² + k ln n with known standard deviations, n ln(χ²/n) + k ln n otherwise. The least is the best; ten less is
    /// decisive.
    ///
    /// # Source
    /// G. Schwarz, Ann. Statist. 6 (1978) 461–464; R. E. Kass, A. E. Raftery, J. Amer. Statist. Assoc. 90 (1995) 773–795.
    pub fn bic(&self) -> f64 {
        self.misfit() + self.parameters.len() as f64 * (self.residuals as f64).ln()
    }

    /// Akaike's information criterion, as [`LawFit::bic`] with 2k in place of k ln n.
    ///
    /// # Source
    /// H. Akaike, IEEE Trans. Autom. Control 19 (1974) 716–723.
    pub fn aic(&self) -> f64 {
        self.misfit() + 2.0 * self.parameters.len() as f64
    }

    fn misfit(&self) -> f64 {
        let n = self.residuals as f64;
        match self.sigma_known {
            true => self.chi_squared,
            // Data without any noise: the residuals are roundoff, and no law is better than another for having less of it.
            false => n * (self.chi_squared / n).max(EXACT_REDUCED_CHI_SQUARED).ln(),
        }
    }

    /// The same law with moduli at real frequencies, whatever the window through which it was fitted.
    pub(crate) fn at_real_frequencies(self) -> Self {
        Self { parametrization: self.parametrization.through_window(0.0), ..self }
    }

    /// E at a frequency, with the standard deviations that those of the parameters make.
    pub fn at(&self, frequency_hz: f64) -> Option<ModulusEstimate> {
        let (modulus, slopes) = self.parametrization.modulus(&self.theta, omega_rad_s(frequency_hz))?;
        let eta = loss_factor(modulus);
        let storage: Vec<f64> = slopes.iter().map(|slope| slope.re).collect();
        let loss: Vec<f64> = slopes.iter().map(|slope| (slope.im - eta * slope.re) / modulus.re).collect();
        // A variance of roundoff's size may come out below zero.
        let std = |gradient: &[f64]| Some(self.covariance_of(gradient, gradient)?.max(0.0).sqrt());
        let (storage_std, loss_factor_std) = (std(&storage), std(&loss));
        let product = storage_std.zip(loss_factor_std).map(|(a, b)| a * b).filter(|&product| product > 0.0);
        let correlation = product.and_then(|product| Some(self.covariance_of(&storage, &loss)? / product));
        Some(ModulusEstimate { modulus, storage_std, loss_factor_std, correlation })
    }

    /// ∂E′/∂θ at a frequency.
    pub(crate) fn real_slopes(&self, frequency_hz: f64) -> Option<Vec<f64>> {
        let (_, slopes) = self.parametrization.modulus(&self.theta, omega_rad_s(frequency_hz))?;
        Some(slopes.iter().map(|slope| slope.re).collect())
    }

    /// θ.
    pub(crate) fn coordinates(&self) -> (&Parametrization, &[f64]) {
        (&self.parametrization, &self.theta)
    }

    /// gᵀ Cov h over the coordinates that are identifiable.
    pub(crate) fn covariance_of(&self, g: &[f64], h: &[f64]) -> Option<f64> {
        let covariance = self.covariance.as_ref()?;
        let known: Vec<usize> = (0..g.len()).filter(|&i| covariance[i][i].is_finite()).collect();
        let row = |&i: &usize| known.iter().map(|&j| g[i] * covariance[i][j] * h[j]).sum::<f64>();
        Some(known.iter().map(row).sum())
    }
}

/// Parameters as users know them.
struct Reported {
    p: Vec<f64>,
    parameters: Vec<Estimate>,
    correlation: Option<Vec<Vec<f64>>>,
}

/// From the coordinates and their covariance to the parameters and theirs, by the delta rule.
fn reported(
    parametrization: &Parametrization,
    theta: &[f64],
    covariance: Option<&Vec<Vec<f64>>>,
) -> Reported {
    let n = theta.len();
    let (p, chain) = parametrization.parameters(theta);
    let natural = covariance.map(|covariance| carried(&chain, covariance));
    let std = |i: usize| natural.as_ref().map(|c| c[i][i].sqrt()).filter(|std| std.is_finite());
    let parameters = parametrization.kind.parameters().into_iter().zip(&p).enumerate();
    let parameters = parameters
        .map(|(i, (named, &value))| Estimate {
            name: named.name.into_owned(),
            unit: named.kind.unit(),
            value,
            std: std(i),
        })
        .collect();
    let correlation = natural.map(|c| {
        let entry = |i: usize, j: usize| if i == j { 1.0 } else { c[i][j] / (c[i][i] * c[j][j]).sqrt() };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect::<Vec<f64>>()).collect::<Vec<_>>()
    });
    let correlation = correlation.filter(|rows| rows.iter().flatten().all(|value| value.is_finite()));
    Reported { p, parameters, correlation }
}

/// χ² per number below which the rest is roundoff of numbers that are known to themselves.
const EXACT_REDUCED_CHI_SQUARED: f64 = 1e-28;

/// What χ² is in units of: one where the standard deviations are known, else χ² per degree of freedom.
fn scale(sum: f64, residuals: usize, parameters: usize, sigma_known: bool) -> f64 {
    if sigma_known { 1.0 } else { sum / residuals.saturating_sub(parameters).max(1) as f64 }
}

/// A Cov Aᵀ, of the rows that do not hang on coordinates without a standard deviation.
fn carried(a: &[Vec<f64>], covariance: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let entry = |x: &Vec<f64>, y: &Vec<f64>| {
        let mut sum = 0.0;
        for (i, xi) in x.iter().enumerate().filter(|(_, xi)| **xi != 0.0) {
            for (j, yj) in y.iter().enumerate().filter(|(_, yj)| **yj != 0.0) {
                sum += xi * covariance[i][j] * yj;
            }
        }
        sum
    };
    a.iter().map(|x| a.iter().map(|y| entry(x, y)).collect()).collect()
}

/// The columns of a Jacobian in the order in which its branches are sorted.
fn reordered(parametrization: &Parametrization, before: &[f64], after: &[f64], jacobian: &[f64]) -> Vec<f64> {
    let LawKind::Maxwell { .. } = parametrization.kind else { return jacobian.to_vec() };
    let m = jacobian.len() / before.len();
    let column = |j: usize| &jacobian[j * m..(j + 1) * m];
    let mut free: Vec<usize> = (1..before.len()).step_by(2).collect();
    let mut ordered = column(0).to_vec();
    for branch in after[1..].chunks_exact(2) {
        let at = free.iter().position(|&j| before[j..j + 2] == *branch).unwrap_or(0);
        let j = free.remove(at);
        ordered.extend(column(j).iter().chain(column(j + 1)));
    }
    ordered
}

/// The law of least BIC among those whose search has converged, or failing that of all.
pub fn best(fits: &[LawFit]) -> Option<&LawFit> {
    fits.iter().min_by(|a, b| b.converged.cmp(&a.converged).then(a.bic().total_cmp(&b.bic())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn branches_and_their_jacobian_are_sorted_alike() {
        let parametrization = Parametrization {
            kind: LawKind::Maxwell { branches: 2 },
            reference_rad_s: 1.0,
            decay_per_s: 0.0,
        };
        let theta = [0.0, 1.0, 5.0, 2.0, 3.0];
        let sorted = parametrization.sorted(&theta);
        assert_eq!(sorted, [0.0, 2.0, 3.0, 1.0, 5.0]);
        assert_eq!(
            reordered(&parametrization, &theta, &sorted, &[0.0, 1.0, 2.0, 3.0, 4.0]),
            [0.0, 3.0, 4.0, 1.0, 2.0]
        );
    }
}
