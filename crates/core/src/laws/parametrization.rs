//! Coordinates θ of a law's parameters p in which every constraint holds automatically.

use super::LineResidual;
use super::{Datum, LawKind, ParameterKind};
use crate::c64;
use crate::least_squares::Residuals;

/// θ ↔ p about a reference frequency.
///
/// Moduli and times are logarithms, exponents are logits, and E∞ − E₀ stands for E∞, as [`ParameterKind`] says:
///
/// | family | θ |
/// |---|---|
/// | constant | ln E′, η |
/// | fractional | ln E₀, ln(E₁ ω₀^α), logit α |
/// | zener | ln E₀, ln(E∞ − E₀), ln(τ ω₀), logit α |
/// | maxwell | ln E₀, ln E_k, ln(τ_k ω₀) … |
///
/// At the reference frequency ω₀, in the middle of the data, E₁ω₀^α is identifiable; E₁ alone hangs on α from 1 rad/s up. So every law but the constant one is passive
/// whatever θ is. The loss factor of the constant one is free in sign: a negative one says that the data follow the other time convention, or that noise
/// hides the damping, and is not to be forced away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parametrization {
    pub(crate) kind: LawKind,
    /// ω₀, rad/s.
    pub(crate) reference_rad_s: f64,
    /// The decay α in 1/s of a window through which the modulus is seen: that at iω + α.
    pub(crate) decay_per_s: f64,
}

/// Logits beyond this leave no digit between α and 0 or 1.
const MAX_LOGIT: f64 = 36.0;

impl Parametrization {
    /// p, and ∂p_i/∂θ_j as row i, column j.
    pub(crate) fn parameters(&self, theta: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let n = self.kind.count();
        let mut slopes = vec![vec![0.0; n]; n];
        let reference = self.reference_rad_s;
        // α(1 − α) without cancellation at either end.
        let logistic = |t: f64| {
            let alpha = 1.0 / (1.0 + (-t).exp());
            (alpha, alpha / (1.0 + t.exp()))
        };
        let exponent = self.kind.place_of(ParameterKind::Exponent).map(|k| (k, logistic(theta[k])));
        let mut p = vec![0.0; n];
        for i in 0..n {
            let exponential = theta[i].exp();
            (p[i], slopes[i][i]) = match self.kind.parameter_kind(i) {
                ParameterKind::Modulus => (exponential, exponential),
                ParameterKind::ModulusAboveFirst => {
                    slopes[i][0] = p[0];
                    (p[0] + exponential, exponential)
                }
                ParameterKind::ModulusTimesPower => {
                    let (k, (alpha, slope)) = exponent.unwrap_or_default();
                    let modulus = (theta[i] - alpha * reference.ln()).exp();
                    slopes[i][k] = -modulus * reference.ln() * slope;
                    (modulus, modulus)
                }
                ParameterKind::Time => (exponential / reference, exponential / reference),
                ParameterKind::Exponent => logistic(theta[i]),
                ParameterKind::LossFactor => (theta[i], 1.0),
            };
        }
        (p, slopes)
    }

    /// θ of parameters that satisfy the constraints; what is on their edge comes to stand just inside.
    pub(crate) fn coordinates(&self, p: &[f64]) -> Vec<f64> {
        let log = |x: f64| x.max(f64::MIN_POSITIVE).ln();
        let logit = |x: f64| (log(x) - log(1.0 - x)).clamp(-MAX_LOGIT, MAX_LOGIT);
        let reference = self.reference_rad_s;
        let alpha = self.kind.place_of(ParameterKind::Exponent).map_or(0.0, |k| p[k]);
        let coordinate = |i: usize| match self.kind.parameter_kind(i) {
            ParameterKind::Modulus => log(p[i]),
            ParameterKind::ModulusAboveFirst => log(p[i] - p[0]),
            ParameterKind::ModulusTimesPower => log(p[i]) + alpha * reference.ln(),
            ParameterKind::Time => log(p[i] * reference),
            ParameterKind::Exponent => logit(p[i]),
            ParameterKind::LossFactor => p[i],
        };
        (0..p.len()).map(coordinate).collect()
    }

