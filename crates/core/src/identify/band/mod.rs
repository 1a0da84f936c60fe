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
mod laws;
mod matching;
mod noise;
mod on_reduced;
mod outlier_sensor;
mod path_model;
mod per_frequency;
mod reduced_band;
mod smooth;
mod verdict;

pub use calibration::{Calibrated, Calibration, ChannelUnknowns};
pub(super) use calibration::{Channel, ChannelNumber, identify_band_scaled, numbers_of};
pub(super) use initial_calibration::by_shape;
pub(crate) use initial_calibration::{MOST_PHASE, PHASE_STEP};
pub(super) use laws::{LawsOutcome, identify_laws};
pub use smooth::SmoothCurve;
pub(super) use smooth::{SmoothOutcome, identify_smooth};

use super::Status;
use super::model_errors::{Estimated, Leverage};
use super::{Line, Options, Reduction, Selection};
use crate::c64;
use crate::for_each::ForEach;
use crate::material::OutsideTable;
use crate::model::{DynamicStiffness, Experiment, ModelAt, Parameter};
use crate::response::Work;
use crate::subspace::Subspace;
use reduced_band::ReducedBand;

pub(super) use candidates::Fit;
pub(super) use fit::judge;
pub(super) use laws::{ROUNDS, UNEXPLAINED, nearest};
pub(super) use noise::{deviations, level_of};
pub(super) use outlier_sensor::without;
pub(super) use reduced_band::{BOX, TRAINED, is_certain, reduction_error, thinned, train};

pub use fit::{Explained, GoodnessOfFit, SensorFit};
pub use noise::{NoiseLevel, NoiseSource};

/// What was measured on what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Band<'a> {
    /// The model.
    pub model: &'a DynamicStiffness,
    /// Load and sensors.
    pub experiment: &'a Experiment,
    /// What is unknown.
    pub parameter: &'a Parameter,
    /// Frequencies, ascending.
    pub frequency_hz: &'a [f64],
    /// Receptance, `[frequency][sensor]`.
    pub measured: &'a [Vec<c64>],
    /// How well each was measured.
    pub noise: Noise<'a>,
}

/// Standard deviations √E|δx|² of measured receptances, `[frequency][sensor]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise<'a> {
    /// Not known: in proportion to the responses, by a factor that several sensors tell.
    Unknown,
    /// Known up to a common factor, as from a coherence without the number of averages.
    Relative(&'a [Vec<f64>]),
    /// Known.
    Known(&'a [Vec<f64>]),
}

/// What is going on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The subspace is trained.
    Subspace,
    /// Solutions are looked for.
    Solutions,
    /// One of them is chosen at each frequency.
    Selection,
    /// Laws, or a smooth curve, are fitted.
    Law,
}

/// What the caller lends: threads, and an ear for (stage, how many frequencies are done, of how many).
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Does independent pieces of work.
    pub for_each: ForEach<'a>,
    /// Called from any thread.
    pub progress: &'a (dyn Fn(Stage, usize, usize) + Sync),
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BandOutcome {
    /// One for each frequency.
    pub outcomes: Vec<Line>,
    /// Work of size N.
    pub work: Work,
    /// Vectors of the subspace; `None` where the full model answered.
    pub subspace_size: Option<usize>,
    /// Frequencies at which all solutions were looked for; at the others those of their neighbours were followed.
    pub explored: usize,
    /// How large the noise is, and what tells it. Nothing is known where each frequency is answered by itself.
    pub noise: NoiseLevel,
    /// Whether noise is all that the answers leave unexplained; `None` where nothing can tell.
    pub fit: Option<GoodnessOfFit>,
    /// One for each sensor; empty where each frequency is answered by itself.
    pub sensors: Vec<SensorFit>,
    /// Errors of the model that were taken out; `None` where none were found.
    pub model_errors: Option<Estimated>,
    /// How far errors of known factors move the unknown.
    pub leverage: Vec<Leverage>,
    /// Whether a model with large errors explains the band far better: it is another one.
    pub other_model: bool,
}

/// Identifies the first parameter at every frequency of a band.
///
/// With the subspace (B-3) every answer carries its reduction error; where it cannot be built, the full model answers. The joint selection (B-4, B-5) finds
/// every solution within the bounds at every sensor, fits it to all sensors, and chooses one path through all; the other one is
/// [`crate::identify::identify_at`] at each frequency. Answers are looked for within a factor of four of the nominal, and in the whole of the bounds where that
/// leaves most of the band without any.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
///
pub(super) fn identify_band<'a>(
    band: &Band<'a>,
    trained: &mut Option<Subspace<'a>>,
    options: &Options,
    hooks: Context<'_>,
) -> Result<BandOutcome, OutsideTable> {
    let at = band.model.at_all(band.frequency_hz, std::slice::from_ref(band.parameter))?;
    let boxes = near_and_far(options);
    let (found, space) = near_or_far(&boxes, |options| identify_at_all(band, &at, trained, options, hooks));
    // A model that is answered for as it is has no modes at hand: they are those of a reduced one.
    let wanted = options.selection == Selection::Joint && options.reduction == Reduction::Auto;
    let reduced = || wanted.then(|| reduced_band(band, &at, trained, &boxes[0], hooks)).flatten();
    let mut space = space.or_else(reduced);
    let found = match space.as_mut().filter(|_| options.selection == Selection::Joint) {
        Some(space) => corrected::correct(band, &at, found, space, &boxes[0], hooks),
        None => found,
    };
    hand_back(trained, space);
    Ok(found.judged_by_fit())
}

