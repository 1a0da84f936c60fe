//! All solutions of x_m(c) = u on the reduced model, B-2.

use super::RationalResponse;
use crate::c64;
use frfit_linalg::dense::{Ldlt, Matrix, NoConvergence, eigenvalues};
use frfit_linalg::vector::transpose_dot;

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
const MAX_POLISH_STEPS: usize = 8;

/// Two roots nearer than this, relative to the larger, are one.
const ROOT_MERGE_RTOL: f64 = 1e-9;

impl RationalResponse {
    /// All finite solutions at a sensor, least |c| first: [`Self::starts`] polished by Newton's method, duplicates merged. Those that Newton's
    /// method does not confirm are left out.
    ///
    /// # Errors
    /// [`NoConvergence`] where the eigenvalue iteration fails.
    ///
    /// # Limits
    /// Solutions of the *reduced* model: where the residual is large, of nothing else.
    pub fn roots(&self, sensor: usize, measured: c64) -> Result<Vec<RationalRoot>, NoConvergence> {
        let starts = self.starts(sensor, measured)?;
        let mut roots: Vec<RationalRoot> = starts
            .into_iter()
            .filter_map(|start| self.polish(sensor, measured, start / self.scale))
            .collect();
        roots.sort_by(|a, b| a.correction.norm().total_cmp(&b.correction.norm()));
        let mut distinct: Vec<RationalRoot> = Vec::new();
        for root in roots {
            let same = |other: &RationalRoot| {
                (other.correction - root.correction).norm()
                    <= ROOT_MERGE_RTOL * root.correction.norm().max(ROOT_MERGE_RTOL * self.scale)
            };
            if !distinct.iter().any(same) {
                distinct.push(root);
            }
        }
        Ok(distinct)
    }

    /// Corrections near all solutions of x_m(c) = u, in no order: eigenvalues, to be polished.
    ///
    /// With M(z) y = b and ℓᵀy = u, (M(z) − b ℓᵀ/u) y = 0. With G_q = M₀⁻¹M_q and x₀ = M₀⁻¹b, by Sherman and Morrison, for w = 1/z
    /// $$ w^d y = -\sum_{q=1}^d w^{d-q} \Big(1 + \frac{x_0 \ell^T}{u - \ell^T x_0}\Big) G_q y, $$
    /// an ordinary eigenproblem in companion form, of size d·n.
    ///
    /// # Errors
    /// [`NoConvergence`] where the eigenvalue iteration fails.
    pub fn starts(&self, sensor: usize, measured: c64) -> Result<Vec<c64>, NoConvergence> {
        let (n, degree) = (self.size(), self.matrices.len() - 1);
        if n == 0 {
            return Ok(Vec::new()); // nothing is driven
        }
        let columns = self.matrices[1..].iter().flat_map(|a| (0..n).flat_map(|j| a.column(j)));
        let mut block: Vec<c64> = columns.chain(&self.load).copied().collect();
        Ldlt::new(&self.matrices[0])?.solve(&mut block)?;
        let (g, x0) = block.split_at(n * n * degree);
        let l = &self.sensors[sensor];
        // Where the nominal response is the measured one, z = 0 is a solution and the formula divides by zero: a millionth beside it is near
        // enough for a start.
        let gap = measured - transpose_dot(l, x0);
        let gap = if gap.norm() < 1e-6 * measured.norm() { measured * 1e-6 } else { gap };
        let row: Vec<c64> = g.chunks_exact(n).map(|column| transpose_dot(l, column) / gap).collect();
        let mut companion = Matrix::zeros(n * degree, n * degree);
        for (j, (column, along)) in g.chunks_exact(n).zip(&row).enumerate() {
            for i in 0..n {
                companion[(i, j)] = -(column[i] + x0[i] * along);
            }
        }
        for i in n..n * degree {
            companion[(i, i - n)] = c64::new(1.0, 0.0);
        }
        let corrections = eigenvalues(&companion)?.into_iter().map(|w| w.inv() * self.scale);
        Ok(corrections.filter(|c| c.is_finite()).collect())
    }

