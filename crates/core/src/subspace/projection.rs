//! Everything small that belongs to a basis: the reduced matrices, loads, sensors, and the sketches that estimate residuals.

use super::parts::Parts;
use crate::c64;
use frfit_linalg::column_block::{product, transpose_product};
use frfit_linalg::dense::{self, Matrix, multiply};
use frfit_linalg::vector::transpose_dot;

/// VᵀS_gV, VᵀF, ℓ_mᵀV and Θ S_gV for a basis V of r vectors: a model for a band, without anything of size N.
#[derive(Debug, Clone)]
pub struct Projection {
    pub(super) parts: Parts,
    pub(super) size: usize,
    /// `matrices[g]` is VᵀS_gV, r × r.
    pub(super) matrices: Vec<Vec<f64>>,
    /// `images[g]` is Θ S_g V, SKETCH_SIZE × r, column after column.
    pub(super) images: Vec<Vec<f64>>,
    /// VᵀF.
    pub(super) load: Vec<c64>,
    /// ℓ_mᵀV for each sensor.
    pub(super) sensors: Vec<Vec<f64>>,
    /// Θ F, then Θ ℓ_m for each sensor.
    pub(super) sketched: Vec<Vec<c64>>,
    /// γ: largest ‖S⁻¹r‖/‖r‖ of the last solves.
    pub(super) gain: f64,
}

impl Projection {
    /// Number of basis vectors r.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Σ θ_g VᵀS_gV.
    pub(super) fn combine(&self, theta: &[c64]) -> Matrix {
        combination([self.size; 2], theta, &self.matrices)
    }

    /// Σ θ_g Θ S_gV.
    pub(super) fn combine_images(&self, theta: &[c64]) -> Matrix {
        combination([self.sketched[0].len(), self.size], theta, &self.images)
    }

    /// Σ θ_g VᵀS_gV y for each set of θ, every matrix met once.
    pub(super) fn multiply(&self, theta: &[Vec<c64>], y: &[c64]) -> Vec<Vec<c64>> {
        let n = self.size;
        let mut sums = vec![vec![c64::default(); n]; theta.len()];
        for (g, matrix) in self.matrices.iter().enumerate() {
            if theta.iter().all(|theta| theta[g] == c64::default()) {
                continue;
            }
            let image = multiply(matrix, y);
            for (sum, theta) in sums.iter_mut().zip(theta) {
                sum.iter_mut().zip(&image).for_each(|(sum, image)| *sum += theta[g] * image);
            }
        }
        sums
    }

    /// Sketches of F − Σ θ_g S_g V y and ℓ_m − Σ θ_g S_g V z_m in the norm of forces: `solutions` are y, z_1, z_2 …
    pub(super) fn residuals(&self, theta: &[c64], solutions: &[Vec<c64>]) -> Vec<Vec<c64>> {
        let rows = self.sketched[0].len();
        let weighed = self.images.iter().zip(theta).filter(|(_, theta)| **theta != c64::default());
        let weighed: Vec<(&Vec<f64>, &c64)> = weighed.collect();
        let residual = |(given, y): (&Vec<c64>, &Vec<c64>)| {
            let mut parts: Vec<(c64, &[f64])> = Vec::with_capacity(weighed.len() * y.len());
            for (image, theta) in &weighed {
                parts.extend(image.chunks_exact(rows).zip(y).map(|(column, y)| (*theta * y, column)));
            }
            let forces = dense::combination(rows, 1, &parts);
            given.iter().zip(forces.column(0)).map(|(given, force)| given - force).collect()
        };
        self.sketched.iter().zip(solutions).map(residual).collect()
    }

    /// The same model on r × q coordinates W (column after column): basis VW.
    pub(super) fn compressed(&self, w: &[f64]) -> Self {
        let (r, q) = (self.size, w.len() / self.size.max(1));
        let congruent = |matrix: &Vec<f64>| transpose_product(w, r, &product(matrix, r, w));
        let rows = self.sketched[0].len();
        Self {
            parts: self.parts.clone(),
            size: q,
            matrices: self.matrices.iter().map(congruent).collect(),
            images: self.images.iter().map(|image| product(image, rows, w)).collect(),
            load: w.chunks_exact(r).map(|w| self.load.iter().zip(w).map(|(f, w)| f * w).sum()).collect(),
            sensors: self
                .sensors
                .iter()
                .map(|l| w.chunks_exact(r).map(|w| transpose_dot(w, l)).collect())
                .collect(),
            sketched: self.sketched.clone(),
            gain: self.gain,
        }
    }
}

/// Σ θ_g S_g of those that have any weight.
fn combination([nrows, ncols]: [usize; 2], theta: &[c64], matrices: &[Vec<f64>]) -> Matrix {
    dense::combination(nrows, ncols, &weighed(theta, matrices))
}

/// Matrices that have any weight, with it.
pub(super) fn weighed<'m>(theta: &[c64], matrices: &'m [Vec<f64>]) -> Vec<(c64, &'m [f64])> {
    let weighed = theta.iter().zip(matrices).filter(|(theta, _)| **theta != c64::default());
    weighed.map(|(&theta, matrix)| (theta, matrix.as_slice())).collect()
}
