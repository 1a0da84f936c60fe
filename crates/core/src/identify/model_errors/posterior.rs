//! What is known where the errors explain a band best.

use super::estimated::Estimated;
use super::fit::{Explained, STEPS_AT_LAST_LEVEL};
use super::fitting::Fitting;
use super::local_stiffness::add_local_compliance;
use super::measured::{MAX_REST, Measured};
use super::mesh::MeshError;
use super::modal_loss::add_modal_loss;
use crate::subspace::ModalErrors;
use frfit_linalg::dense::Cholesky;

impl Measured<'_, '_> {
    pub(super) fn posterior(
        &self,
        fitting: &Fitting<'_, '_>,
        wrong: Explained,
        evidence: f64,
    ) -> Option<Estimated> {
        let precision = fitting.precision(&wrong.sizes.with_dependent_shapes(fitting.sensors()));
        let whitening = self.noise_and_rest(fitting.lines, wrong.level, wrong.rest);
        let at = fitting.linearised(wrong.found.place)?;
        let (found, _) = fitting.descend(at, &whitening, &precision, STEPS_AT_LAST_LEVEL)?;
        let whole = found.normal.with_prior(&precision);
        let inverse = Cholesky::new(fitting.count(), &whole).ok()?.inverse();
        let sizes = wrong.sizes;
        let estimated = self.estimated(fitting, Explained { found, ..wrong }, &inverse);
        let mut estimated = Estimated { evidence, ..estimated };
        if fitting.modes() > 0 {
            let (count, theta) = (estimated.count(), estimated.theta().to_vec());
            add_local_compliance(&mut estimated.covariance, count, fitting, &theta)?;
            let first_error = estimated.first_of_modes();
            add_modal_loss(&mut estimated.covariance, (count, first_error), fitting, &theta, sizes);
        }
        Some(estimated)
    }

    /// What is at a minimum, with the covariance of the search's coordinates there, n × n.
    pub(super) fn estimated(
        &self,
        fitting: &Fitting<'_, '_>,
        at: Explained,
        covariance: &[f64],
    ) -> Estimated {
        let Explained { found, sizes, level, rest, .. } = at;
        let n = fitting.count();
        let loss = fitting.of_unknown_loss();
        let errors = ModalErrors {
            loss: loss.map_or(0.0, |i| found.place[i]),
            of_loss: fitting.unknown_losses(&found.place),
            ..fitting.errors(&found.place)
        };
        let first = fitting.first_own();
        let modes = errors.stiffness.len();
        let theta = fitting.curves.count();
        // θ, e, ε of the loss factors of unknowns, then the errors of single modes and what follows them.
        let first_kept: Vec<usize> = (0..theta).chain(fitting.of_scale()).chain(loss).collect();
        let before_errors = first_kept.len();
        let kept = n - first + before_errors;
        let of = |a: usize, b: usize| covariance[a * n + b];
        // What of each of the search's coordinates is in θ, e, ε, δ_i, ν_t, a_mi.
        let parts = |a: usize| -> Vec<(usize, f64)> {
            let Some(error) = a.checked_sub(before_errors) else { return vec![(first_kept[a], 1.0)] };
            let own = std::iter::once((first + error, 1.0));
            let shared = (theta..first).filter(|_| error < modes);
            let of_mesh = fitting.of_mesh().filter(|_| error >= modes);
            let of_mesh = of_mesh.map(|(p, _)| (p, fitting.between_shapes(first + error)));
            own.chain(shared.map(|p| (p, fitting.common(error)[p - theta]))).chain(of_mesh).collect()
        };
        let parts: Vec<Vec<(usize, f64)>> = (0..kept).map(parts).collect();
        let entry = |a: usize, b: usize| {
            let row = |&(i, x): &(usize, f64)| parts[b].iter().map(|&(j, y)| x * y * of(i, j)).sum::<f64>();
            parts[a].iter().map(row).sum::<f64>()
        };
        let covariance = (0..kept * kept).map(|k| entry(k % kept, k / kept)).collect();
        Estimated {
            modes: fitting.modes.clone(),
            errors,
            covariance,
            sizes: if modes == 0 { [0.0; 3] } else { [sizes.frequency, sizes.loss_factor, sizes.shape] },
            chi_squared: found.normal.chi_squared,
            numbers: self.numbers(fitting.lines),
            level,
            rest: rest.std.min(MAX_REST),
            evidence: 0.0,
            kinds: fitting.kinds,
            highest_rad_s: fitting.highest_rad_s,
            curves: fitting.curves.clone(),
            factors: fitting.factors.to_vec(),
            mesh: fitting.mesh.cloned(),
            contradicted_assumptions: fitting.contradicted_assumptions(&found.place),
            bars_over_noise: None,
            mesh_error: fitting.of_mesh().map(|(p, mesh)| MeshError {
                paired: mesh.partner_rad_s.iter().flatten().count(),
                expected: mesh.remainder,
                remainder: found.place[p],
                std: of(p, p).max(0.0).sqrt(),
            }),
            place: found.place,
        }
    }
}
