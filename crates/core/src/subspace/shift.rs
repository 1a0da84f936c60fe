//! Real symmetric stand-ins for D, factorised: what turns residuals into directions.

use crate::c64;
use crate::model::{DynamicStiffness, ModelAt, Role, WeightedTerm};
use crate::response::Work;
use frfit_linalg::solve::{Breakdown, CheckedFactor};

/// Re K + σ Re M at the nominal values, factorised. σ > 0: positive definite, free structure or not; σ = −ω²: Re D(ω) without its
/// viscous terms.
#[derive(Debug)]
pub(super) struct Shift {
    pub(super) sum: ShiftedSum,
    /// None of one that was kept beyond a run: it is made when it is needed.
    factor: Option<CheckedFactor<f64>>,
}

/// Re K + σ Re M as Σ w_t Re S_t.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ShiftedSum {
    /// (t, w_t).
    pub(super) weights: Vec<(usize, f64)>,
}

impl ShiftedSum {
    /// From the nominal values that the model has at one frequency.
    fn new(at: &ModelAt<'_>, sigma: f64) -> Self {
        let model: &DynamicStiffness = at.model;
        let weight = |&WeightedTerm { term, weight: coefficient }: &WeightedTerm| {
            let role = model.terms()[term].role;
            if sigma == 0.0 && role != Role::Stiffness {
                return None; // at 0 Hz, where the weight does not determine the factor
            }
            let factor: c64 = coefficient / model.weight(role, at.frequency_hz);
            match role {
                Role::Stiffness => Some((term, factor.re)),
                Role::Mass => Some((term, sigma * factor.re)),
                Role::Viscous => None,
            }
        };
        Self { weights: at.nominal.parts.iter().filter_map(weight).collect() }
    }

    /// The moduli of the diagonal.
    pub(super) fn diagonal(&self, model: &DynamicStiffness) -> Vec<f64> {
        let entry = |i: usize| -> f64 {
            let of = |&(term, weight): &(usize, f64)| weight * model.terms()[term].matrix.get(i, i).re;
            self.weights.iter().map(of).sum::<f64>().abs()
        };
        (0..model.dim()).map(entry).collect()
    }

    fn factorise(&self, model: &DynamicStiffness) -> Result<CheckedFactor<f64>, Breakdown> {
        let mut values = vec![0.0; model.analysis().pattern().stored()];
        for &(term, weight) in &self.weights {
            model.terms()[term].matrix.accumulate_real_into(weight, &mut values);
        }
        model.analysis().factor_on(&values, model.threads())
    }
}

impl Shift {
    /// From the nominal values that the model has at one frequency.
    pub(super) fn new(at: &ModelAt<'_>, sigma: f64) -> Result<Self, Breakdown> {
        let sum = ShiftedSum::new(at, sigma);
        let factor = sum.factorise(at.model)?;
        Ok(Self { sum, factor: Some(factor) })
    }

    /// One that was kept, to be factorised when it is needed.
    pub(super) fn kept(sum: ShiftedSum) -> Self {
        Self { sum, factor: None }
    }

    /// Gives the memory of the factor back, for another one.
    pub(super) fn forget_factor(&mut self) {
        self.factor = None;
    }

    /// The factor, and the work of one that was not there yet.
    pub(super) fn factor(
        &mut self,
        model: &DynamicStiffness,
        work: &mut Work,
    ) -> Result<&CheckedFactor<f64>, Breakdown> {
        let factor = match self.factor.take() {
            Some(factor) => factor,
            None => {
                work.factorisations += 1;
                self.sum.factorise(model)?
            }
        };
        Ok(self.factor.insert(factor))
    }
}
