//! The series in one parameter.

use super::recursion::{next_term, scale};
use crate::c64;
use crate::response::Response;
use frfit_linalg::dense::evaluate;
use frfit_linalg::solve::Breakdown;
use std::collections::VecDeque;

/// Scaled Taylor coefficients of the response at every sensor, about the nominal value of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct NeumannSeries {
    /// s in z = c/s; of the unit of the parameter.
    scale: f64,
    /// `terms[m][k]` is t_k = s^k/k! ∂ᵏx_m/∂cᵏ at sensor m, a receptance.
    terms: Vec<Vec<c64>>,
}

impl NeumannSeries {
    /// The series of order n in parameter j: n + 1 solves with the nominal factor.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve with A₀ fails.
    ///
    /// # Limits
    /// Converges iff ρ(−c A₀⁻¹A₁) < 1, P-14: see [`convergence_radius`](super::convergence_radius).
    pub fn new(system: &impl Response, parameter: usize, order: usize) -> Result<Self, Breakdown> {
        let mut x = system.load().to_vec();
        system.solve_nominal(&mut x)?;
        let mut terms: Vec<Vec<c64>> = system.observe(&x).into_iter().map(|t| vec![t]).collect();
        let degree = system.degree(parameter);
        let scale = scale(system, parameter)?;
        // v_{k−1}, v_{k−2}, … v_{k−d}
        let mut recent = VecDeque::from([x]);
        for _ in 1..=order {
            let next = next_term(system, parameter, scale, &recent)?;
            for (sensor, t) in terms.iter_mut().zip(system.observe(&next)) {
                sensor.push(t);
            }
            recent.push_front(next);
            recent.truncate(degree.max(1));
        }
        Ok(Self { scale, terms })
    }

    /// A series of [`Self::scale`] and the [`Self::coefficients`] of each sensor, as another has them; `None` where
    /// the scale is not positive and finite, or sensors have none or different numbers of them.
    pub fn from_coefficients(scale: f64, terms: Vec<Vec<c64>>) -> Option<Self> {
        let count = terms.first().map_or(0, Vec::len);
        let is_sound = scale.is_finite() && scale > 0.0 && count > 0;
        (is_sound && terms.iter().all(|t| t.len() == count)).then_some(Self { scale, terms })
    }

    /// Order n.
    pub fn order(&self) -> usize {
        self.terms.first().map_or(0, |t| t.len() - 1)
    }

    /// Number of sensors.
    pub fn sensors(&self) -> usize {
        self.terms.len()
    }

    /// s in z = c/s.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// t_0 … t_n at a sensor: the coefficients of the response as a polynomial in z.
    pub fn coefficients(&self, sensor: usize) -> &[c64] {
        &self.terms[sensor]
    }

    /// Receptance at the sensors with the correction c, truncated after `order` terms beyond the nominal, P-17.
    pub fn respond(&self, correction: c64, order: usize) -> Vec<c64> {
        let z = correction / self.scale;
        self.terms.iter().map(|t| evaluate(&t[..=order.min(t.len() - 1)], z)).collect()
    }

    /// ∂ᵏx/∂cᵏ at the sensors and the nominal value, P-26: m/N over the parameter's unit to the k-th power.
    ///
    /// # Limits
    /// In Pa the tenth derivative of a steel structure is of the order of 1e-110: the highest ones underflow to
    /// zero in double precision. Relative sensitivities ([`Self::coefficients`]) do not.
    pub fn derivative(&self, k: usize) -> Option<Vec<c64>> {
        let unscale = |t: c64| (1..=k).fold(t, |value, j| value * (j as f64 / self.scale));
        (k <= self.order()).then(|| self.terms.iter().map(|t| unscale(t[k])).collect())
    }

    /// P-30 in z at a sensor with the measured receptance u: Σ t_k z^k − u, up to `order`.
    pub fn mismatch_polynomial(&self, sensor: usize, measured: c64, order: usize) -> Vec<c64> {
        let t = &self.terms[sensor];
        let mut polynomial = t[..=order.min(t.len() - 1)].to_vec();
        polynomial[0] -= measured;
        polynomial
    }
}