    /// E at iω + α and ∂E/∂θ; `None` where a number is not finite.
    pub(crate) fn modulus(&self, theta: &[f64], omega_rad_s: f64) -> Option<(c64, Vec<c64>)> {
        let (p, chain) = self.parameters(theta);
        let (modulus, of_p) = self.kind.with_slopes(&p, c64::new(self.decay_per_s, omega_rad_s));
        let of_theta: Vec<c64> = (0..theta.len())
            .map(|j| of_p.iter().zip(&chain).map(|(slope, row)| slope * row[j]).sum())
            .collect();
        let finite = modulus.is_finite() && of_theta.iter().all(|slope| slope.is_finite());
        finite.then_some((modulus, of_theta))
    }

    /// The law with all its moduli multiplied by e^`by`.
    pub(crate) fn scaled(&self, theta: &[f64], by: f64) -> Vec<f64> {
        let is_modulus = |i: usize| self.kind.parameter_kind(i).is_modulus();
        theta.iter().enumerate().map(|(i, t)| if is_modulus(i) { t + by } else { *t }).collect()
    }

    /// Whitened E(θ) − E over some data, and its slopes; `None` where a number is not finite.
    pub(crate) fn residuals(&self, data: &[Datum], theta: &[f64]) -> Option<Residuals> {
        let mut residuals = Vec::with_capacity(2 * data.len());
        let mut columns: Vec<Vec<f64>> = vec![Vec::with_capacity(2 * data.len()); theta.len()];
        for datum in data {
            let (modulus, slopes) = self.modulus(theta, datum.omega_rad_s)?;
            residuals.extend(datum.residual(modulus));
            for (column, slope) in columns.iter_mut().zip(slopes) {
                column.extend(datum.slope(modulus, slope));
            }
        }
        Some((residuals, columns.concat()))
    }

    /// What a law leaves of each datum in ln E, and what that pulls; the real and the imaginary part of ln E as if they were two data.
    pub(crate) fn lines(&self, data: &[Datum], theta: &[f64]) -> Vec<LineResidual> {
        let line = |datum: &Datum| {
            let (modulus, slopes) = self.modulus(theta, datum.omega_rad_s)?;
            let rest = datum.residual(modulus);
            // By how much the residual changes with ln E.
            let of_log = [modulus, modulus * c64::i()].map(|change| datum.slope(modulus, change));
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            let weight = of_log.map(|a| dot(a, a));
            let pull = |c: usize| slopes.iter().map(|&s| dot(datum.slope(modulus, s), of_log[c])).collect();
            Some(LineResidual {
                weight,
                rest: [0, 1].map(|c| -dot(of_log[c], rest) / weight[c]),
                pull: [pull(0), pull(1)],
            })
        };
        data.iter().filter_map(line).collect()
    }

