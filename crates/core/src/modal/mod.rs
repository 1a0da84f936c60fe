//! Natural frequencies, damping and shapes of a model and of what was measured, side by side.
//!
//! | file | contents |
//! |---|---|
//! | `stabilisation` | poles of measured responses at growing orders (LSCF) |
//! | `rational_fit` | poles fitted to all lines at once, with their covariance |
//! | `pieces` | the resonances of each piece of the band, for leakage and shifts |
//! | `hann`, `leakage` | what a Hann window makes of a resonance, and of measured responses |
//! | `frequency_shifts` | natural frequencies that differ from sensor to sensor |
//! | `left_over` | resonances in what the fitted poles leave |
//! | `measured_modes` | which of them are modes |
//! | `pairing` | which mode of the model is which of the measurement |
//! | `correlation` | MAC, COMAC, FRAC, CSAC, CSF |
//!
//! The modes of a model are those of its reduced model: [`Subspace::natural_modes`](crate::subspace::Subspace::natural_modes).

mod correlation;
mod frequency_shifts;
mod hann;
mod leakage;
mod left_over;
mod measured_modes;
mod pairing;
mod pieces;
mod rational_fit;
mod stabilisation;
mod stiffness_factors;

pub use correlation::{assurance, coordinate_assurance, scale_assurance};
pub use frequency_shifts::{FrequencyShifts, frequency_shifts};
pub use leakage::{HANN_LEAKAGE_RSTD, cut_off, hann_evidence, hann_leakage};
pub use measured_modes::{MeasuredMode, MeasuredModes, PoleOptions, measured_modes};
pub use pairing::{Pair, PairedShape, Pairing, paired};
pub(crate) use pairing::{best, nearest_pairs};
pub use stabilisation::PoleAtOrder;
pub(crate) use stiffness_factors::{LOG_FACTOR_STD, by_shares, stiffness_factors};
