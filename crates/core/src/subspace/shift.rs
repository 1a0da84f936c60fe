//! Real symmetric stand-ins for D, factorised: what turns residuals into directions.

use crate::c64;
use crate::frequency::omega_rad_s;
use crate::model::{DynamicStiffness, ModelAt, Role, WeightedTerm};
use frfit_linalg::solve::{Breakdown, CheckedFactor};

/// Re K + σ Re M at the nominal values, factorised. σ > 0: positive definite, free structure or not; σ = −ω²: Re D(ω) without its
/// viscous terms.
#[derive(Debug)]
pub(super) struct Shift {
    /// √|σ|/2π with the sign of −σ: a negative one is below the band.
    pub(super) frequency_hz: f64,
    pub(super) factor: CheckedFactor<f64>,
    /// The diagonal's moduli.
    pub(super) diagonal: Vec<f64>,
}

impl Shift {
    /// From the nominal values that the model has at one frequency.
    pub(super) fn new(at: &ModelAt<'_>, sigma: f64) -> Result<Self, Breakdown> {
        let model: &DynamicStiffness = at.model;
        let pattern = model.analysis().pattern();
        let mut values = vec![0.0; pattern.stored()];
        for &WeightedTerm { term, weight: coefficient } in &at.nominal.parts {
            let term = &model.terms()[term];
            if sigma == 0.0 && term.role != Role::Stiffness {
                continue; // at 0 Hz, where the weight does not determine the factor
            }
            let factor: c64 = coefficient / model.weight(term.role, at.frequency_hz);
            let weight = match term.role {
                Role::Stiffness => factor.re,
                Role::Mass => sigma * factor.re,
                Role::Viscous => continue,
            };
            term.matrix.accumulate_real_into(weight, &mut values);
        }
        let on_diagonal = |i: usize| pattern.find(i, i).map_or(0.0, |k| values[k].abs());
        let diagonal = (0..pattern.dim()).map(on_diagonal).collect();
        let factor = model.analysis().factor_on(&values, model.threads())?;
        let frequency_hz = -sigma.signum() * sigma.abs().sqrt() / omega_rad_s(1.0);
        Ok(Self { frequency_hz, factor, diagonal })
    }
}
