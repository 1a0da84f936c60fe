//! The reduction of a model for a band: its basis, the factorisations behind it, and the work so far.

use super::Projection;
use super::basis::Basis;
use super::parts::Parts;
use super::shift::Shift;
use super::trained_box::TrainedBox;
use crate::frequency::omega_rad_s;
use crate::model::{DynamicStiffness, Experiment, ModelAt};
use crate::response::Work;
use frfit_linalg::solve::Breakdown;

/// A reduced model for a band of frequencies and a range of the parameters.
#[derive(Debug)]
pub struct Subspace<'m> {
    pub(super) model: &'m DynamicStiffness,
    pub(super) experiment: &'m Experiment,
    pub(super) basis: Basis,
    /// The last factorisation: a factor is most of the memory, and one serves the whole band.
    pub(super) shift: Shift,
    /// Whether the first one, below the band, was positive definite: then modes can be counted.
    pub(super) is_definite: bool,
    pub(super) work: Work,
    /// Where it was trained.
    pub(super) boxes: Vec<TrainedBox>,
    /// Solves of a training beyond [`TrainOptions::solves`]: what brought missing modes, and what the modes of the box may take.
    pub(super) more_solves: usize,
}

/// σ of the first shift over ω² at the reference frequency: below the band, where K + σM is positive definite for a free structure too.
const FIRST_SHIFT_RATIO: f64 = 0.01;

impl<'m> Subspace<'m> {
    /// One real factorisation, of Re K + σ Re M with the nominal values at a reference frequency (best the highest of the band),
    /// and one solve for the load and for each sensor.
    ///
    /// # Errors
    /// [`Breakdown`] where neither that matrix nor Re D at the reference frequency can be factorised.
    pub fn new(experiment: &'m Experiment, reference: &ModelAt<'m>) -> Result<Self, Breakdown> {
        let model = reference.model;
        let omega_squared = omega_rad_s(reference.frequency_hz).powi(2);
        let shift = Shift::new(reference, FIRST_SHIFT_RATIO * omega_squared);
        let mut shift = shift.or_else(|_| Shift::new(reference, -omega_squared))?;
        let mut work = Work { factorisations: 1, solves: 0 };
        let is_definite = shift.factor(model, &mut work)?.negative_eigenvalues() == 0;
        let diagonal = shift.sum.diagonal(model);
        let largest = diagonal.iter().copied().fold(0.0, f64::max);
        // A row without any stiffness or mass of its own (a constraint) still needs a weight.
        let weight = diagonal.iter().map(|&d| d.max(1e-12 * largest)).collect();
        let basis = Basis::new(weight, Parts::of(model), experiment);
        let mut subspace =
            Self { model, experiment, basis, shift, is_definite, work, boxes: Vec::new(), more_solves: 0 };
        subspace.start()?;
        Ok(subspace)
    }

    /// The model.
    pub(crate) fn model(&self) -> &'m DynamicStiffness {
        self.model
    }

    /// Everything small: what answers at any frequency of the band.
    pub fn projection(&self) -> &Projection {
        &self.basis.projection
    }

    /// Number of basis vectors r.
    pub fn size(&self) -> usize {
        self.projection().size()
    }

    /// Real factorisations and solves so far: all the work of size N but products and projections.
    pub fn work(&self) -> Work {
        self.work
    }
}
