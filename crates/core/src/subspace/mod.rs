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
mod factor_error;
mod kept;
mod local;
mod missing_modes;
mod modal_sums;
mod modes;
mod natural_modes;
mod parts;
mod pole_residue;
mod projection;
mod reduced;
mod reduction;
mod shift;
mod sketch;
mod train;
mod train_changes;
mod trained_box;
mod unknown_loss;

pub use assess::Assessment;
pub use changes::{ChangePoint, Changed};
pub(crate) use corrected::{Corrected, Local};
pub(crate) use factor_error::FactorError;
pub use kept::{KeptArray, KeptError, KeptSubspace};
pub use missing_modes::{MAX_COUNTED_DOFS, ModeCount};
pub(crate) use modal_sums::ModalSums;
pub(crate) use modes::{AlongMode, ErrorSlopes, ModalErrors, Modes};
pub use natural_modes::{ModelAtFrequency, NaturalMode, NaturalModes, NaturalModesError};
pub use pole_residue::{Drive, PoleResidue};
pub use projection::Projection;
pub use reduced::ReducedModel;
pub use reduction::Subspace;
pub use train::{Point, TrainOptions, Trained};
pub use train_changes::ChangeOptions;
pub(crate) use unknown_loss::UnknownLoss;
