//! How good a reduced model is at one frequency and one value of the parameter, at the sensors.

use super::Projection;
use super::projection::weighed;
use super::reduced::SINGULAR;
use crate::c64;
use crate::model::{ModelAt, ParameterAt};
use frfit_linalg::dense::{Ldlt, NoConvergence};
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::{norm, transpose_dot};

/// Response, sensitivity and estimated error at the sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// x_m, receptance.
    pub response: Vec<c64>,
    /// ∂x_m/∂c of the first parameter, −z_mᵀ (∂D/∂c) x: exact for the reduced model.
    pub slope: Vec<c64>,
    /// Estimated |x_m − exact| for what the basis lacks, receptance: γ ‖r_z‖ ‖r_x‖. More vectors bring it down.
    pub truncation: Vec<f64>,
    /// What roundoff leaves of x_m, receptance: nothing brings it down.
    pub roundoff: Vec<f64>,
}

/// An assessment with the solutions behind it.
pub(super) struct AssessedSolution {
    pub(super) assessment: Assessment,
    /// y with VᵀDV y = VᵀF, then z_m with VᵀDV z_m = Vᵀℓ_m.
    pub(super) solutions: Vec<Vec<c64>>,
    /// Sketches of F − D V y, then of ℓ_m − D V z_m.
    pub(super) residuals: Vec<Vec<c64>>,
}

/// Units of roundoff that reduced matrices carry relative to the diagonal of the shifted stiffness.
pub(super) const MATRIX_ROUNDOFF: f64 = 4.0 * f64::EPSILON;

impl Assessment {
    /// The largest truncation error of any sensor relative to its response or to p ∂x_m/∂c, whichever is larger: relative error of the
    /// response, and on an antiresonance of the factor p that is read from it.
    pub fn relative_truncation(&self, factor: c64) -> f64 {
        let sensors = self.truncation.iter().zip(self.response.iter().zip(&self.slope));
        sensors.map(|(e, (x, slope))| e / x.norm().max((factor * slope).norm())).fold(0.0, f64::max)
    }

    /// Truncation and roundoff at a sensor.
    pub fn error(&self, sensor: usize) -> f64 {
        self.truncation[sensor] + self.roundoff[sensor]
    }
}

/// The reduced system solved for the load and for every sensor.
pub(super) struct Solutions {
    /// θ_g of D and of ∂D/∂c.
    pub(super) theta: Vec<c64>,
    pub(super) slope_theta: Vec<c64>,
    factor: Ldlt,
    /// y, z_1, z_2 …
    pub(super) all: Vec<Vec<c64>>,
}

impl Solutions {
    pub(super) fn new(small: &Projection, at: &ModelAt<'_>, correction: c64) -> Result<Self, Breakdown> {
        let (theta, slope_theta) = weights(small, at, correction);
        let mut block = small.load.clone();
        block.extend(small.sensors.iter().flatten().map(|&l| c64::new(l, 0.0)));
        let factor = small.factor(&theta)?;
        factor.solve(&mut block).map_err(|NoConvergence| SINGULAR)?;
        let all = block.chunks_exact(small.size).map(<[c64]>::to_vec).collect();
        Ok(Self { theta, slope_theta, factor, all })
    }

    /// x_m.
    pub(super) fn response(&self, small: &Projection) -> Vec<c64> {
        small.observe(&self.all[0])
    }

    /// −z_mᵀ (Σ_g θ_g S_g) y for each set of θ.
    pub(super) fn slopes(&self, small: &Projection, theta: &[Vec<c64>]) -> Vec<Vec<c64>> {
        let changes = small.multiply(theta, &self.all[0]);
        let slope = |change: &Vec<c64>| self.all[1..].iter().map(|z| -transpose_dot(z, change)).collect();
        changes.iter().map(slope).collect()
    }

    /// ∂x_m/∂c.
    pub(super) fn slope(&self, small: &Projection) -> Vec<c64> {
        self.slopes(small, std::slice::from_ref(&self.slope_theta)).concat()
    }
}

impl Projection {
    /// Response, sensitivity and estimated error with the correction c of the first parameter.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    ///
    /// # Limits
    /// An estimate, not a bound: γ is the largest gain of S⁻¹ met in the last solves, and the residuals are those of a sketch. At a resonance of a mode that the basis has not
    /// met the error can be some ten times the estimate.
    pub fn assess(&self, at: &ModelAt<'_>, correction: c64) -> Result<Assessment, Breakdown> {
        Ok(AssessedSolution::new(self, at, correction)?.assessment)
    }

