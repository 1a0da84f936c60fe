//! All solutions of x_m(c) = u on the reduced model, B-2.

use super::{RationalResponse, transpose_dot};
use crate::c64;
use frfit_linalg::dense::{Matrix, NoConvergence, generalized_eigenvalues, solve};

/// A correction at which the reduced response equals the measured one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RationalRoot {
    /// c.
    pub correction: c64,
    /// |x_m(c) − u| / |u| on the reduced model, after polishing.
    pub mismatch: f64,
    /// ‖F − D(c)Vy‖ / ‖F‖ in the full model: how far the reduced model can be believed there.
    pub residual: f64,
}

/// Newton steps of a polish; from an eigenvalue two are enough, more show that it was none.
const POLISH: usize = 8;

/// Two roots nearer than this, relative to the larger, are one.
const SAME: f64 = 1e-9;

impl RationalResponse {
    /// All finite solutions at a sensor, least |c| first: eigenvalues of a companion pencil of size d·(n + 1) + 1, polished by Newton's
    /// method, duplicates merged. Those that Newton's method does not confirm are left out.
    ///
    /// # Errors
    /// [`NoConvergence`] where the eigenvalue iteration fails.
    ///
    /// # Limits
    /// Solutions of the *reduced* model: where the residual is large, of nothing else.
    pub fn roots(&self, sensor: usize, measured: c64) -> Result<Vec<RationalRoot>, NoConvergence> {
        let (constant, linear) = self.pencil(sensor, measured);
        let eigenvalues = generalized_eigenvalues(&constant, &linear)?;
        let mut roots: Vec<RationalRoot> = eigenvalues
            .into_iter()
            .filter_map(|eigenvalue| self.polish(sensor, measured, eigenvalue.finite()?))
            .collect();
        roots.sort_by(|a, b| a.correction.norm().total_cmp(&b.correction.norm()));
        let mut distinct: Vec<RationalRoot> = Vec::new();
        for root in roots {
            let same = |other: &RationalRoot| {
                (other.correction - root.correction).norm()
                    <= SAME * root.correction.norm().max(SAME * self.scale)
            };
            if !distinct.iter().any(same) {
                distinct.push(root);
            }
        }
        Ok(distinct)
    }

    /// (C, L) with C w = z L w for w = (y, zy, …, z^{d−1}y, 1): the bordered matrix of B-2, its powers of z in companion form.
    ///
    /// Stiffness, load and response differ by many orders of magnitude; with M/α, b/β and uα/β all are of the order of one.
    fn pencil(&self, sensor: usize, measured: c64) -> (Matrix, Matrix) {
        let (n, degree) = (self.size(), self.matrices.len() - 1);
        let size = n * degree.max(1) + 1;
        let last = size - 1;
        let (mut constant, mut linear) = (Matrix::zeros(size, size), Matrix::zeros(size, size));
        let one = c64::new(1.0, 0.0);
        let alpha = self.matrices.iter().map(Matrix::max_modulus).fold(0.0, f64::max);
        let beta = self.load.iter().map(|b| b.norm()).fold(0.0, f64::max);
        for i in 0..n {
            for j in 0..n {
                constant[(i, j)] = self.matrices[0][(i, j)] / alpha;
                for q in 1..=degree {
                    linear[(i, (q - 1) * n + j)] = -self.matrices[q][(i, j)] / alpha;
                }
            }
            constant[(i, last)] = -self.load[i] / beta;
            constant[(last, i)] = self.sensors[sensor][i];
            for q in 1..degree {
                constant[(q * n + i, q * n + i)] = one;
                linear[(q * n + i, (q - 1) * n + i)] = one;
            }
        }
        constant[(last, last)] = -measured * (alpha / beta);
        (constant, linear)
    }

    /// Newton's method on x_m(z) − u; `None` where it leaves or does not settle.
    fn polish(&self, sensor: usize, measured: c64, start: c64) -> Option<RationalRoot> {
        let mut z = start;
        let mut best: Option<(f64, c64)> = None;
        for _ in 0..POLISH {
            let (value, slope) = self.value_and_slope(sensor, z).ok()?;
            let mismatch = (value - measured).norm() / measured.norm();
            if best.is_none_or(|(least, _)| mismatch < least) {
                best = Some((mismatch, z));
            } else {
                break;
            }
            z -= (value - measured) / slope;
        }
        let (mismatch, z) = best?;
        let correction = z * self.scale;
        // A solution is known to roundoff of a response, and where it sits on a flat stretch, to the square root of that.
        let settled = mismatch <= 1e-7 && correction.is_finite();
        let residual = self.residual(correction).ok()?;
        settled.then_some(RationalRoot { correction, mismatch, residual })
    }

    /// x_m(z) = ℓᵀy and x_m′(z) = −(M⁻¹ℓ)ᵀ M′(z) y with M y = b; M is symmetric.
    fn value_and_slope(&self, sensor: usize, z: c64) -> Result<(c64, c64), NoConvergence> {
        let matrix = self.matrix(z);
        let y = solve(&matrix, &self.load)?;
        let adjoint = solve(&matrix, &self.sensors[sensor])?;
        let n = self.size();
        let derivative = Matrix::from_fn(n, n, |i, j| {
            let terms = self.matrices.iter().enumerate().skip(1).rev();
            terms.fold(c64::default(), |sum, (q, a)| sum * z + a[(i, j)] * q as f64)
        });
        let value = transpose_dot(&self.sensors[sensor], &y);
        Ok((value, -transpose_dot(&adjoint, &derivative.multiply(&y))))
    }
}
