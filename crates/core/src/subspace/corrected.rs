//! A reduced model that is corrected for errors (B-11), and the models of its neighbourhoods.

use super::{Assessment, ModalErrors, Modes, Point, Projection};
use crate::c64;
use crate::model::ModelAt;
use frfit_linalg::solve::Breakdown;
use std::sync::Arc;

/// A whole reduced model with errors in it.
#[derive(Debug, Clone)]
pub(crate) struct Corrected {
    pub(crate) modes: Modes,
    pub(crate) errors: ModalErrors,
    pub(crate) model: Projection,
}

impl Corrected {
    pub(crate) fn new(whole: &Projection, modes: &Modes, errors: &ModalErrors) -> Self {
        let model = whole.with_errors(modes, errors);
        Self { modes: modes.clone(), errors: errors.clone(), model }
    }

    /// The same errors in a reduced model to which vectors were added.
    pub(crate) fn in_larger(&self, whole: &Projection) -> Self {
        Self::new(whole, &self.modes.in_larger(whole), &self.errors)
    }
}

/// The model of a neighbourhood: good near some points.
#[derive(Debug, Clone)]
pub(crate) struct Local {
    /// As the full model is.
    own: Arc<Projection>,
    /// Corrected for the errors of the model, where there are any.
    corrected: Option<Projection>,
}

impl Local {
    /// The full model's, and beside it that of the corrected model, good at some points.
    pub(crate) fn new(
        own: Arc<Projection>,
        corrected: Option<&Corrected>,
        points: &[Point<'_>],
        tolerance: f64,
    ) -> Self {
        Self { corrected: corrected.map(|corrected| corrected.model.localised(points, tolerance)), own }
    }

    /// The full model's.
    pub(crate) fn own(&self) -> &Arc<Projection> {
        &self.own
    }

    /// What answers there.
    pub(crate) fn model(&self) -> &Projection {
        self.corrected.as_ref().unwrap_or(&self.own)
    }

    /// How good it is. A model with errors in it knows how far it is from the whole reduced one; that one knows how far it is from the full one.
    ///
    /// # Errors
    /// [`Breakdown`] where the reduced system is singular.
    pub(crate) fn assess(&self, at: &ModelAt<'_>, correction: c64) -> Result<Assessment, Breakdown> {
        let mut assessed = self.model().assess(at, correction)?;
        if self.corrected.is_some() {
            let of_full = self.own.assess(at, correction)?;
            let sum =
                |own: &mut Vec<f64>, other: Vec<f64>| own.iter_mut().zip(other).for_each(|(a, b)| *a += b);
            sum(&mut assessed.truncation, of_full.truncation);
            sum(&mut assessed.roundoff, of_full.roundoff);
        }
        Ok(assessed)
    }
}
