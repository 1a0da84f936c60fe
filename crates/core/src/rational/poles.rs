//! The reduced response as a sum over its poles, for a parameter that enters linearly: x_m(z) = Σ_k ρ_mk / (1 + z λ_k).

use super::RationalResponse;
use crate::c64;
use frfit_linalg::dense::{Eigen, Ldlt, Lu, Matrix, NoConvergence, eigen};
use frfit_linalg::vector::transpose_dot;

/// Poles and residues: the response and its slope at all sensors for n multiplications each.
#[derive(Debug, Clone, PartialEq)]
pub struct Poles {
    pub(super) scale: f64,
    /// λ_k, eigenvalues of M₀⁻¹M₁; the poles are at c = −s/λ_k.
    pub(super) lambda: Vec<c64>,
    /// `residues[m][k]` is ρ_mk.
    pub(super) residues: Vec<Vec<c64>>,
}

impl RationalResponse {
    /// The poles of the reduced response; `None` for a parameter that enters with powers, or where nothing is driven.
    ///
    /// # Errors
    /// [`NoConvergence`] where the eigenvalue iteration fails, or the eigenvectors are dependent to working precision.
    ///
    /// # Limits
    /// Loses digits where poles nearly coincide: good for the way to a solution, not for its last digits.
    pub fn poles(&self) -> Result<Option<Poles>, NoConvergence> {
        let [nominal, change] = self.matrices.as_slice() else { return Ok(None) };
        let n = self.size();
        if n == 0 {
            return Ok(None);
        }
        let factor = Ldlt::new(nominal)?;
        let mut block: Vec<c64> = (0..n).flat_map(|j| change.column(j)).chain(&self.load).copied().collect();
        factor.solve(&mut block)?;
        let g = Matrix::from_fn(n, n, |i, j| block[i + j * n]);
        let Eigen { values: lambda, vectors } = eigen(&g)?;
        let mut weights = block[n * n..].to_vec();
        Lu::new(&vectors)?.solve(&mut weights)?;
        let residue =
            |l: &Vec<c64>| (0..n).map(|k| transpose_dot(l, vectors.column(k)) * weights[k]).collect();
        Ok(Some(Poles { scale: self.scale, lambda, residues: self.sensors.iter().map(residue).collect() }))
    }
}

impl Poles {
    /// x_m(c) at all sensors.
    pub fn respond(&self, correction: c64) -> Vec<c64> {
        self.values(&self.inverses(correction))
    }

    /// 1/(1 + zλ_k).
    fn inverses(&self, correction: c64) -> Vec<c64> {
        let z = correction / self.scale;
        self.lambda.iter().map(|lambda| (1.0 + z * lambda).inv()).collect()
    }

    /// Σ_k ρ_mk/(1 + zλ_k) at all sensors.
    fn values(&self, inverse: &[c64]) -> Vec<c64> {
        let value = |residues: &Vec<c64>| residues.iter().zip(inverse).map(|(rho, d)| rho * d).sum();
        self.residues.iter().map(value).collect()
    }

    /// x_m(c) and ∂x_m/∂c at all sensors.
    pub fn respond_with_slope(&self, correction: c64) -> (Vec<c64>, Vec<c64>) {
        let inverse = self.inverses(correction);
        let slope = |residues: &Vec<c64>| {
            let terms = residues.iter().zip(&inverse).zip(&self.lambda);
            -terms.map(|((rho, d), lambda)| rho * lambda * d * d).sum::<c64>() / self.scale
        };
        (self.values(&inverse), self.residues.iter().map(slope).collect())
    }

    /// ∂²x_m/∂c² at all sensors: Σ_k 2 ρ_mk λ_k² / (1 + zλ_k)³ s⁻².
    pub fn second_derivative(&self, correction: c64) -> Vec<c64> {
        let z = correction / self.scale;
        let weights: Vec<c64> = self
            .lambda
            .iter()
            .map(|lambda| 2.0 * (lambda / self.scale).powi(2) * (1.0 + z * lambda).powi(-3))
            .collect();
        let second = |residues: &Vec<c64>| residues.iter().zip(&weights).map(|(rho, w)| rho * w).sum();
        self.residues.iter().map(second).collect()
    }

    /// The order that the Neumann series at a sensor needs for a relative truncation error at the correction c; `None` where it
    /// diverges (P-14).
    ///
    /// A pole's share of what is cut off after order n is ρ_k (−zλ_k)^{n+1} / (1 + zλ_k): each share is brought below the error.
    ///
    /// # Limits
    /// Roundoff of the series is not in it.
    pub fn required_order(&self, sensor: usize, correction: c64, error: f64) -> Option<usize> {
        let z = correction / self.scale;
        let allowed = error * self.respond_with_slope(correction).0[sensor].norm();
        let residues = &self.residues[sensor];
        let least = least(residues);
        let mut most = 0;
        for (lambda, rho) in self.lambda.iter().zip(residues) {
            let size = (z * lambda).norm();
            if size >= 1.0 {
                if rho.norm() > least {
                    return None;
                }
                continue;
            }
            let share = (rho / (1.0 + z * lambda)).norm();
            // Smallest n with share · size^{n+1} <= allowed: most poles are far, and need less than one that is near.
            if share * size.powi(most + 1) > allowed {
                let orders = ((allowed / share).ln() / size.ln()).ceil();
                most = if orders < f64::from(i32::MAX) { orders as i32 - 1 } else { return None };
            }
        }
        usize::try_from(most).ok()
    }

    /// ρ/|c|: one over the distance to the nearest pole (P-14).
    ///
    /// # Limits
    /// A pole that the load does not excite, or no sensor sees, is left out; it does not bound the series of this response either.
    pub fn radius_per_unit(&self) -> f64 {
        let seen = self.seen();
        let moduli =
            self.lambda.iter().enumerate().filter(|&(k, _)| seen[k]).map(|(_, lambda)| lambda.norm());
        moduli.fold(0.0, f64::max) / self.scale
    }

    /// Whether the load excites each pole and a sensor sees it.
    pub(super) fn seen(&self) -> Vec<bool> {
        let least: Vec<f64> = self.residues.iter().map(|residues| least(residues)).collect();
        let by =
            |k: usize| self.residues.iter().zip(&least).any(|(residues, least)| residues[k].norm() > *least);
        (0..self.lambda.len()).map(by).collect()
    }
}

/// A residue of less than this part of the largest is roundoff: the mode is not driven, or not seen.
const RESIDUE_RTOL: f64 = 1e-12;

fn least(residues: &[c64]) -> f64 {
    RESIDUE_RTOL * residues.iter().map(|rho| rho.norm()).fold(0.0, f64::max)
}
