//! Derivatives of the response by several parameters on the reduced model, and how good they are.
//!
//! With A_p = ∂D/∂ln p, x = D⁻¹F and z_m = D⁻¹ℓ_m, both symmetric in load and sensor:
//! $$ \frac{\partial x_m}{\partial \ln p} = -z_m^T A_p x = \ell_m^T w_p = F^T u_{m,p}, \qquad w_p = -D^{-1} A_p x, \quad u_{m,p} = -D^{-1} A_p z_m. $$
//! Residuals of Galerkin solutions are at right angles to the basis, so that what the basis lacks enters as products of two residuals: the error of the
//! derivative is r_zᵀD⁻¹r_w + r_xᵀD⁻¹r_u − e_zᵀA_p e_x, e the errors of the solutions. It is estimated by the first two, γ(‖r_z‖‖r_w‖ + ‖r_x‖‖r_u‖); the last is of
//! second order in r_x and r_z, where the others have one factor of these.

use super::Projection;
use super::assess::MATRIX_ROUNDOFF;
use super::reduced::SINGULAR;
use crate::c64;
use crate::model::{Combination, ModelAt};
use frfit_linalg::dense::NoConvergence;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::norm;

/// A frequency, with ∂D/∂ln p of some parameters there.
#[derive(Debug, Clone)]
pub struct ChangePoint<'m> {
    /// The model at that frequency; its nominal values are what is looked at.
    pub at: ModelAt<'m>,
    /// A_p of each parameter.
    pub changes: Vec<Combination>,
}

/// Response and derivatives at the sensors, with estimated errors, and the solutions behind them.
#[derive(Debug, Clone, PartialEq)]
pub struct Changed {
    /// x_m, receptance.
    pub response: Vec<c64>,
    /// Estimated error of x_m, for what the basis lacks and for roundoff.
    pub error: Vec<f64>,
    /// ∂x_m/∂ln p, \[parameter\]\[sensor\].
    pub slopes: Vec<Vec<c64>>,
    /// Estimated error of ∂x_m/∂ln p for what the basis lacks: more vectors bring it down.
    pub slope_truncation: Vec<Vec<f64>>,
    /// What roundoff leaves of ∂x_m/∂ln p.
    pub slope_roundoff: Vec<Vec<f64>>,
    /// y of x = V y, then of w_p = V y for each parameter.
    pub coordinates: Vec<Vec<c64>>,
    /// Estimated ‖x − V y‖/‖x‖ and the same of each w_p, in the norm of the basis: what a sensor at any other place can rely on. From one residual each, and without what a
    /// resonance makes of it: against direct solves some ten times too small.
    pub everywhere: Vec<f64>,
}

impl Changed {
    /// Estimated error of ∂x_m/∂ln p, \[parameter\]\[sensor\].
    pub fn slope_error(&self, parameter: usize, sensor: usize) -> f64 {
        self.slope_truncation[parameter][sensor] + self.slope_roundoff[parameter][sensor]
    }

    /// The largest truncation error of any derivative, relative to it or to the response, whichever is larger.
    pub fn relative_truncation(&self) -> f64 {
        let of = |p: usize, m: usize| {
            self.slope_truncation[p][m] / self.response[m].norm().max(self.slopes[p][m].norm())
        };
        let sensors = self.response.len();
        (0..self.slopes.len()).flat_map(|p| (0..sensors).map(move |m| of(p, m))).fold(0.0, f64::max)
    }
}

impl Projection {
    /// Response and derivatives at the sensors, at the nominal values.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    ///
    /// # Limits
    /// Estimates, not bounds, as those of [`Projection::assess`].
    pub fn changes(&self, point: &ChangePoint<'_>) -> Result<Changed, Breakdown> {
        let n = self.size;
        let theta = self.parts.weights(&point.at.nominal, point.at.frequency_hz);
        let factor = self.factor(&theta)?;
        let mut given = self.load.clone();
        given.extend(self.sensors.iter().flatten().map(|&l| c64::new(l, 0.0)));
        factor.solve(&mut given).map_err(|NoConvergence| SINGULAR)?;
        let solutions: Vec<Vec<c64>> = given.chunks_exact(n.max(1)).map(<[c64]>::to_vec).collect();
        let image = self.combine_images(&theta);
        let left = |force: &[c64], y: &[c64]| -> f64 {
            let mut rest = force.to_vec();
            image.multiply_add(c64::new(-1.0, 0.0), y, &mut rest);
            norm(&rest)
        };
        let residuals: Vec<f64> =
            self.sketched.iter().zip(&solutions).map(|(force, y)| left(force, y)).collect();
        let norms: Vec<f64> = solutions.iter().map(|y| norm(y)).collect();
        let observe =
            |y: &[c64]| self.sensors.iter().map(|l| l.iter().zip(y).map(|(l, y)| y * l).sum()).collect();
        let sensors = 1..solutions.len();
        let mut changed = Changed {
            response: observe(&solutions[0]),
            error: (sensors.clone())
                .map(|m| self.gain * residuals[m] * residuals[0] + MATRIX_ROUNDOFF * norms[m] * norms[0])
                .collect(),
            slopes: Vec::with_capacity(point.changes.len()),
            slope_truncation: Vec::new(),
            slope_roundoff: Vec::new(),
            coordinates: vec![solutions[0].clone()],
            everywhere: vec![self.gain * residuals[0] / norms[0]],
        };
        for change in &point.changes {
            let theta = self.parts.weights(change, point.at.frequency_hz);
            let (matrix, change_image) = (self.combine(&theta), self.combine_images(&theta));
            // w_p, then u_{m,p} of each sensor.
            let mut block: Vec<c64> =
                solutions.iter().flat_map(|y| matrix.multiply(y)).map(|force| -force).collect();
            factor.solve(&mut block).map_err(|NoConvergence| SINGULAR)?;
            let moved: Vec<&[c64]> = block.chunks_exact(n.max(1)).collect();
            let rest: Vec<f64> = solutions
                .iter()
                .zip(&moved)
                .map(|(y, w)| {
                    let force: Vec<c64> = change_image.multiply(y).iter().map(|force| -force).collect();
                    left(&force, w)
                })
                .collect();
            let length: Vec<f64> = moved.iter().map(|w| norm(w)).collect();
            // w_p − V y = D⁻¹(r_w − A_p e_x), where A_p acts on the error of x as it does on x.
            let inherited = self.gain * residuals[0] * norm(&change_image.multiply(&solutions[0])) / norms[0];
            let truncation = |m: usize| self.gain * (residuals[m] * rest[0] + residuals[0] * rest[m]);
            let roundoff = |m: usize| MATRIX_ROUNDOFF * (norms[m] * length[0] + norms[0] * length[m]);
            changed.slopes.push(observe(moved[0]));
            changed.slope_truncation.push(sensors.clone().map(truncation).collect());
            changed.slope_roundoff.push(sensors.clone().map(roundoff).collect());
            // A parameter that does nothing there has nothing to be wrong.
            let everywhere = self.gain * (rest[0] + inherited) / length[0];
            changed.everywhere.push(if length[0] > 0.0 { everywhere } else { 0.0 });
            changed.coordinates.push(moved[0].to_vec());
        }
        Ok(changed)
    }
}