/// Options to look near the nominal, and in the whole of the bounds.
fn near_and_far(options: &Options) -> [Options; 2] {
    [*options, Options { whole_box: true, ..*options }]
}

/// The same for a joint selection on the subspace, whatever the options say.
fn on_subspace(options: &Options) -> [Options; 2] {
    near_and_far(&Options { reduction: Reduction::Subspace, selection: Selection::Joint, ..*options })
}

/// What is found near the nominal; where a path through that leaves out most of the band, the nominal is too far, and the bounds are all that is left:
/// the one with more answers then, with the work of both.
fn near_or_far<'o, T>(
    [near, far]: &'o [Options; 2],
    mut run: impl FnMut(&'o Options) -> (BandOutcome, T),
) -> (BandOutcome, T) {
    let mut found = run(near);
    let wider = near.selection == Selection::Joint && near.bounds.storage.is_some() && !near.whole_box;
    if wider && 2 * found.0.answered() < found.0.outcomes.len() {
        let mut other = run(far);
        if other.0.answered() > found.0.answered() {
            std::mem::swap(&mut found, &mut other);
        }
        found.0.work += other.0.work;
    }
    found
}

impl BandOutcome {
    /// How many frequencies have an answer.
    fn answered(&self) -> usize {
        self.outcomes.iter().filter(|outcome| outcome.on_path).count()
    }

    /// With statuses that the fit of the band allows.
    fn judged_by_fit(mut self) -> Self {
        self.fit = self.fit.map(|fit| fit.of_model(self.other_model));
        for outcome in &mut self.outcomes {
            outcome.status = match outcome.status {
                Status::Ok if self.other_model => Status::Unexplained,
                status => status.within(self.fit),
            };
        }
        self
    }

    /// The sensors that are left out.
    fn left_out(&self) -> Vec<usize> {
        (0..self.sensors.len()).filter(|&m| self.sensors[m].left_out).collect()
    }
}

fn identify_at_all<'a, 'o>(
    band: &Band<'a>,
    at: &'o [ModelAt<'a>],
    trained: &mut Option<Subspace<'a>>,
    options: &'o Options,
    hooks: Context<'_>,
) -> (BandOutcome, Option<ReducedBand<'a, 'o>>) {
    match options.selection {
        Selection::Joint => keeping_space(band, at, trained, options, hooks),
        Selection::Smallest => {
            let space = space(band, at, trained, options, hooks);
            (per_frequency::identify(band, at, space, options, hooks), None)
        }
    }
}

/// A joint selection, and the subspace that it was made on.
fn keeping_space<'a, 'o>(
    band: &Band<'a>,
    at: &'o [ModelAt<'a>],
    trained: &mut Option<Subspace<'a>>,
    options: &'o Options,
    hooks: Context<'_>,
) -> (BandOutcome, Option<ReducedBand<'a, 'o>>) {
    let mut space = space(band, at, trained, options, hooks);
    (joint::identify(band, at, space.as_mut(), &[], options, hooks), space)
}

fn space<'a, 'o>(
    band: &Band<'a>,
    at: &'o [ModelAt<'a>],
    trained: &mut Option<Subspace<'a>>,
    options: &'o Options,
    hooks: Context<'_>,
) -> Option<ReducedBand<'a, 'o>> {
    let wanted = options.reduction.is_subspace(options.method, band.model.dim(), at.len());
    // A singular stand-in for D is no reason to give up: the full model says at which frequency what breaks down.
    wanted.then(|| reduced_band(band, at, trained, options, hooks)).flatten()
}

/// The reduced model of a band on what was trained for it already, or else is now.
fn reduced_band<'a, 'o>(
    band: &Band<'a>,
    at: &'o [ModelAt<'a>],
    trained: &mut Option<Subspace<'a>>,
    options: &'o Options,
    hooks: Context<'_>,
) -> Option<ReducedBand<'a, 'o>> {
    let subspace = trained.take().map_or_else(|| train(band, at, options, hooks), Ok).ok()?;
    Some(ReducedBand::new(subspace, at, options))
}

/// Leaves what was trained to the next one.
fn hand_back<'a>(trained: &mut Option<Subspace<'a>>, space: Option<ReducedBand<'a, '_>>) {
    if let Some(space) = space {
        *trained = Some(space.into_subspace());
    }
}
