//! The response on the Neumann vectors of one parameter, B-1.

use super::basis::Basis;
use crate::c64;
use crate::response::Response;
use crate::series::scale;
use frfit_linalg::dense::{Matrix, NoConvergence, solve};
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::{norm, transpose_dot};

/// A reduced model of one parameter at one frequency, with the residual that measures its error.
#[derive(Debug, Clone)]
pub struct RationalResponse {
    /// s in z = c/s, as in the series.
    pub(super) scale: f64,
    /// s^q VᵀA_qV, q = 0 … d.
    pub(super) matrices: Vec<Matrix>,
    /// VᵀF.
    pub(super) load: Vec<c64>,
    /// Vᵀe_m with the sensor's sign, for each sensor.
    pub(super) sensors: Vec<Vec<c64>>,
    basis: Basis,
}

impl RationalResponse {
    /// Projects the system on the Neumann vectors up to order n: as many solves as the series takes, or fewer where the vectors
    /// span an invariant space before.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve with A₀ fails.
    ///
    /// # Limits
    /// Exact at the nominal value; elsewhere as good as [`Self::residual`] says.
    pub fn new(system: &impl Response, parameter: usize, order: usize) -> Result<Self, Breakdown> {
        let scale = scale(system, parameter)?;
        let basis = Basis::start(system, parameter);
        let empty = Self { scale, matrices: Vec::new(), load: Vec::new(), sensors: Vec::new(), basis };
        empty.extended(system, parameter, order)
    }

    /// The same with more Neumann vectors, of which those there are need no new solve.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve with A₀ fails.
    pub fn extended(
        mut self,
        system: &impl Response,
        parameter: usize,
        order: usize,
    ) -> Result<Self, Breakdown> {
        self.basis.extend(system, parameter, order)?;
        let Basis { vectors, images, load, .. } = &self.basis;
        let size = vectors.len();
        let mut power = 1.0 / self.scale;
        let mut project = |image: &Vec<Vec<c64>>| {
            power *= self.scale;
            Matrix::from_fn(size, size, |i, j| power * transpose_dot(&vectors[i], &image[j]))
        };
        self.matrices = images.iter().map(&mut project).collect();
        self.load = vectors.iter().map(|v| transpose_dot(v, load)).collect();
        let columns: Vec<Vec<c64>> = vectors.iter().map(|v| system.observe(v)).collect();
        let count = system.observe(&vec![c64::default(); system.dim()]).len();
        self.sensors = (0..count).map(|m| columns.iter().map(|column| column[m]).collect()).collect();
        Ok(self)
    }

    /// Whether the vectors span all that the load reaches: more would add nothing.
    pub fn is_complete(&self) -> bool {
        self.basis.is_invariant()
    }

    /// Number of basis vectors.
    pub fn size(&self) -> usize {
        self.basis.len()
    }

    /// Receptance at the sensors with the correction c.
    ///
    /// # Errors
    /// [`NoConvergence`] where c is a pole to working precision.
    pub fn respond(&self, correction: c64) -> Result<Vec<c64>, NoConvergence> {
        let y = self.coordinates(correction)?;
        Ok(self.sensors.iter().map(|sensor| transpose_dot(sensor, &y)).collect())
    }

    /// ‖F − D(c) V y‖ / ‖F‖: the true residual of the reduced solution in the full system.
    ///
    /// # Errors
    /// [`NoConvergence`] where c is a pole to working precision.
    pub fn residual(&self, correction: c64) -> Result<f64, NoConvergence> {
        let y = self.coordinates(correction)?;
        let mut residual = self.basis.load.clone();
        let mut power = c64::new(1.0, 0.0);
        for image in &self.basis.images {
            for (column, y) in image.iter().zip(&y) {
                residual.iter_mut().zip(column).for_each(|(r, a)| *r -= power * a * y);
            }
            power *= correction;
        }
        Ok(norm(&residual) / norm(&self.basis.load))
    }

    /// y with (Σ c^q VᵀA_qV) y = VᵀF.
    fn coordinates(&self, correction: c64) -> Result<Vec<c64>, NoConvergence> {
        solve(&self.matrix(correction / self.scale), &self.load)
    }

    /// Σ z^q s^q VᵀA_qV.
    pub(super) fn matrix(&self, z: c64) -> Matrix {
        let n = self.size();
        Matrix::from_fn(n, n, |i, j| {
            self.matrices.iter().rev().fold(c64::default(), |sum, a| sum * z + a[(i, j)])
        })
    }
}
