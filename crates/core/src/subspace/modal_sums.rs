//! A reduced model in the coordinates of its undamped modes, without what couples them.
//!
//! With the modes y_k of the real pencil (K, M) at some values of all unknowns, a response at any other values near by is
//! $$ x_m \approx \sum_k \frac{(\ell_m^T V y_k)(y_k^T V^T F)}{d_k}, \qquad d_k = y_k^T V^T D(\omega, p) V y_k : $$
//! natural frequencies are right to second order in the change of shapes (Rayleigh's quotient), and so is the
//! damping of modes that are not close to each other.

use super::modes::{PENCIL_SHIFT_RATIO, congruent};
use super::{Drive, Projection};
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::model::{Combination, ModelAt, ParameterAt, Role};
use frfit_linalg::dense::{NoConvergence, symmetric_eigen};
use frfit_linalg::vector::transpose_dot;

/// All modes of a reduced model, for responses at many values of its unknowns at the price of a few divisions.
#[derive(Debug, Clone)]
pub(crate) struct ModalSums {
    parts: super::parts::Parts,
    size: usize,
    /// y_k, r × r, one after the other.
    shapes: Vec<f64>,
    /// y_kᵀS_gy_k, `[g][k]`.
    diagonals: Vec<Vec<f64>>,
    /// FᵀVy_k.
    load: Vec<c64>,
    /// ℓ_mᵀVy_k, `[m][k]`.
    sensors: Vec<Vec<f64>>,
}

impl Projection {
    /// The modes of all its vectors at the nominal values, real parts only.
    ///
    /// # Errors
    /// [`NoConvergence`] where the real stiffness is indefinite, or a number is not finite.
    pub(crate) fn modal_sums(&self, at: &ModelAt<'_>) -> Result<ModalSums, NoConvergence> {
        let r = self.size;
        let theta = self.parts.weights(&at.nominal, at.frequency_hz);
        let sum = |wanted: Role| {
            let role = |g: usize| at.model.terms()[self.parts.term(g)].role;
            let factor = |g: usize| (theta[g] / at.model.weight(wanted, at.frequency_hz)).re;
            let own: Vec<(usize, f64)> =
                (0..theta.len()).filter(|&g| role(g) == wanted).map(|g| (g, factor(g))).collect();
            self.real_sum(&own)
        };
        let mass = sum(Role::Mass);
        let shift = PENCIL_SHIFT_RATIO * omega_rad_s(at.frequency_hz).powi(2);
        let shifted: Vec<f64> = sum(Role::Stiffness).iter().zip(&mass).map(|(k, m)| k + shift * m).collect();
        let (_, shapes) = self.simultaneous(&shifted, &mass)?;
        let along =
            |l: &[f64]| -> Vec<f64> { shapes.chunks_exact(r.max(1)).map(|y| transpose_dot(l, y)).collect() };
        let diagonal = |matrix: &Vec<f64>| -> Vec<f64> {
            let image = frfit_linalg::column_block::product(matrix, r, &shapes);
            let pairs = shapes.chunks_exact(r.max(1)).zip(image.chunks_exact(r.max(1)));
            pairs.map(|(y, image)| transpose_dot(y, image)).collect()
        };
        let [re, im] = [|f: &c64| f.re, |f: &c64| f.im].map(|part| self.load.iter().map(part).collect());
        let [re, im]: [Vec<f64>; 2] = [re, im];
        Ok(ModalSums {
            parts: self.parts.clone(),
            size: r,
            diagonals: self.matrices.iter().map(diagonal).collect(),
            load: along(&re).into_iter().zip(along(&im)).map(|(re, im)| c64::new(re, im)).collect(),
            sensors: self.sensors.iter().map(|sensor| along(sensor)).collect(),
            shapes,
        })
    }

    /// What makes both of a real definite matrix B and a symmetric M diagonal: μ_k = y_kᵀMy_k, ascending, with
    /// y_kᵀBy_k = 1 (r × r, one after the other).
    ///
    /// # Errors
    /// [`NoConvergence`] where B is not definite to working precision, or a number is not finite.
    pub(super) fn simultaneous(
        &self,
        definite: &[f64],
        mass: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), NoConvergence> {
        let r = self.size;
        let (values, vectors) = symmetric_eigen(r, definite)?;
        let largest = values.last().copied().unwrap_or(0.0);
        if values.iter().any(|&value| value <= DEFINITE_RTOL * largest) {
            return Err(NoConvergence);
        }
        let root: Vec<f64> = vectors
            .chunks_exact(r.max(1))
            .zip(&values)
            .flat_map(|(v, value)| v.iter().map(move |v| v / value.sqrt()))
            .collect();
        let (mu, w) = symmetric_eigen(r, &congruent(mass, &root, r))?;
        Ok((mu, frfit_linalg::column_block::product(&root, r, &w)))
    }
}

/// An eigenvalue below this part of the largest has no digit: the matrix is not definite.
const DEFINITE_RTOL: f64 = 1e-24;

impl ModalSums {
    /// 1/d_k.
    pub(crate) fn inverse(&self, at: &ModelAt<'_>) -> Vec<c64> {
        self.diagonal(&at.nominal, at.frequency_hz).iter().map(|d| d.inv()).collect()
    }

    /// ∂(1/d_k)/∂p_j, `[j][k]`, from 1/d_k.
    pub(crate) fn slopes(&self, at: &ModelAt<'_>, inverse: &[c64]) -> Vec<Vec<c64>> {
        let of = |parameter: &ParameterAt| -> Vec<c64> {
            let change = parameter
                .coefficients
                .first()
                .map_or(Vec::new(), |first| self.diagonal(first, at.frequency_hz));
            change.iter().zip(inverse).map(|(s, inverse)| -s * inverse * inverse).collect()
        };
        at.parameters.iter().map(of).collect()
    }

    /// y_kᵀ (Σ θ_g S_g) y_k.
    fn diagonal(&self, of: &Combination, frequency_hz: f64) -> Vec<c64> {
        let theta = self.parts.weights(of, frequency_hz);
        let mut d = vec![c64::default(); self.size];
        for (theta, diagonal) in theta.iter().zip(&self.diagonals).filter(|(t, _)| **t != c64::default()) {
            d.iter_mut().zip(diagonal).for_each(|(d, s)| *d += theta * s);
        }
        d
    }

    /// (ℓ_mᵀVy_k)(y_kᵀVᵀf) of the response at a sensor to a drive f.
    pub(crate) fn residues(&self, sensor: usize, drive: Drive) -> Vec<c64> {
        self.sensors[sensor].iter().zip(self.input(drive)).map(|(out, input)| out * input).collect()
    }

    /// y of x = V y, the response to a drive.
    pub(crate) fn coordinates(&self, drive: Drive, inverse: &[c64]) -> Vec<c64> {
        let mut sum = vec![c64::default(); self.size];
        let weights = self.input(drive).into_iter().zip(inverse).map(|(input, inverse)| input * inverse);
        for (weight, y) in weights.zip(self.shapes.chunks_exact(self.size.max(1))) {
            sum.iter_mut().zip(y).for_each(|(sum, y)| *sum += weight * y);
        }
        sum
    }

    fn input(&self, drive: Drive) -> Vec<c64> {
        match drive {
            Drive::Load => self.load.clone(),
            Drive::Sensor(m) => self.sensors[m].iter().map(|&l| l.into()).collect(),
        }
    }
}
