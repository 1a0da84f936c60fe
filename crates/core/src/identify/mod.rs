//! From a measured response to the values that reproduce it, and how far to trust them.
//!
//! [`identify`] is the one entry: a [`Problem`] says what is known and what is not, an [`Identification`] what came out.
//!
//! | file | contents |
//! |---|---|
//! | `problem` | what is to be identified, checked |
//! | `reduced_band` | one reduced model, shared with the diagnostics |
//! | `band` | a single unknown: all solutions at each frequency, one path through the band, laws, a smooth curve |
//! | `several` | any number of unknowns in one least squares |
//! | `one` | a single frequency, as the paper has it |
//! | `outcome`, `band_value`, `identification` | what came out of a line, of what holds for the band, and of the whole |

mod band;
mod band_value;
mod causality_breach;
mod channel;
mod channel_coordinates;
mod choice;
mod coarser_mesh;
mod common_noise;
mod confirmation;
mod context;
mod dead_channel;
mod far_nominal;
mod form;
mod goodness_of_fit;
mod identification;
mod local_fit;
mod measured;
mod model_errors;
mod noise;
mod noise_floor;
mod one;
mod options;
mod outcome;
mod problem;
mod problem_error;
mod rational;
mod real_frequencies;
mod reduced_band;
mod several;
mod shown_modes;
#[cfg(test)]
mod simulated;
mod uncertainty;
mod unknown;

pub use crate::frfs::{CommonNoise, Frfs, Noise, NoiseFloor};
pub use crate::response::relative_error;
pub use band::SmoothCurve;
pub(crate) use band::{DELAY_PHASE_STEP_RAD, MAX_DELAY_PHASE_RAD};
pub use band_value::{BandCoordinate, BandValue, Direction, Number, NumberOf, Profile};
pub use causality_breach::CausalityBreach;
pub use channel::{Calibrated, Calibration, ChannelUnknowns};
pub use choice::{Method, Reduction, Selection, UnknownChoice};
pub use coarser_mesh::CoarserMesh;
pub use context::{Context, Stage};
pub(crate) use dead_channel::{dead_channels, live_channels};
pub use goodness_of_fit::{Explained, GoodnessOfFit, SensorFit};
pub use identification::{Identifiability, Identification, SearchReport};
pub use model_errors::{
    Assumption, CalibrationError, ContradictedAssumption, FactorError, Leverage, LeverageOf, MeshError,
    ModeError, ModelErrorsFound, SensorMass,
};
pub use noise::{NoiseLevel, NoiseSource};
pub use one::{error_by_order, identify_at};
pub use options::{ErrorSizes, MAX_ORDER, ModelErrors, Options, OptionsError};
pub use outcome::{Line, LineSolution, LineValue, Standing, Status, Trust};
pub use problem::Problem;
pub use problem_error::ProblemError;
pub use reduced_band::ReducedBand;
pub(crate) use shown_modes::ShownModes;
pub use uncertainty::{Contributions, Uncertainty};
pub use unknown::{Dependence, Unknown, Variation};

use causality_breach::causality_breaches;
use problem::Strategy;
use real_frequencies::at_real_frequencies;

/// Identifies the unknowns of a problem.
///
/// One reduced model (B-3) answers for the whole band, with an estimate of its error in every line; where it cannot be built, the
/// full model answers. A single factor is found with all its solutions at each frequency (B-2), fitted to all sensors (B-5), and one
/// path is chosen through the band (B-4); a law (B-7) or a smooth curve (B-9) begins there. Several unknowns, constants and
/// geometric parameters are found in one least squares in which what each frequency has of its own is eliminated (B-8). Channels of unknown
/// scale or delay are found together with the unknowns.
///
/// # Errors
/// [`ProblemError`] for options that do not belong to the problem. Numerical trouble is a [`Status`] with its evidence, never an
/// error.
///
/// # Limits
/// An error of the model that all modes have in common with an unknown is in the error bars by its usual size alone. Of several
/// unknowns that a frequency has of its own, the solutions are those that several starts lead to, not provably all.
pub fn identify(
    problem: &Problem<'_>,
    options: &Options,
    context: Context<'_>,
) -> Result<Identification, ProblemError> {
    identify_on(&mut ReducedBand::default(), problem, options, context)
}

/// The same on a reduced model that is shared with [`diagnose_on`](crate::diagnostics::diagnose_on): one that is trained already
/// is trained further only at the answers.
///
/// # Errors
/// As [`identify`].
pub fn identify_on<'a>(
    reduced: &mut ReducedBand<'a>,
    problem: &'a Problem<'a>,
    options: &Options,
    context: Context<'_>,
) -> Result<Identification, ProblemError> {
    problem.check_options(options)?;
    let channels = problem.channels();
    reduced.begin(problem);
    let trained = &mut reduced.subspace;
    let found: Identification = match problem.single() {
        None => several::identify_several(problem, trained, options, context)?,
        Some((strategy, parameter)) => {
            let band = &problem.band(0, parameter);
            match strategy {
                Strategy::PerFrequency if channels.is_empty() => {
                    band::identify_band(band, trained, options, context)?.into()
                }
                Strategy::PerFrequency => {
                    let (found, channels) =
                        band::identify_band_scaled(band, trained, channels, options, context)?;
                    Identification { channels, ..found.into() }
                }
                Strategy::Smooth => band::identify_smooth(band, trained, options, context)?.into(),
                Strategy::Law(kinds) => {
                    band::identify_laws(band, trained, (channels, kinds), options, context)?.into()
                }
            }
        }
    };
    let mut found = at_real_frequencies(found, problem);
    found.causality_breaches = causality_breaches(problem.model(), problem.unknowns(), &found.lines);
    Ok(found)
}
