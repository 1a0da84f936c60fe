//! One real subspace for a whole band: few real factorisations, every dense object afterwards tens by tens.
//!
//! B-3: with real matrices S_g and complex factors θ_g the dynamic stiffness is D(ω, c) = Σ_g θ_g S_g. One real basis V of N × r gives
//! $$ x_m \approx \ell_m^T V \Big(\sum_g \theta_g V^T S_g V\Big)^{-1} V^T F $$
//! at every frequency and every value of the parameter. V starts with S⁻¹F and S⁻¹ℓ_m, S = Re K + σ Re M, and grows where the
//! estimated error at the sensors is largest, by S⁻¹ times the residuals there: that of the response x, and that of the sensor's own
//! response z_m = D⁻¹ℓ_m. The error at sensor m is then exactly r_zᵀ D⁻¹ r_x, a product of two small residuals, and is estimated as
//! γ ‖r_z‖ ‖r_x‖ with the gain γ measured at every solve.
//!
//! # Source
//! G. Rozza, D. B. P. Huynh, A. T. Patera, Arch. Comput. Methods Eng. 15 (2008) 229–275 (greedy reduced bases, dual-weighted errors);
//! A. C. Antoulas, *Approximation of Large-Scale Dynamical Systems*, SIAM 2005 (rational Krylov).

mod assess;
mod basis;
mod changes;
mod corrected;
mod local;
mod modes;
mod parts;
mod pole_residue;
mod projection;
mod reduced;
mod shift;
mod sketch;
mod train;
mod train_changes;

pub use assess::Assessment;
pub use changes::{ChangePoint, Changed};
pub(crate) use corrected::{Corrected, Local};
pub(crate) use modes::{ErrorSlopes, FactorError, ModalErrors, Modes};
pub use pole_residue::{Drive, PoleResidue};
pub use projection::Projection;
pub use reduced::ReducedModel;
pub use train::{Point, TrainOptions, Trained};
pub use train_changes::ChangeOptions;

use crate::frequency::omega_rad_s;
use crate::model::{DynamicStiffness, Experiment, ModelAt};
use crate::response::Work;
use basis::Basis;
use frfit_linalg::solve::Breakdown;
use parts::Parts;
use shift::Shift;

/// A reduced model for a band of frequencies and a range of the parameters.
#[derive(Debug)]
pub struct Subspace<'m> {
    model: &'m DynamicStiffness,
    experiment: &'m Experiment,
    basis: Basis,
    shifts: Vec<Shift>,
    work: Work,
}

/// σ of the first shift over ω² at the reference frequency: below the band, where K + σM is positive definite for a free structure too.
const BELOW: f64 = 0.01;

impl<'m> Subspace<'m> {
    /// One real factorisation, of Re K + σ Re M with the nominal values at a reference frequency (best the highest of the band),
    /// and one solve for the load and for each sensor.
    ///
    /// # Errors
    /// [`Breakdown`] where neither that matrix nor Re D at the reference frequency can be factorised.
    pub fn new(experiment: &'m Experiment, reference: &ModelAt<'m>) -> Result<Self, Breakdown> {
        let model = reference.model;
        let omega_squared = omega_rad_s(reference.frequency_hz).powi(2);
        let shift = Shift::new(reference, BELOW * omega_squared);
        let shift = shift.or_else(|_| Shift::new(reference, -omega_squared))?;
        let largest = shift.diagonal.iter().copied().fold(0.0, f64::max);
        // A row without any stiffness or mass of its own (a constraint) still needs a weight.
        let weight = shift.diagonal.iter().map(|&d| d.max(1e-12 * largest)).collect();
        let basis = Basis::new(weight, Parts::of(model), experiment);
        let work = Work { factorisations: 1, solves: 0 };
        let mut subspace = Self { model, experiment, basis, shifts: vec![shift], work };
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