    /// x_m at the nominal values.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub fn respond(&self, at: &ModelAt<'_>) -> Result<Vec<c64>, Breakdown> {
        self.respond_at(at, c64::default())
    }

    /// x_m with the correction c of the first parameter.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub fn respond_at(&self, at: &ModelAt<'_>, correction: c64) -> Result<Vec<c64>, Breakdown> {
        let mut y = self.load.clone();
        self.solve(&weights(self, at, correction).0, &mut y)?;
        Ok(self.observe(&y))
    }

    /// Σ θ_g VᵀS_gV, factorised.
    pub(super) fn factor(&self, theta: &[c64]) -> Result<Ldlt, Breakdown> {
        Ldlt::of_combination(self.size, &weighed(theta, &self.matrices))
            .map_err(|NoConvergence| Breakdown::NotFinite)
    }

    /// x ← (Σ θ_g VᵀS_gV)⁻¹x, for as many columns as there are.
    pub(super) fn solve(&self, theta: &[c64], x: &mut [c64]) -> Result<(), Breakdown> {
        self.factor(theta)?.solve(x).map_err(|NoConvergence| SINGULAR)
    }

    /// ℓ_mᵀV y.
    pub(super) fn observe(&self, y: &[c64]) -> Vec<c64> {
        self.sensors.iter().map(|l| l.iter().zip(y).map(|(l, y)| y * l).sum()).collect()
    }

    /// x_m and ∂x_m/∂c with the correction c of the first parameter, without an estimate of their error.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub fn respond_with_slope(
        &self,
        at: &ModelAt<'_>,
        correction: c64,
    ) -> Result<(Vec<c64>, Vec<c64>), Breakdown> {
        let solutions = Solutions::new(self, at, correction)?;
        Ok((solutions.response(self), solutions.slope(self)))
    }

    /// x_m at the nominal values, and ∂x_m/∂c_j of every parameter there, `[parameter][sensor]`: −z_mᵀA_{j,1}x, one factorisation and one block of solves for all.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub fn respond_with_slopes(&self, at: &ModelAt<'_>) -> Result<(Vec<c64>, Vec<Vec<c64>>), Breakdown> {
        let solutions = Solutions::new(self, at, c64::default())?;
        Ok((solutions.response(self), solutions.slopes(self, &self.first_weights(at))))
    }

    /// y and every z_m at the nominal values, then −D⁻¹A_{j,1} of each for every parameter: their slopes.
    pub(super) fn solutions_with_slopes(&self, at: &ModelAt<'_>) -> Result<Vec<Vec<c64>>, Breakdown> {
        let Solutions { factor, mut all, .. } = Solutions::new(self, at, c64::default())?;
        let theta = self.first_weights(at);
        let mut slopes: Vec<c64> = all.iter().flat_map(|y| self.multiply(&theta, y).concat()).collect();
        factor.solve(&mut slopes).map_err(|NoConvergence| SINGULAR)?;
        all.extend(slopes.chunks_exact(self.size.max(1)).map(<[c64]>::to_vec));
        Ok(all)
    }

    /// θ_g of each A_{j,1}.
    pub(super) fn first_weights(&self, at: &ModelAt<'_>) -> Vec<Vec<c64>> {
        let first = |parameter: &ParameterAt| match parameter.coefficients.first() {
            Some(first) => self.parts.weights(first, at.frequency_hz),
            None => vec![c64::default(); self.parts.len()],
        };
        at.parameters.iter().map(first).collect()
    }

    /// ∂²x_m/∂c² = z_mᵀ (2 D′D⁻¹D′ − D″) x with the correction c of the first parameter, without an estimate of its error.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub fn second_derivative(&self, at: &ModelAt<'_>, correction: c64) -> Result<Vec<c64>, Breakdown> {
        let Solutions { factor, all, .. } = Solutions::new(self, at, correction)?;
        let [_, slope, second] = weights_to_second(self, at, correction);
        let (y, duals) = (&all[0], &all[1..]);
        let slope = [slope];
        let mut change = self.multiply(&slope, y).concat();
        factor.solve(&mut change).map_err(|NoConvergence| SINGULAR)?;
        let (twice, bend) = (self.multiply(&slope, &change).concat(), self.multiply(&[second], y).concat());
        let total: Vec<c64> = twice.iter().zip(&bend).map(|(a, b)| 2.0 * a - b).collect();
        Ok(duals.iter().map(|z| transpose_dot(z, &total)).collect())
    }
}

impl AssessedSolution {
    pub(super) fn new(small: &Projection, at: &ModelAt<'_>, correction: c64) -> Result<Self, Breakdown> {
        let solved = Solutions::new(small, at, correction)?;
        let (response, slope) = (solved.response(small), solved.slope(small));
        let Solutions { theta, all: solutions, .. } = solved;
        let residuals = small.residuals(&theta, &solutions);
        let norms: Vec<f64> = residuals.iter().map(|residual| norm(residual)).collect();
        let size = norm(&solutions[0]);
        let assessment = Assessment {
            response,
            slope,
            truncation: norms[1..].iter().map(|dual| small.gain * dual * norms[0]).collect(),
            roundoff: solutions[1..].iter().map(|z| MATRIX_ROUNDOFF * norm(z) * size).collect(),
        };
        Ok(Self { assessment, solutions, residuals })
    }
}

/// θ_g of D and of ∂D/∂c at the correction c of the first parameter.
pub(super) fn weights(small: &Projection, at: &ModelAt<'_>, correction: c64) -> (Vec<c64>, Vec<c64>) {
    let [theta, slope, _] = weights_to_second(small, at, correction);
    (theta, slope)
}

/// θ_g of D, ∂D/∂c and ∂²D/∂c² at the correction c of the first parameter.
fn weights_to_second(small: &Projection, at: &ModelAt<'_>, correction: c64) -> [Vec<c64>; 3] {
    let mut theta = small.parts.weights(&at.nominal, at.frequency_hz);
    let mut slope = vec![c64::default(); theta.len()];
    let mut second = slope.clone();
    // c^{q−1} for the q-th coefficient, and c^{q−2}: the first has none.
    let mut before = c64::default();
    let mut power = c64::new(1.0, 0.0);
    for (q, coefficient) in at.parameters.first().map_or(&[][..], |p| &p.coefficients).iter().enumerate() {
        for (g, weight) in small.parts.weights(coefficient, at.frequency_hz).into_iter().enumerate() {
            second[g] += ((q + 1) * q) as f64 * before * weight;
            slope[g] += (q + 1) as f64 * power * weight;
            theta[g] += power * correction * weight;
        }
        (before, power) = (power, power * correction);
    }
    [theta, slope, second]
}