    /// Newton's method on x_m(z) − u; `None` where it leaves or does not settle.
    fn polish(&self, sensor: usize, measured: c64, start: c64) -> Option<RationalRoot> {
        let mut z = start;
        let mut best: Option<(f64, c64)> = None;
        for _ in 0..MAX_POLISH_STEPS {
            let (values, slopes) = self.respond_with_slope(z * self.scale).ok()?;
            let mismatch = (values[sensor] - measured).norm() / measured.norm();
            if best.is_none_or(|(least, _)| mismatch < least) {
                best = Some((mismatch, z));
            } else {
                break;
            }
            z -= (values[sensor] - measured) / (slopes[sensor] * self.scale);
        }
        let (mismatch, z) = best?;
        let correction = z * self.scale;
        // A solution is known to roundoff of a response, and where it sits on a flat stretch, to the square root of that.
        let settled = mismatch <= 1e-7 && correction.is_finite();
        let residual = self.residual(correction).ok()?;
        settled.then_some(RationalRoot { correction, mismatch, residual })
    }

    /// x_m(c) = ℓ_mᵀy and ∂x_m/∂c = −(M⁻¹ℓ_m)ᵀ M′ y at all sensors, with M y = b; M is symmetric.
    ///
    /// # Errors
    /// [`NoConvergence`] where c is a pole to working precision.
    pub fn respond_with_slope(&self, correction: c64) -> Result<(Vec<c64>, Vec<c64>), NoConvergence> {
        let (n, z) = (self.size(), correction / self.scale);
        let mut block: Vec<c64> = self.load.iter().chain(self.sensors.iter().flatten()).copied().collect();
        Ldlt::new(&self.matrix(z))?.solve(&mut block)?;
        let (y, adjoints) = block.split_at(n);
        let derivative = Matrix::from_fn(n, n, |i, j| {
            let terms = self.matrices.iter().enumerate().skip(1).rev();
            terms.fold(c64::default(), |sum, (q, a)| sum * z + a[(i, j)] * q as f64)
        });
        let change = derivative.multiply(y);
        let values = self.sensors.iter().map(|l| transpose_dot(l, y)).collect();
        let slope = |adjoint: &[c64]| -transpose_dot(adjoint, &change) / self.scale;
        Ok((values, adjoints.chunks_exact(n).map(slope).collect()))
    }

    /// ∂²x_m/∂c² = (M⁻¹ℓ_m)ᵀ (2 M′M⁻¹M′ − M″) y at all sensors, with M y = b.
    ///
    /// # Errors
    /// [`NoConvergence`] where c is a pole to working precision.
    pub fn second_derivative(&self, correction: c64) -> Result<Vec<c64>, NoConvergence> {
        let (n, z) = (self.size(), correction / self.scale);
        let mut block: Vec<c64> = self.load.iter().chain(self.sensors.iter().flatten()).copied().collect();
        let factor = Ldlt::new(&self.matrix(z))?;
        factor.solve(&mut block)?;
        let (y, adjoints) = block.split_at(n);
        let derivative = |weight: fn(usize) -> f64, skipped: usize| {
            Matrix::from_fn(n, n, |i, j| {
                let terms = self.matrices.iter().enumerate().skip(skipped).rev();
                terms.fold(c64::default(), |sum, (q, a)| sum * z + a[(i, j)] * weight(q))
            })
        };
        let first = derivative(|q| q as f64, 1);
        let mut change = first.multiply(y);
        factor.solve(&mut change)?;
        let (twice, second) = (first.multiply(&change), derivative(|q| (q * (q - 1)) as f64, 2).multiply(y));
        let bend: Vec<c64> = twice.iter().zip(&second).map(|(a, b)| 2.0 * a - b).collect();
        let scale = self.scale * self.scale;
        Ok(adjoints.chunks_exact(n).map(|adjoint| transpose_dot(adjoint, &bend) / scale).collect())
    }
}
