//! D(ω, c) as a combination of real matrices: each term is one, or two where its values are complex.

use crate::c64;
use crate::model::{Combination, DynamicStiffness};
use frfit_linalg::sparse::Part;

/// The real matrices S_g of a model: D = Σ_g θ_g S_g with complex θ_g.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Parts(Vec<(usize, Part)>);

impl Parts {
    pub(super) fn of(model: &DynamicStiffness) -> Self {
        let parts = model.terms().iter().enumerate().flat_map(|(term, t)| {
            let imaginary = t.matrix.is_complex().then_some((term, Part::Im));
            std::iter::once((term, Part::Re)).chain(imaginary)
        });
        Self(parts.collect())
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The term to which a part belongs.
    pub(super) fn term(&self, g: usize) -> usize {
        self.0[g].0
    }

    /// out += S_g X for real vectors, N × k column after column.
    pub(super) fn multiply_add(&self, model: &DynamicStiffness, g: usize, x: &[f64], out: &mut [f64]) {
        let (term, part) = self.0[g];
        model.terms()[term].matrix.multiply_add_real(part, x, out);
    }

    /// θ_g of a combination of terms: a complex matrix is S_re + i S_im.
    pub(super) fn weights(&self, combination: &Combination) -> Vec<c64> {
        let mut weights = vec![c64::default(); self.len()];
        for &(term, coefficient) in &combination.parts {
            for (weight, &(own, part)) in weights.iter_mut().zip(&self.0) {
                if own == term {
                    *weight += match part {
                        Part::Re => coefficient,
                        Part::Im => coefficient * c64::I,
                    };
                }
            }
        }
        weights
    }
}
