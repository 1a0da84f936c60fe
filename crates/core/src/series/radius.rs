//! How far the series converges, P-14.

use super::recursion::{next_term, scale};
use crate::c64;
use crate::response::Response;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::spectral::{SpectralOptions, spectral_radius};
use std::collections::VecDeque;

/// Relative residual of the eigenpair. The operator is symmetric in the bilinear form of A₁, so the eigenvalue's error is of
/// the order of its square: more digits than a spectral radius is read to.
const EIGENPAIR_RTOL: f64 = 1e-4;

/// The largest |c| for which the series converges, with its evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvergenceRadius {
    /// ρ(−c A₀⁻¹A₁)/|c|, one over the unit of the parameter.
    pub per_unit: f64,
    /// Relative residual of the eigenpair behind it.
    pub residual: f64,
    /// Whether that residual is under the tolerance.
    pub converged: bool,
}

impl ConvergenceRadius {
    /// ρ at the correction c: the series converges iff this is below one.
    ///
    /// For a parameter that enters with powers (B-8) this is |c| over the distance to the nearest pole,
    /// which is the same statement.
    pub fn at(&self, correction: c64) -> f64 {
        self.per_unit * correction.norm()
    }
}

/// The spectral radius per unit of correction, from the operator alone: no eigenvector needs to be excited by the load.
///
/// With powers up to d the operator is the companion form of the recursion, on d stacked vectors.
///
/// # Errors
/// [`Breakdown`] where a solve with A₀ fails.
///
/// # Limits
/// Those of [`spectral_radius`]; a pole that the load does not excite, or no sensor sees, counts all the same.
pub fn convergence_radius(system: &impl Response, parameter: usize) -> Result<ConvergenceRadius, Breakdown> {
    let (n, degree) = (system.dim(), system.degree(parameter));
    let scale = scale(system, parameter)?;
    let companion = |stacked: &[c64], out: &mut [c64]| {
        let recent: VecDeque<Vec<c64>> = stacked.chunks_exact(n).map(<[c64]>::to_vec).collect();
        out[..n].copy_from_slice(&next_term(system, parameter, scale, &recent)?);
        out[n..].copy_from_slice(&stacked[..n * (degree - 1)]);
        Ok(())
    };
    let options = SpectralOptions { tolerance: EIGENPAIR_RTOL, ..SpectralOptions::default() };
    let found = spectral_radius(n * degree, companion, &options)?;
    Ok(ConvergenceRadius {
        per_unit: found.radius / scale,
        residual: found.residual,
        converged: found.converged,
    })
}
