//! A whole band: all frequencies, and all sensors, together or one by one.

mod calibration;
mod candidates;
mod channels;
mod continuation;
mod corrected;
mod exploration_grid;
mod fit;
mod initial_calibration;
mod joint;
mod law_fitting;
mod laws;
mod matching;
mod neighbourhoods;
mod on_reduced;
mod outcome;
mod outlier_sensor;
mod path_model;
mod per_frequency;
mod scaled;
mod search_box;
mod smooth;
mod task;
mod verdict;

pub(super) use calibration::identify_band_scaled;
pub(super) use candidates::Fit;
pub(super) use initial_calibration::by_shape;
pub(crate) use initial_calibration::{DELAY_PHASE_STEP_RAD, MAX_DELAY_PHASE_RAD};
pub(super) use laws::{LawsOutcome, MAX_TRAINING_ROUNDS, identify_laws, law_through, nearest};
pub(super) use neighbourhoods::{
    BOX_TOL, MAX_NEIGHBOURHOODS, MAX_REDUCTION_ERROR, MAX_TRAINING_FREQUENCIES, MIN_NEIGHBOURHOOD_LINES,
    TRAINED_TOL, is_certain, reduction_error, train,
};
pub(super) use outcome::BandOutcome;
pub(super) use outlier_sensor::{OUTLIER_FREQUENCIES, OUTLIER_RATIO};
pub use smooth::SmoothCurve;
pub(super) use smooth::{SmoothOutcome, identify_smooth};

use super::choice::{Reduction, Selection};
use super::context::Context;
use super::measured::Band;
use super::options::Options;
use crate::material::OutsideTable;
use crate::model::ModelAt;
use crate::subspace::Subspace;
use neighbourhoods::Neighbourhoods;
use search_box::near_or_far;

/// Identifies the first parameter at every frequency of a band.
///
/// With the subspace (B-3) every answer carries its reduction error; where it cannot be built, the full model answers. The joint selection (B-4, B-5) finds
/// every solution within the bounds at every sensor, fits it to all sensors, and chooses one path through all; the other one is
/// [`crate::identify::identify_at`] at each frequency. Answers are searched within a factor of four of the nominal, of where natural frequencies say
/// that it is, or in the whole of the bounds where that leaves most of the band without any.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
pub(super) fn identify_band<'a>(
    band: &Band<'a>,
    trained: &mut Option<Subspace<'a>>,
    options: &Options,
    context: Context<'_>,
) -> Result<BandOutcome, OutsideTable> {
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let mut reduced = Neighbourhoods::if_wanted(band, &at, trained, options, context);
    let (found, (), options) =
        near_or_far((band, &at), options, &mut reduced, true, context, |options, reduced| {
            (identify_at_all(band, &at, reduced.as_mut(), options, context), ())
        });
    let options = &options;
    // A model that is answered for as it is has no modes at hand: they are those of a reduced one.
    let wanted = options.selection == Selection::Joint && options.reduction == Reduction::Auto;
    let new = || wanted.then(|| Neighbourhoods::on_trained(band, &at, trained, options, context)).flatten();
    let mut reduced = reduced.or_else(new);
    let found = match reduced.as_mut().filter(|_| options.selection == Selection::Joint) {
        Some(reduced) => corrected::correct((band, &[]), &at, found, reduced, options, context),
        None => found,
    };
    Neighbourhoods::hand_back(reduced, trained);
    Ok(found.judged_by_fit())
}

fn identify_at_all(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: Option<&mut Neighbourhoods<'_, '_>>,
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    match options.selection {
        Selection::Joint => joint::identify(band, at, reduced, &[], options, context),
        Selection::Smallest => per_frequency::identify(band, at, reduced, options, context),
    }
}
