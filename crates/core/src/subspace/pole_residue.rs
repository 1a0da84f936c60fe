//! The reduced response as a sum over its poles, between the load, the sensors, and every row of the model.

use super::{Projection, Subspace};
use crate::c64;
use crate::model::{Combination, ModelAt};
use frfit_linalg::dense::{Eigen, Lu, Matrix, NoConvergence, eigen};
use frfit_linalg::vector::{norm, transpose_dot};

/// (1 + cB)⁻¹A₀⁻¹f for any c at the price of a few divisions, with B = A₀⁻¹A₁ = W Λ W⁻¹ of a reduced model at one frequency.
#[derive(Debug, Clone)]
pub struct PoleResidue {
    lambda: Vec<c64>,
    vectors: Matrix,
    /// W⁻¹A₀⁻¹f for the load, then for a unit force at each sensor.
    inputs: Vec<Vec<c64>>,
    /// ℓ_mᵀW.
    outputs: Vec<Vec<c64>>,
}

/// What drives the structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// The load of the experiment.
    Load,
    /// A unit force at a sensor, along it.
    Sensor(usize),
}

/// The solution at the nominal value may be off by this, relative, before the eigenvectors are too nearly dependent to be of use: far below what an FRF is measured to.
const NOMINAL_SOLUTION_RTOL: f64 = 1e-4;

impl Projection {
    /// The poles and their vectors at one frequency; `None` where the first parameter does not enter linearly.
    ///
    /// # Errors
    /// [`NoConvergence`] where the reduced system is singular at its nominal value, or its eigenvectors are nearly dependent.
    pub fn pole_residue(&self, at: &ModelAt<'_>) -> Result<Option<PoleResidue>, NoConvergence> {
        let Some([change]) = at.parameters.first().map(|p| p.coefficients.as_slice()) else {
            return Ok(None);
        };
        let n = self.size;
        let weights = |of: &Combination| self.parts.weights(of, at.frequency_hz);
        let factor = self.factor(&weights(&at.nominal)).map_err(|_| NoConvergence)?;
        let change = self.combine(&weights(change));
        let forces = self.sensors.iter().map(|l| l.iter().map(|&l| c64::new(l, 0.0)).collect::<Vec<_>>());
        let mut block: Vec<c64> = (0..n).flat_map(|j| change.column(j)).copied().collect();
        block.extend(&self.load);
        block.extend(forces.clone().flatten());
        factor.solve(&mut block)?;
        let g = Matrix::from_fn(n, n, |i, j| block[i + j * n]);
        let Eigen { values: lambda, vectors } = eigen(&g)?;
        let direct = block.split_off(n * n);
        let mut inputs = direct.clone();
        Lu::new(&vectors)?.solve(&mut inputs)?;
        let outputs: Vec<Vec<c64>> =
            forces.map(|l| (0..n).map(|k| transpose_dot(&l, vectors.column(k))).collect()).collect();
        let inputs: Vec<Vec<c64>> = inputs.chunks_exact(n.max(1)).map(<[c64]>::to_vec).collect();
        // The load's solution put together again from the poles, in the norm of the coordinates: at a sensor on a nodal line nothing is left but roundoff.
        let again = vectors.multiply(&inputs[0]);
        let off: Vec<c64> = again.iter().zip(&direct).map(|(a, b)| a - b).collect();
        let good = norm(&off) <= NOMINAL_SOLUTION_RTOL * norm(&direct[..n]);
        if good { Ok(Some(PoleResidue { lambda, vectors, inputs, outputs })) } else { Err(NoConvergence) }
    }
}

impl PoleResidue {
    /// λ_k of x(c) = Σ_k ρ_k/(1 + cλ_k).
    pub fn lambda(&self) -> &[c64] {
        &self.lambda
    }

    /// ρ_k of the response at a sensor to a drive.
    ///
    /// # Panics
    /// Where there is no such sensor.
    pub fn residues(&self, sensor: usize, drive: Drive) -> Vec<c64> {
        self.outputs[sensor].iter().zip(self.input(drive)).map(|(out, input)| out * input).collect()
    }

    /// y of x = V y, the response to a drive at the correction c.
    ///
    /// # Panics
    /// Where there is no such sensor.
    pub fn coordinates(&self, drive: Drive, correction: c64) -> Vec<c64> {
        let weights: Vec<c64> = self
            .input(drive)
            .iter()
            .zip(&self.lambda)
            .map(|(input, lambda)| input / (1.0 + correction * lambda))
            .collect();
        self.vectors.multiply(&weights)
    }

    fn input(&self, drive: Drive) -> &[c64] {
        match drive {
            Drive::Load => &self.inputs[0],
            Drive::Sensor(m) => &self.inputs[m + 1],
        }
    }
}

impl Subspace<'_> {
    /// x = V y at every row of the model, for each of some y.
    ///
    /// # Limits
    /// The basis is trained for the sensors, where the error is a product of two small residuals; elsewhere it is of the size of one.
    pub fn everywhere(&self, coordinates: &[Vec<c64>]) -> Vec<Vec<c64>> {
        self.basis.vectors().combine_all(coordinates)
    }
}