    /// The same law with its branches in the order of their times.
    pub(crate) fn sorted(&self, theta: &[f64]) -> Vec<f64> {
        let mut sorted = theta.to_vec();
        if let LawKind::Maxwell { .. } = self.kind {
            let mut branches: Vec<&[f64]> = theta[1..].chunks_exact(2).collect();
            branches.sort_by(|a, b| a[1].total_cmp(&b[1]));
            sorted[1..].copy_from_slice(&branches.concat());
        }
        sorted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_coordinates() -> impl Strategy<Value = (Parametrization, Vec<f64>)> {
        let kind = proptest::sample::select(LawKind::ALL.to_vec());
        (kind, 0.1f64..1e4).prop_flat_map(|(kind, reference_rad_s)| {
            // Moduli over 14 decades, exponents from 0.002 to 0.998, times within e^6 of the reference.
            let theta = proptest::collection::vec(-6.0f64..6.0, kind.count());
            theta.prop_map(move |theta| (Parametrization { kind, reference_rad_s, decay_per_s: 0.0 }, theta))
        })
    }

    proptest! {
        #[test]
        fn coordinates_come_back((parametrization, theta) in any_coordinates()) {
            let (p, _) = parametrization.parameters(&theta);
            let back = parametrization.coordinates(&p);
            for (a, b) in theta.iter().zip(&back) {
                // ln(E∞ − E₀) loses what E₀/(E∞ − E₀) ≤ e^12 takes: eleven digits are left of sixteen. So it is with logits.
                prop_assert!((a - b).abs() < 1e-9, "{theta:?} {back:?}");
            }
        }

        #[test]
        fn every_law_is_passive_and_causal_in_its_limits((parametrization, theta) in any_coordinates(), at in -7.0f64..7.0) {
            let omega = parametrization.reference_rad_s * at.exp();
            let (e, _) = parametrization.modulus(&theta, omega).unwrap();
            prop_assert!(e.re > 0.0);
            if parametrization.kind != LawKind::Constant {
                prop_assert!(e.im >= 0.0, "{e}");
                // What is lost at some frequency is a gain of stiffness above it.
                let (above, _) = parametrization.modulus(&theta, 1.5 * omega).unwrap();
                prop_assert!(above.re >= e.re * (1.0 - 1e-14));
            }
            let (p, _) = parametrization.parameters(&theta);
            prop_assert!(parametrization.kind == LawKind::Constant || p.iter().all(|&p| p > 0.0));
            // The law that is written out is the law that was fitted.
            let law = parametrization.kind.law(&p).at(omega / std::f64::consts::TAU).unwrap();
            prop_assert!((law - e).norm() <= 1e-13 * e.norm());
        }

        #[test]
        fn slopes_are_those_of_differences((parametrization, theta) in any_coordinates(), at in -5.0f64..5.0) {
            let omega = parametrization.reference_rad_s * at.exp();
            let (e, slopes) = parametrization.modulus(&theta, omega).unwrap();
            // Central differences: h² of truncation times a third derivative (up to (ln ωτ)³ ≈ 1e3 E), and ε/h of roundoff.
            let h = 1e-4;
            for (j, slope) in slopes.iter().enumerate() {
                let moved = |by: f64| {
                    let mut theta = theta.clone();
                    theta[j] += by;
                    parametrization.modulus(&theta, omega).unwrap().0
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                prop_assert!((difference - slope).norm() <= 1e-5 * e.norm(), "{j}: {difference} {slope} of {e}");
            }
        }

        #[test]
        fn slopes_of_natural_parameters_are_those_of_differences((parametrization, theta) in any_coordinates(), at in -5.0f64..5.0) {
            let omega = parametrization.reference_rad_s * at.exp();
            let (p, _) = parametrization.parameters(&theta);
            let (e, slopes) = parametrization.kind.with_slopes(&p, c64::new(0.0, omega));
            for (j, slope) in slopes.iter().enumerate() {
                // Relative steps: h ∂E/∂p is up to 1e-4 E, and what differences leave of it h³∂³E/∂p³/6 of up to 1e3 times the cube of 1e-4.
                let h = 1e-4 * p[j].abs().max(1e-12);
                let moved = |by: f64| {
                    let mut p = p.clone();
                    p[j] += by;
                    parametrization.kind.with_slopes(&p, c64::new(0.0, omega)).0
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                prop_assert!((difference - slope).norm() * h <= 1e-8 * e.norm(), "{j}: {difference} {slope}");
            }
        }

        #[test]
        fn scaling_multiplies_the_modulus((parametrization, theta) in any_coordinates(), by in -1.0f64..1.0) {
            let at = |theta: &[f64]| parametrization.modulus(theta, parametrization.reference_rad_s).unwrap().0;
            let (before, after) = (at(&theta), at(&parametrization.scaled(&theta, by)));
            // exp(θ + by) and exp(θ)·exp(by) differ by some ε.
            prop_assert!((after - by.exp() * before).norm() <= 1e-13 * after.norm());
        }

        #[test]
        fn branches_are_in_the_order_of_their_times((parametrization, theta) in any_coordinates()) {
            let sorted = parametrization.sorted(&theta);
            let (p, _) = parametrization.parameters(&sorted);
            if let LawKind::Maxwell { .. } = parametrization.kind {
                prop_assert!(p[1..].chunks_exact(2).map(|b| b[1]).is_sorted());
            }
            let at = |theta: &[f64]| parametrization.modulus(theta, parametrization.reference_rad_s).unwrap().0;
            prop_assert!((at(&theta) - at(&sorted)).norm() <= 1e-14 * at(&theta).norm());
        }
    }
}
