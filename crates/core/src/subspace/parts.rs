//! D(ω, c) as a combination of real matrices: each term is one, or two where its values are complex.

use super::{FactorError, ModalErrors, UnknownLoss};
use crate::c64;
use crate::model::{Combination, DynamicStiffness, FactorPart, WeightedTerm};
use frfit_linalg::sparse::Part;
use std::sync::Arc;

/// The real matrices S_g of a model: D = Σ_g θ_g S_g with complex θ_g.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parts {
    each: Vec<(usize, Part)>,
    /// Errors of known factors, which are in every θ_g.
    errors: Vec<FactorError>,
    /// ε of the loss factors of unknowns, and of which.
    loss: f64,
    of_loss: Arc<[UnknownLoss]>,
}

impl Parts {
    pub(super) fn of(model: &DynamicStiffness) -> Self {
        let parts = model.terms().iter().enumerate().flat_map(|(term, t)| {
            let imaginary = t.matrix.is_complex().then_some((term, Part::Im));
            std::iter::once((term, Part::Re)).chain(imaginary)
        });
        Self { each: parts.collect(), errors: Vec::new(), loss: 0.0, of_loss: Arc::new([]) }
    }

    /// The same with errors of known factors and of the loss factors of unknowns.
    pub(super) fn with_errors(&self, errors: &ModalErrors) -> Self {
        let ModalErrors { factors, loss, of_loss, .. } = errors;
        Self { each: self.each.clone(), errors: factors.clone(), loss: *loss, of_loss: of_loss.clone() }
    }

    /// Whether a part is a term's real matrix.
    pub(super) fn is_real(&self, g: usize) -> bool {
        self.each[g].1 == Part::Re
    }

    /// One more part, i times what S_g is multiplied with.
    pub(super) fn add_imaginary(&mut self, g: usize) {
        self.each.push((self.each[g].0, Part::Im));
    }

    pub(super) fn len(&self) -> usize {
        self.each.len()
    }

    /// The term to which a part belongs.
    pub(super) fn term(&self, g: usize) -> usize {
        self.each[g].0
    }

    /// out += S_g X for real vectors, N × k column after column.
    pub(super) fn multiply_add(&self, model: &DynamicStiffness, g: usize, x: &[f64], out: &mut [f64]) {
        let (term, part) = self.each[g];
        model.terms()[term].matrix.multiply_add_real(part, x, out);
    }

    /// θ_g of a combination of terms at a frequency: a complex matrix is S_re + i S_im.
    pub(super) fn weights(&self, combination: &Combination, frequency_hz: f64) -> Vec<c64> {
        let mut weights = vec![c64::default(); self.len()];
        for &WeightedTerm { term, weight: coefficient } in &combination.parts {
            let of_term = self.errors.iter().filter(|error| error.term == term);
            let coefficient = of_term.fold(coefficient, |value, error| error.applied_to(value));
            let of_loss = self.of_loss.iter().filter(|one| one.terms.contains(&term));
            let coefficient =
                of_loss.fold(coefficient, |value, one| value * one.factor(self.loss, frequency_hz));
            for (weight, &(own, part)) in weights.iter_mut().zip(&self.each) {
                if own == term {
                    *weight += coefficient * unit(part);
                }
            }
        }
        weights
    }

    /// ∂θ_g/∂ε by the error of the loss factors of unknowns that is in θ_g.
    pub(super) fn slope_by_loss(&self, g: usize, theta: c64, frequency_hz: f64) -> c64 {
        let of_term = self.of_loss.iter().filter(|one| one.terms.contains(&self.each[g].0));
        of_term.map(|one| theta * one.slope_over_factor(self.loss, frequency_hz)).sum()
    }

    /// ∂θ_g by an error of a known factor that is in θ_g.
    pub(super) fn slope(&self, g: usize, theta: c64, by: &FactorError) -> c64 {
        let (term, part) = self.each[g];
        if term != by.term {
            return c64::default();
        }
        match by.part {
            FactorPart::Storage => theta,
            FactorPart::LossFactor => c64::I * (theta / unit(part)).re * unit(part),
        }
    }
}

/// A complex matrix is S_re + i S_im.
fn unit(part: Part) -> c64 {
    match part {
        Part::Re => c64::new(1.0, 0.0),
        Part::Im => c64::I,
    }
}
