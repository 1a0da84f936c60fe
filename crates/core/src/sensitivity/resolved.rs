//! How well the sensors of a band identify the parameters.

use super::SensitivityBand;
use crate::c64;
use crate::subspace::Changed;
use frfit_linalg::dense::{NoConvergence, Singular, singular};

/// Standard deviations √E|δx|² of the receptance, `[frequency][sensor]`; the real and the imaginary part have 1/√2 of it each.
pub type StandardDeviations = Vec<Vec<f64>>;

/// Components of a singular vector below this are roundoff: a direction orthogonal to an unseen one does not suffer from it.
const COMPONENT_TOL: f64 = 1e-6;

/// The Jacobian J of real and imaginary parts of all x over their standard deviations by ln p, as singular values ς and right singular vectors.
///
/// With noise alone in the way Cov(ln p) = (JᵀJ)⁻¹, so that the combination vᵢᵀ ln p has the standard deviation 1/ςᵢ.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolved {
    singular: Singular,
    /// Singular values below this cannot be distinguished from zero.
    floor: f64,
}

impl SensitivityBand<'_> {
    /// StandardDeviations in proportion to the response: `relative` of |x| at every sensor.
    pub fn proportional(&self, relative: f64) -> StandardDeviations {
        let std = |x: &c64| relative * x.norm();
        let row = |at: &Option<Changed>| -> Vec<f64> {
            at.iter().flat_map(|changed| changed.response.iter().map(std)).collect()
        };
        self.at.iter().map(row).collect()
    }

    /// The Jacobian over all frequencies and the chosen sensors. Values without a positive finite standard deviation have no say.
    ///
    /// # Errors
    /// [`NoConvergence`] where its singular values are not found.
    ///
    /// # Panics
    /// Where a standard deviation is missing at a frequency with a response, or there is no such sensor.
    pub fn resolved(&self, std: &StandardDeviations, sensors: &[usize]) -> Result<Resolved, NoConvergence> {
        let count = self.variables.len();
        let mut columns = vec![Vec::new(); count];
        let mut error = 0.0f64;
        for (at, std) in self.at.iter().zip(std) {
            let Some(changed) = at else { continue };
            for &m in sensors {
                let weight = 2f64.sqrt() / std[m];
                if !(weight.is_finite() && weight > 0.0) {
                    continue;
                }
                for (p, column) in columns.iter_mut().enumerate() {
                    let slope = changed.slopes[p][m] * weight;
                    column.extend([slope.re, slope.im]);
                    error = error.hypot(weight * changed.slope_error(p, m));
                }
            }
        }
        Resolved::new(&columns.concat(), count, error)
    }
}

impl Resolved {
    /// From the scaled Jacobian, column after column, whose Frobenius norm may be wrong by `error`.
    ///
    /// # Errors
    /// [`NoConvergence`] where its singular values are not found.
    pub fn new(jacobian: &[f64], variables: usize, error: f64) -> Result<Self, NoConvergence> {
        let singular = singular(jacobian, variables)?;
        let largest = singular.values.first().copied().unwrap_or(0.0);
        // Roundoff of as many columns, and what the Jacobian itself may be wrong by (Weyl).
        let floor = error + 4.0 * variables as f64 * f64::EPSILON * largest;
        Ok(Self { singular, floor })
    }

    /// Number of variables.
    pub fn variables(&self) -> usize {
        self.singular.values.len()
    }

    /// Combinations vᵢᵀ ln p with their standard deviations, the best known first; `None` for those that no sensor sees.
    pub fn combinations(&self) -> impl Iterator<Item = (&[f64], Option<f64>)> {
        let seen = |value: f64| (value > self.floor).then_some(1.0 / value);
        let all = self.singular.vectors.iter().zip(&self.singular.values);
        all.map(move |(v, &value)| (v.as_slice(), seen(value)))
    }

    /// Standard deviation of Σ u_p ln p with all variables unknown; `None` where it has a part that no sensor sees.
    ///
    /// # Panics
    /// Where there is not one coefficient for each variable.
    pub fn std(&self, combination: &[f64]) -> Option<f64> {
        assert_eq!(combination.len(), self.variables());
        let length = combination.iter().map(|u| u * u).sum::<f64>().sqrt();
        let mut variance = 0.0;
        for (v, std) in self.combinations() {
            let part: f64 = v.iter().zip(combination).map(|(v, u)| v * u).sum();
            match std {
                Some(std) => variance += (part * std).powi(2),
                None if part.abs() <= COMPONENT_TOL * length => {}
                None => return None,
            }
        }
        Some(variance.sqrt())
    }

    /// Error bar of each variable: the standard deviation of ln p with all others unknown too, relative to p where it is small.
    pub fn bars(&self) -> Vec<Option<f64>> {
        let unit = |p: usize| (0..self.variables()).map(|q| f64::from(u8::from(p == q))).collect::<Vec<_>>();
        (0..self.variables()).map(|p| self.std(&unit(p))).collect()
    }
}
