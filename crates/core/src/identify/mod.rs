//! From a measured response to the factor that reproduces it, and how far to trust it.

mod band;
mod choice;
mod one;
mod options;
mod outcome;
mod rational;
mod several;
mod uncertainty;

pub use band::{
    Band, BandOutcome, Calibrated, Calibration, ChannelUnknowns, Context, Explained, GoodnessOfFit,
    LawsOutcome, Noise, NoiseLevel, NoiseSource, SensorFit, SmoothCurve, SmoothOutcome, Stage, identify_band,
    identify_band_scaled, identify_laws, identify_laws_scaled, identify_smooth,
};
pub(crate) use band::{MOST_PHASE, PHASE_STEP};
pub use choice::{Method, Reduction, Selection, UnknownChoice};
pub use one::{error_by_order, identify_at, relative_error};
pub use options::{MAX_ORDER, Options, OptionsError};
pub use outcome::{Identified, Status};
pub use several::{
    BandValue, Dependence, Direction, Number, Profile, Several, SeveralAt, SeveralOutcome, Unknown, ValueAt,
    Variation, identify_several,
};
pub use uncertainty::Uncertainty;
