//! Errors of the model, estimated with the factor (B-11).
//!
//! A model's natural frequencies are some tenths of a per cent off, its mode shapes and the factors of its known parts some per cent. A factor that is
//! fitted to each frequency alone absorbs all of these errors. A band separates the two: each mode has one real error over its whole resonance,
//! a material has one smooth complex modulus. With a smooth ln E(ω; θ) (a law, or a spline), relative errors δ_i = e + d_i of natural frequencies, a_mi of mode shapes at
//! the sensors, g_m of calibrations, ν_t of known factors (and Δη_t of their loss factors),
//! $$ \sum_{k,m} \frac{|u_m - x_m(\omega_k; \theta, \delta, a, \nu)|^2}{\sigma_m^2} + \frac{e^2 + \sum_i d_i^2}{s^2} + \frac{\sum a_{mi}^2}{s_a^2} + \frac{\sum g_m^2}{s_g^2} + \frac{\sum \nu_t^2}{s_\nu^2} $$
//! is made least on the reduced model, with the noise approached from above; s, s_a and s_g are those of largest evidence. Whether there are errors at all is decided by
//! the evidence of three explanations: a smooth modulus and a right model, a modulus that scatters from line to line and a right model, a smooth modulus and errors.
//! It is a right model only where it is better by some nats. Of several unknowns each is a constant, a law or a spline.
//!
//! The errors of a mesh grow with ω_i, those of a support fall with 1/ω_i²: e is a sum of such parts, and so is what loss factors have in common. A rigid body has no stiffness that could be in error; its δ is that of a
//! support that the model does not have. An error that all loss factors have in common is one of the unknown, Re p + i(1 + ε) Im p.
//!
//! # Source
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425–464 (errors of a model beside its parameters); D. J. C. MacKay, Neural Comput. 4 (1992) 415–447
//! (evidence, and the number of well-determined parameters).

mod causality;
mod curve;
mod estimated;
mod factor_prior;
mod fitting;
mod found;
mod kinds;
mod leverage;
mod local_stiffness;
mod mesh;
mod mesh_scatter;
mod modal_loss;
mod paired;
mod scatter;
mod sizes;
mod small_errors;
mod split;
mod tuned;

use super::goodness_of_fit::{GoodnessOfFit, MIN_DOUBTFUL_MISFIT};
use super::local_fit::of_responses;
use super::noise::beside;
use super::options::ErrorSizes;
use super::outcome::Line;
use super::thinned::thinned;
use crate::c64;
use crate::for_each::ForEach;
use crate::frfs::Noise;
use crate::median::median;
use crate::subspace::{ModalErrors, Modes, Point, Projection};
pub(super) use curve::{Curve, Curves, Spline};
pub(super) use estimated::{Estimated, covariance};
pub(super) use fitting::PointAt;
pub use found::{
    Assumption, CalibrationError, ContradictedAssumption, FactorError, Leverage, LeverageOf, ModeError,
    ModelErrorsFound, SensorMass,
};
pub(super) use mesh::Coarser;
pub use mesh::MeshError;
pub(super) use split::Split;
use std::f64::consts::TAU;

use factor_prior::{FactorPrior, priors};
use fitting::{Fitting, Linearised, Minimum, Place};
use frfit_linalg::dense::Cholesky;
use kinds::{Damping, Kinds};
use local_stiffness::add_local_compliance;
use mesh::BetweenMeshes;
use modal_loss::add_modal_loss;
use sizes::{
    CALIBRATION_PRIOR_STD, FREQUENCY_PRIOR_STD, KnownSizes, MODAL_LOSS_FACTOR_PRIOR_STD,
    SENSOR_MASS_PRIOR_STD, SHAPE_PRIOR_STD, Sizes, UNDAMPED_SHARE_RATIO,
};
use small_errors::{About, SmallErrors};

/// What is known of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoiseScale {
    /// σ is that of the noise.
    Known,
    /// σ is what the noise is in proportion to.
    Relative,
}

impl NoiseScale {
    pub(super) fn of(noise: Noise<'_>) -> Self {
        if matches!(noise, Noise::Known(_)) { Self::Known } else { Self::Relative }
    }
}

/// What was measured, and where to begin.
pub(super) struct Measured<'t, 'a> {
    pub(super) point: PointAt<'t, 'a>,
    pub(super) omegas: &'t [f64],
    /// `[frequency][unknown]`.
    pub(super) nominal: &'t [Vec<c64>],
    /// θ of what holds for the band: as a right model has it, then where else to begin.
    pub(super) given: &'t [Vec<f64>],
    pub(super) measured: &'t [Vec<c64>],
    /// Of real and imaginary part each, `[frequency][sensor]`; infinite of a sensor that is left out.
    pub(super) sigma: &'t [Vec<f64>],
    /// The responses themselves, as standard deviations.
    pub(super) size: &'t [Vec<f64>],
    /// The levels of the responses, of which a rest beside the noise is a part.
    pub(super) levels: &'t [Vec<f64>],
    pub(super) noise_scale: NoiseScale,
    /// What the user says of the sizes of errors.
    pub(super) given_sizes: ErrorSizes,
    /// A coarser mesh, which says what the mesh has of them.
    pub(super) coarser: Option<Coarser<'t>>,
    /// The value of each frequency alone, and the noise over σ that follows from it.
    pub(super) free: &'t [Line],
    /// The unknowns that have a value of their own at each frequency.
    pub(super) own: &'t [usize],
    pub(super) level_per_frequency: Option<f64>,
    /// What the values of the lines say of the band.
    pub(super) fit: Option<GoodnessOfFit>,
    /// Whether the model may have errors at all.
    pub(super) may_be_wrong: bool,
    /// Whether the curves are the answer, of a right model too.
    pub(super) wants_curves: bool,
}

/// Modes up to this many times the highest frequency, and so many at most.
const MODES_ABOVE_BAND: f64 = 4.0;
const MAX_MODES: usize = 30;

/// Noise that is added to begin with, relative to the response.
const ADDED_NOISE: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// Stages in which a band is gone through upwards, noise that is added at each, and steps.
const MAX_STAGES: usize = 8;
const ADDED_STAGE_NOISE: [f64; 2] = [1.0, 0.2];
const STAGE_STEPS: usize = 3;

/// The first level of added noise where coordinates were tried one by one: more would let go what was found.
const TUNED_LEVELS: usize = 2;

/// Noise over response that is usual, where the responses themselves do not show it.
const USUAL_NOISE: f64 = 0.01;

/// The residual is noise up to this multiple of the noise that the responses alone show.
const MAX_NOISE_RATIO: f64 = 1.1;

/// Steps at each level of the noise, and at the last.
const STEPS_PER_LEVEL: usize = 5;
const STEPS_AT_LAST_LEVEL: usize = 5;

/// Rounds at most in which sizes and errors are estimated in turn. They end earlier where −2 ln of the evidence changes by less than this from one to the next.
const MAX_SIZE_ROUNDS: usize = 8;
const EVIDENCE_TOL: f64 = 0.2;

/// By how much bends of a smooth curve may be less or more than the usual ones.
const BEND_RANGE: [f64; 2] = [0.01, 3.0];

/// A size is estimated from the data from this many modes on.
const PRIOR_MODES: f64 = 0.05;

/// The same of what all modes have in common.
const PRIOR_COMMON: f64 = 0.5;

/// The same of calibrations, that of the force and as a rule few sensors, and of masses at these.
const PRIOR_CALIBRATIONS: f64 = 1.0;

/// No measured response is better than this part of itself: what is smaller is no reason to doubt a model.
const MIN_NOISE_OVER_RESPONSE: f64 = 5e-4;

/// What roundoff leaves of a response at most: no error of a model is as small.
const MAX_ROUNDOFF_OVER_RESPONSE: f64 = 1e-5;

/// Beside a given noise and the errors of modes, shapes and factors a response may be off by this part of itself: no model is
/// better between resonances. What is more is not explained.
const MAX_REST: f64 = 0.05;

/// The same of a single sensor, whose noise is not given: it cannot contradict itself.
const MIN_NOISE_OF_ONE_SENSOR: f64 = 5e-3;

/// Steps along the scale of an unknown, in its logarithm, and by how much −2 ln of the evidence falls with a step that is taken.
const STEP_ALONG_SCALE: f64 = 0.15;
const MIN_GAIN_ALONG_SCALE: f64 = 1.0;

/// A fit at a level of the noise.
struct Explained {
    found: Minimum,
    sizes: Sizes,
    kinds: Kinds,
    level: f64,
    /// What the response has beside noise and errors, relative to itself.
    rest: f64,
    /// −2 ln of the evidence, up to what all explanations share.
    evidence: f64,
}

/// A fit from a place.
type Fit<'f> = &'f dyn Fn(&Fitting<'_, '_>, Place) -> Option<Explained>;

/// What explains a band.
pub(super) enum Explanation {
    /// A right model does as well as one with errors.
    RightModel,
    /// One with small errors.
    Errors(Box<Estimated>),
    /// One whose errors are no small ones: it is another model.
    OtherModel,
}

/// The errors of a model by the data of a band, and how far those of known factors would move the unknowns.
pub(super) fn estimate(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    for_each: ForEach<'_>,
) -> (Explanation, Vec<Leverage>) {
    let nothing = || (Explanation::RightModel, Vec::new());
    let starts = data.starts(curves);
    let Some(start) = starts.first() else { return nothing() };
    let centre = curves.straight(start);
    let Some(search) = Search::new(model, data, (curves, &centre), start, for_each) else { return nothing() };
    let search = search.with_meshes(start);
    let explanation = explanation(&search, &starts).unwrap_or(Explanation::RightModel);
    (explanation, search.leverage(start))
}

/// What explains a band; `None` where nothing can be compared.
fn explanation(search: &Search<'_, '_>, starts: &[Vec<f64>]) -> Option<Explanation> {
    let Search { model, data, curves, .. } = *search;
    // Far from the answer a rough model is as good.
    let points: Vec<Point<'_>> = starts.iter().flat_map(|start| search.points(start)).collect();
    let rough = search.smaller(&points, ROUGH_NEIGHBOURHOOD_TOL);
    let given = search.given_factors();
    let start = starts[0].iter().copied().chain(given.iter().map(|_| 0.0)).collect();
    let right = search.right(&rough.0, &given, start)?;
    // What is said of known factors is in the error bars of a right model too.
    let right_model = || -> Option<Explanation> {
        let near = search.smaller(&search.points(&right.found.place), NEIGHBOURHOOD_TOL);
        let right = search.right(&near.0, &given, right.found.place.clone())?;
        let none = Modes::none(&near.0);
        let fitting = Fitting { factors: &given, ..search.fitting(&near.0, &none, &search.lines) };
        let estimated = data.posterior(&fitting, right, 0.0)?;
        let modes = Modes::none(model);
        Some(Explanation::Errors(Box::new(Estimated { modes, ..estimated })))
    };
    let right_model = || if given.is_empty() && !data.wants_curves { None } else { right_model() };
    let whole = search.fitting(&rough.0, &rough.1, &search.lines);
    let sized = data.given_sizes.any() || search.mesh.is_some();
    if !data.may_be_wrong || (!sized && data.is_exact()) {
        return right_model();
    }
    let is_noise = || data.is_noise(&right, data.numbers(&search.lines), curves);
    let about = || About::new(data, &whole, &right, &given);
    let small = if sized { None } else { Some(SmallErrors::new(&about()?)?) };
    let contradicted = small.map(|small| small.small_nats).filter(|nats| *nats > CONTRADICTED_NATS);
    let is_right = small.is_some_and(|small| small.usual_nats <= -RIGHT_MODEL_NATS);
    if is_right && contradicted.is_none() && is_noise() {
        return right_model();
    }
    let coarse = Fitting { free_nodes: false, ..search.fitting(&rough.0, &rough.1, &search.some) };
    let from = |place: Place, kinds: Kinds, from_above: &[f64]| {
        search.near(place, kinds, &|fitting, place| data.explain(fitting, place, from_above))
    };
    let fitted = |places: Vec<Place>, kinds: Kinds| -> Option<Explained> {
        let coarse = Fitting { kinds, ..coarse };
        let ends = places.into_iter().filter_map(|place| data.approach(&coarse, place));
        let (_, place) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        from(place, kinds, &ADDED_NOISE[FIRST_LEVELS..])
    };
    let better = |a: Explained, b: Option<Explained>| match b {
        Some(b) if b.evidence < a.evidence => b,
        _ => a,
    };
    let usual_noise = data.usual_noise();
    let is_explained = |wrong: &Explained| data.is_explained(wrong, &search.lines, usual_noise);
    // Large errors may explain a band as well: those of modes at each other's places.
    let is_found =
        |wrong: &Explained| is_explained(wrong) && whole.are_small(&wrong.found.place, data.given_sizes);
    // Far from the answer damping that is free only hides that a mode is at another frequency, and masses may.
    let at_starts = || starts.iter().map(|start| coarse.start(start)).collect::<Vec<Place>>();
    let mut wrong = fitted(at_starts(), Kinds::STIFFNESS)?;
    let used = |line: usize, sensor: usize| data.sigma[line][sensor].is_finite();
    if !is_found(&wrong) {
        let paired = search.paired(&whole, &curves.straight(&starts[0]), &used);
        let settled: Fit<'_> = &|fitting, place| data.settled_near(fitting, place);
        wrong = better(wrong, paired.and_then(|place| search.near(place, Kinds::STIFFNESS, settled)));
    }
    if !is_found(&wrong) {
        wrong = better(wrong, fitted(at_starts(), Kinds::MASSES));
    }
    if !is_found(&wrong) {
        let stiffness = Fitting { kinds: Kinds::STIFFNESS, free_nodes: false, ..whole };
        let upwards = starts.iter().filter_map(|start| data.upwards(&stiffness, start)).collect();
        wrong = better(wrong, fitted(upwards, Kinds::STIFFNESS));
    }
    let mut scaled: Vec<(f64, Place)> = if is_found(&wrong) {
        Vec::new()
    } else {
        starts.iter().filter_map(|start| whole.scaled(whole.start(&curves.straight(start)), &used)).collect()
    };
    scaled.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = scaled.first().map_or(0.0, |(least, _)| MAX_MISMATCH_OVER_LEAST * least);
    scaled.dedup_by(|a, b| distance(&a.1, &b.1) <= SAME_START);
    for (_, mut place) in scaled.into_iter().filter(|(mismatch, _)| *mismatch <= most) {
        while !is_found(&wrong) {
            let tuned = from(whole.tuned(place, &used)?, Kinds::STIFFNESS, &ADDED_NOISE[TUNED_LEVELS..])?;
            if tuned.evidence > wrong.evidence - 2.0 * RIGHT_MODEL_NATS {
                break;
            }
            place = tuned.found.place.clone();
            wrong = tuned;
        }
    }
    // Errors that the data do not determine stay in the bars: masses and common damping are left out only where they are clearly worse.
    // Damping of single modes can stand in for a loss factor that varies with frequency, so it has to explain the band better.
    type With = fn(Kinds) -> Kinds;
    let further: [(With, f64); 3] = [
        (Kinds::with_masses, RIGHT_MODEL_NATS),
        (Kinds::with_common_damping, RIGHT_MODEL_NATS),
        (Kinds::with_own_damping, 0.0),
    ];
    let near = search.smaller(&search.points(&wrong.found.place), NEIGHBOURHOOD_TOL);
    let fine = search.fitting(&near.0, &near.1, &search.lines);
    // Whether there are errors is asked of the kinds that explain the band best.
    let mut best = wrong.evidence;
    for (with, nats) in further {
        let kinds = with(wrong.kinds);
        if kinds != wrong.kinds {
            let (place, fitting) = (wrong.found.place.clone(), Fitting { kinds, ..fine });
            // A minimum that explains the band is near. From any other one added noise leads away.
            let more = if is_explained(&wrong) {
                let sizes = wrong.sizes.with_kinds(kinds, fine.known);
                fitting.linearised(place).and_then(|at| data.settled(&fitting, at, sizes, wrong.level))
            } else {
                data.explain(&fitting, place, &ADDED_NOISE[LAST_LEVELS..])
            };
            best = more.as_ref().map_or(best, |more| best.min(more.evidence));
            wrong = more.filter(|more| more.evidence < wrong.evidence + 2.0 * nats).unwrap_or(wrong);
        }
    }
    // Where nothing explains the band, elsewhere in the valley is no better place.
    let (near, wrong) = if is_explained(&wrong) { search.along_scales(near, wrong) } else { (near, wrong) };
    best = best.min(wrong.evidence);
    let fine = Fitting { kinds: wrong.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
    // The search assumes least sizes of errors. Smaller ones may explain the band better.
    let best = contradicted.map_or(best, |nats| best.min(right.evidence - 2.0 * nats));
    let scattered = data.scattered(search, &right, wrong.level);
    // A modulus that scatters follows whatever errors do to single lines.
    let instead_of_errors = if best < right.evidence { 2.0 * SCATTER_NATS } else { 0.0 };
    let least =
        scattered.map_or(right.evidence, |scattered| right.evidence.min(scattered + instead_of_errors));
    let evidence = 0.5 * (least - best);
    if !sized && evidence <= -RIGHT_MODEL_NATS {
        // No material scatters from line to line. Where only that explains the band, and not all of it, it is another model.
        let scatters = least < right.evidence - 2.0 * RIGHT_MODEL_NATS;
        let rest = data.fit.is_none_or(|fit| fit.is_nearly_explained());
        return if scatters && rest { Some(Explanation::OtherModel) } else { right_model() };
    }
    if !fine.are_small(&wrong.found.place, data.given_sizes) {
        return Some(Explanation::OtherModel);
    }
    let estimated = data.posterior(&fine, wrong, evidence)?;
    Some(Explanation::Errors(Box::new(Estimated { modes: search.modes.clone(), ..estimated })))
}

/// A right model whose covariance holds what errors too small to be seen may do.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AveragedModel {
    pub(super) estimated: Estimated,
    /// What small errors add to the covariance of the unknowns' θ, row after row.
    beside_noise: Vec<f64>,
}

impl AveragedModel {
    fn new(estimated: Estimated, of_noise: &[f64]) -> Self {
        let noise = of_noise.chunks_exact(estimated.theta().len().max(1));
        let rows = estimated.of_theta().into_iter().zip(noise);
        let beside_noise =
            rows.flat_map(|(own, noise)| own.into_iter().zip(noise).map(|(a, b)| a - b)).collect();
        Self { estimated, beside_noise }
    }

    /// What small errors add to the covariance of the unknowns' θ, row after row.
    pub(super) fn beside_noise(&self) -> &[f64] {
        &self.beside_noise
    }

    /// What they add to the variances of the real and the imaginary part of an unknown at a line, and to their covariance.
    pub(super) fn beside_noise_at(&self, unknown: usize, line: usize, frequency_hz: f64) -> Option<[f64; 3]> {
        let slopes = self.estimated.slopes(unknown, line, frequency_hz)?;
        Some(covariance(&self.beside_noise, &slopes))
    }
}

/// A right model at θ, averaged over errors too small to be seen. `None` where the case says how large errors are, or a coarser mesh does, and where
/// several sensors agree to roundoff.
pub(super) fn averaged_over_small_errors(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    theta: &[f64],
    for_each: ForEach<'_>,
) -> Option<AveragedModel> {
    let is_known = data.given_sizes.any() || data.coarser.is_some() || !data.may_be_wrong || data.is_exact();
    let search = if is_known { None } else { Search::new(model, data, (curves, theta), theta, for_each) }?;
    if search.factors.iter().any(|factor| factor.is_given) {
        return None;
    }
    let (near, modes) = search.smaller(&search.points(theta), NEIGHBOURHOOD_TOL);
    let none = Modes::none(&near);
    let fitting = Fitting { factors: &[], ..search.fitting(&near, &none, &search.lines) };
    let right = data.settled_near(&fitting, fitting.start(theta))?;
    let whole = search.fitting(&near, &modes, &search.lines);
    let about = About::new(data, &whole, &right, &[])?;
    let (moments, of_noise, place) = (about.second_moments()?, about.of_none()?, about.place);
    let at = Explained { found: Minimum { place, ..right.found }, ..right };
    let estimated = Estimated { modes: search.modes.clone(), ..data.estimated(&whole, at, &moments) };
    Some(AveragedModel::new(estimated, &of_noise))
}

/// The errors of a model by the data of a band whose unknown follows a law, where a right model explains the band with a smooth modulus (`smooth`) and not with
/// the law at θ (`curves`). `None` unless they and the law are likelier than that smooth modulus.
pub(super) fn estimate_beside_a_smooth_modulus(
    model: &Projection,
    data: &Measured<'_, '_>,
    (smooth, curves): (&Curves, &Curves),
    theta: &[f64],
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let of_smooth = evidence_of_right_model(model, data, smooth, &data.starts(smooth), for_each)?;
    // A law does not scatter from line to line.
    let given = [theta.to_vec()];
    let data = &Measured { given: &given, own: &[], ..*data };
    let of_law = evidence_of_right_model(model, data, curves, &given, for_each)?;
    match estimate(model, data, curves, for_each).0 {
        Explanation::Errors(errors) if 2.0 * errors.evidence > of_law - of_smooth => Some(*errors),
        _ => None,
    }
}

/// −2 ln of the evidence of a right model.
fn evidence_of_right_model(
    model: &Projection,
    data: &Measured<'_, '_>,
    curves: &Curves,
    starts: &[Vec<f64>],
    for_each: ForEach<'_>,
) -> Option<f64> {
    let start = starts.first()?;
    let centre = curves.straight(start);
    let search = Search::new(model, data, (curves, &centre), start, for_each)?;
    let (near, _) = search.smaller(&search.points(start), ROUGH_NEIGHBOURHOOD_TOL);
    let given = search.given_factors();
    let place = start.iter().copied().chain(given.iter().map(|_| 0.0)).collect();
    Some(search.right(&near, &given, place)?.evidence)
}

/// The errors of a model once more, with laws in place of smooth curves: they say more of what the errors are. Of several places to begin with
/// that of largest evidence; `None` where these errors are no small ones.
pub(super) fn estimate_with_laws(
    model: &Projection,
    data: &Measured<'_, '_>,
    before: &Estimated,
    curves: &Curves,
    starts: &[Vec<f64>],
    for_each: ForEach<'_>,
) -> Option<Estimated> {
    let each = starts.iter().filter_map(|theta| {
        let search = Search {
            modes: before.modes.in_larger(model),
            factors: before.factors.clone(),
            mesh: before.mesh.clone(),
            ..Search::new(model, data, (curves, theta), theta, for_each)?
        };
        let near = search.smaller(&search.points(theta), NEIGHBOURHOOD_TOL);
        let fitting = Fitting { kinds: before.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
        let place: Place = theta.iter().chain(&before.place[before.curves.count()..]).copied().collect();
        let found = data.explain(&fitting, place, &ADDED_NOISE[FIRST_LEVELS..])?;
        Some((search, near, found))
    });
    let (search, near, found) = each.min_by(|a, b| a.2.evidence.total_cmp(&b.2.evidence))?;
    let (near, found) = search.along_scales(near, found);
    let fitting = Fitting { kinds: before.kinds, ..search.fitting(&near.0, &near.1, &search.lines) };
    if !fitting.are_small(&found.found.place, data.given_sizes) {
        return None;
    }
    let estimated = data.posterior(&fitting, found, before.evidence)?;
    Some(Estimated { modes: search.modes.clone(), ..estimated })
}

/// What all fits of a band have in common.
struct Search<'t, 'a> {
    model: &'t Projection,
    data: &'t Measured<'t, 'a>,
    curves: &'t Curves,
    centre: &'t [f64],
    for_each: ForEach<'t>,
    /// Lines that are used, some of them, and those about which a smaller model is made.
    lines: Vec<usize>,
    some: Vec<usize>,
    about: Vec<usize>,
    /// Of the whole reduced model.
    modes: Modes,
    /// The values of the unknowns with which they are.
    values_of_modes: Vec<c64>,
    /// Known factors that may be in error.
    factors: Vec<FactorPrior>,
    /// Unknown stiffnesses with damping, whose loss factors may have an error in common, and the terms of each.
    damped: Vec<(usize, Vec<usize>)>,
    /// What lies between the meshes, where there are two.
    mesh: Option<BetweenMeshes>,
}

impl<'t, 'a> Search<'t, 'a> {
    /// With the modes that the model has in the middle of the band.
    fn new(
        model: &'t Projection,
        data: &'t Measured<'t, 'a>,
        (curves, centre): (&'t Curves, &'t [f64]),
        theta: &[f64],
        for_each: ForEach<'t>,
    ) -> Option<Self> {
        let all: Vec<usize> = (0..data.omegas.len()).filter(|&i| data.omegas[i] > 0.0).collect();
        let of = |most: usize| -> Vec<usize> { thinned(&all, most).copied().collect() };
        let lines = of(MAX_LINES);
        let (values_of_modes, _) = curves.values(theta, middle(&lines), data.omegas[middle(&lines)])?;
        let Point { at, correction } = data.on(curves, theta, middle(&lines))?;
        let highest = *data.omegas.last()?;
        let modes = model.modes(&at, correction, MODES_ABOVE_BAND * highest, MAX_MODES).ok()?;
        let is_damped = |&j: &usize| values_of_modes[j].im != 0.0 && at.is_stiffness(j);
        let with_terms = |j: usize| (j, at.terms_of(j).map(|(term, _)| term).collect());
        Some(Self {
            damped: (0..values_of_modes.len()).filter(is_damped).map(with_terms).collect(),
            model,
            data,
            curves,
            centre,
            for_each,
            lines,
            some: of(FIRST_LINES),
            about: of(NEIGHBOURHOOD_POINTS),
            factors: priors(&at, data.given_sizes, modes.share_of_unknowns(highest)),
            modes,
            values_of_modes,
            mesh: None,
        })
    }

    /// The known factors whose accuracy is given.
    fn given_factors(&self) -> Vec<FactorPrior> {
        self.factors.iter().filter(|factor| factor.is_given).copied().collect()
    }

    /// The fit of a model without errors, but for those of factors whose accuracy is given.
    fn right(&self, model: &Projection, given: &[FactorPrior], start: Place) -> Option<Explained> {
        let none = Modes::none(model);
        let fitting = Fitting { factors: given, ..self.fitting(model, &none, &self.lines) };
        self.data.explain(&fitting, start, &ADDED_NOISE[2..])
    }

    /// With what lies between this mesh and a coarser one, where there is one. The stiffness of an unknown then has no error of a usual size: the meshes
    /// say how large it is.
    fn with_meshes(mut self, theta: &[f64]) -> Self {
        let between = |coarser: Coarser<'t>| {
            let on = |&line: &usize| -> Option<Point<'t>> {
                let omega = self.data.omegas[line];
                coarser.point(omega / TAU, &self.curves.values(theta, line, omega)?.0)
            };
            let points: Vec<Point<'t>> = self.about.iter().filter_map(on).collect();
            let middle = on(&middle(&self.lines))?;
            let modes = (&self.modes, *self.data.omegas.last()?);
            BetweenMeshes::new(coarser.mesh, &points, &middle, modes, self.for_each)
        };
        self.mesh = self.data.coarser.and_then(between);
        if self.mesh.is_some() {
            self.factors.retain(|factor| factor.is_known);
        }
        self
    }

    /// Points along some curves.
    fn points(&self, theta: &[f64]) -> Vec<Point<'a>> {
        self.about.iter().filter_map(|&i| self.data.on(self.curves, theta, i)).collect()
    }

    /// A smaller model of the modes and of what is near some points, with its modes; the same where it would be no smaller.
    fn smaller(&self, points: &[Point<'_>], tolerance: f64) -> (Projection, Modes) {
        let smaller = self.model.about_modes(&self.modes, points, tolerance);
        smaller.unwrap_or_else(|| (self.model.clone(), self.modes.clone()))
    }

    /// A fit on a model that is good near a place.
    fn near(&self, place: Place, kinds: Kinds, fit: Fit<'_>) -> Option<Explained> {
        let (model, modes) = self.smaller(&self.points(&place), NEIGHBOURHOOD_TOL);
        fit(&Fitting { kinds, ..self.fitting(&model, &modes, &self.lines) }, place)
    }

    /// The best place along the scale of each smooth unknown. Errors of modes and other unknowns can stand in for that scale: the minimum is a long valley, in which a
    /// search ends where it comes down, with errors that suit there. Elsewhere in the valley the errors are searched anew while the unknowns are held, and then all
    /// together. With a model that is good near the place: the same where that is the same.
    fn along_scales(
        &self,
        near: (Projection, Modes),
        mut best: Explained,
    ) -> ((Projection, Modes), Explained) {
        let (data, mut has_moved) = (self.data, false);
        let whole = Fitting { kinds: best.kinds, ..self.fitting(self.model, &self.modes, &self.lines) };
        let from = |best: &Explained, unknown: usize, by: f64| -> Option<Explained> {
            let place = whole.with_scale(&best.found, (unknown, by))?;
            let centre = place[..self.curves.count()].to_vec();
            let searched: Fit<'_> = &|fitting, place| {
                let held = Fitting { held: true, centre: &centre, ..*fitting };
                let errors = data.explain(&held, place, &ADDED_NOISE[FIRST_LEVELS..])?;
                data.settled(fitting, fitting.linearised(errors.found.place)?, errors.sizes, errors.level)
            };
            // Far along it the errors are those of another model, which has to explain the band clearly better.
            let are_small = |one: &Explained| whole.are_small(&one.found.place, data.given_sizes);
            let gain = if are_small(best) { MIN_GAIN_ALONG_SCALE } else { -2.0 * RIGHT_MODEL_NATS };
            let is_better = |other: &Explained| other.evidence < best.evidence - gain;
            self.near(place, best.kinds, searched).filter(|other| is_better(other) && are_small(other))
        };
        for unknown in self.curves.smooth() {
            for by in [STEP_ALONG_SCALE, -STEP_ALONG_SCALE] {
                while let Some(other) = from(&best, unknown, by) {
                    (best, has_moved) = (other, true);
                }
            }
        }
        let near =
            if has_moved { self.smaller(&self.points(&best.found.place), NEIGHBOURHOOD_TOL) } else { near };
        (near, best)
    }

    fn fitting<'f>(&'f self, model: &'f Projection, modes: &'f Modes, lines: &'f [usize]) -> Fitting<'f, 'a> {
        Fitting {
            model,
            modes,
            point: self.data.point,
            omegas: self.data.omegas,
            measured: self.data.measured,
            lines,
            curves: self.curves,
            centre: self.centre,
            highest_rad_s: self.data.omegas[self.data.omegas.len() - 1],
            factors: &self.factors,
            damped: &self.damped,
            kinds: Kinds::ALL,
            mesh: self.mesh.as_ref().filter(|_| !modes.omega_rad_s.is_empty()),
            known: KnownSizes::new(self.data.given_sizes, self.mesh.as_ref(), self.curves.is_beside_others()),
            free_nodes: true,
            held: false,
            for_each: self.for_each,
        }
    }
}

/// The line at whose modulus the modes are those of the model.
fn middle(lines: &[usize]) -> usize {
    lines[lines.len() / 2]
}

/// Starts no farther apart than this, in logarithms, are one.
const SAME_START: f64 = 0.01;

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Lines on which the search begins, and at most.
const FIRST_LINES: usize = 60;
const MAX_LINES: usize = 240;

/// Levels of added noise until all lines are used, and until only errors of damping and masses are to be found.
const FIRST_LEVELS: usize = 4;
const LAST_LEVELS: usize = 5;

/// Halvings to what is beside noise and errors: to a ten-thousandth of the most.
const REST_HALVINGS: usize = 13;

/// Points of the band at which a model of the neighbourhood is made good, and to which error.
const NEIGHBOURHOOD_POINTS: usize = 24;
const NEIGHBOURHOOD_TOL: f64 = 1e-6;
const ROUGH_NEIGHBOURHOOD_TOL: f64 = 1e-4;

/// The residual is noise up to this number of standard deviations of χ².
const NOISE_CHI_SQUARED_STD: f64 = 3.0;

/// Whether noise leaves this χ² of n numbers.
fn is_chance(chi_squared: f64, n: f64) -> bool {
    chi_squared <= n + NOISE_CHI_SQUARED_STD * (2.0 * n).sqrt()
}

/// χ² of squares with standard deviations, `[line][sensor]`; a sensor that is left out has an infinite one.
fn chi_squared<'s>(squares: &[Vec<f64>], sigma: impl IntoIterator<Item = &'s Vec<f64>>) -> f64 {
    let sigma = sigma.into_iter().flatten();
    squares.iter().flatten().zip(sigma).map(|(square, sigma)| square / (sigma * sigma)).sum()
}

/// A right model is one only where it explains a band by so many nats better: before the data errors are a hundred times as likely as none, and where
/// the data cannot decide, they are in the bars.
const RIGHT_MODEL_NATS: f64 = 5.0;

/// No material scatters from line to line, and jumps and narrow peaks, which a smooth curve lacks, are rare: where errors of the model explain a band better than a
/// right model does, a modulus that scatters has to explain it better than they do by so many nats.
const SCATTER_NATS: f64 = 20.0;

/// A model is not right where errors of any size, however small, explain the band better by more nats than this. In 40 cases of right models the most was 1.8.
const CONTRADICTED_NATS: f64 = 2.5;

/// Starts with more mismatch over the least of all are far from the answer.
const MAX_MISMATCH_OVER_LEAST: f64 = 1.2;

impl<'a> Measured<'_, 'a> {
    /// The model at a line of some curves.
    fn on(&self, curves: &Curves, theta: &[f64], line: usize) -> Option<Point<'a>> {
        let (values, _) = curves.values(theta, line, self.omegas[line])?;
        (self.point)(line, &values)
    }

    /// Real numbers that were measured.
    fn numbers(&self, lines: &[usize]) -> usize {
        2 * lines.iter().flat_map(|&i| &self.sigma[i]).filter(|sigma| sigma.is_finite()).count()
    }

    /// The values of an unknown at the frequencies that have an answer of their own, with weights (inverse variances of ln p).
    fn answered(&self, unknown: usize) -> Vec<(usize, c64, f64)> {
        let one = |(i, line): (usize, &Line)| {
            let own = &line.values[unknown];
            let value = own.value.filter(|value| line.on_path && value.re > 0.0)?;
            let std = own.uncertainty.map_or(1.0, |bars| bars.correction_std / value.norm());
            Some((i, value, 1.0 / (std * std + 1e-4)))
        };
        self.free.iter().enumerate().filter_map(one).collect()
    }

    /// θ with these coordinates of constants, laws and channels, and smooth curves through the values of each frequency alone.
    pub(super) fn through_answers(&self, curves: &Curves, given: &[f64]) -> Option<Vec<f64>> {
        curves.through(given, |unknown| self.answered(unknown))
    }

    /// θ to begin with: through the values of each frequency alone, and the nominal.
    pub(super) fn starts(&self, curves: &Curves) -> Vec<Vec<f64>> {
        // Where modes are narrow most lines are right and some are far off.
        type Values = Vec<(usize, c64, f64)>;
        let usual: &dyn Fn(usize) -> Values = &|j| {
            let all = self.answered(j);
            let middle = |part: &dyn Fn(c64) -> f64| median(all.iter().map(|one| part(one.1.ln())).collect());
            let value = middle(&|log| log.re).zip(middle(&|log| log.im));
            let value = value.map(|(size, phase)| c64::new(size, phase).exp());
            value.map_or(Vec::new(), |value| all.iter().map(|one| (one.0, value, 1e4)).collect())
        };
        let nominal: &dyn Fn(usize) -> Values = &|j| {
            let positive = (0..self.omegas.len()).filter(|&i| self.nominal[i][j].re > 0.0);
            positive.map(|i| (i, self.nominal[i][j], 1e4)).collect()
        };
        let smooth = curves.smooth();
        let few = smooth.iter().any(|&j| self.answered(j).len() <= 2);
        let mut starts: Vec<Vec<f64>> = Vec::new();
        let mut add = |start: Option<Vec<f64>>| {
            let is_new = |start: &Vec<f64>| starts.iter().all(|other| distance(start, other) > SAME_START);
            let start = start.filter(is_new);
            starts.extend(start);
        };
        let Some((right, others)) = self.given.split_first() else { return starts };
        if !few {
            add(self.through_answers(curves, right));
            add(curves.through(right, usual));
        }
        add(curves.through(right, nominal));
        for given in others {
            add(curves.through(given, if few { nominal } else { usual }));
        }
        starts.iter_mut().for_each(|start| curves.keep_within_bounds(start));
        starts
    }

    /// σ of the noise at a level, with some part of the response added.
    fn sigma_at(&self, lines: &[usize], level: f64, added: f64) -> Vec<Vec<f64>> {
        let one = |&i: &usize| {
            let each = self.sigma[i].iter().zip(&self.size[i]);
            each.map(|(sigma, size)| (level * sigma).hypot(added.max(MIN_NOISE_OVER_RESPONSE) * size))
                .collect()
        };
        lines.iter().map(one).collect()
    }

    /// σ of the noise at a level, with what the response has beside it.
    fn sigma_beside(&self, lines: &[usize], level: f64, rest: f64) -> Vec<Vec<f64>> {
        let levels: Vec<Vec<f64>> = lines.iter().map(|&i| self.levels[i].clone()).collect();
        beside(&self.sigma_at(lines, level, 0.0), rest, &levels)
    }

    /// From a start to where all lines are used: the cost and the place.
    fn approach(&self, coarse: &Fitting<'_, '_>, place: Place) -> Option<(f64, Place)> {
        let precision = coarse.precision(&Sizes::prior(coarse.known));
        let own = if self.known() { 1.0 } else { 0.0 };
        let (mut at, mut end) = (coarse.linearised(place)?, None);
        for added in &ADDED_NOISE[..FIRST_LEVELS] {
            let sigma = self.sigma_at(coarse.lines, own, *added);
            let (found, near) = coarse.descend(at, &sigma, &precision, STEPS_PER_LEVEL)?;
            at = near;
            end = Some((found.normal.chi_squared + found.prior, found.place));
        }
        end
    }

    /// Whether the residual is noise: of the given size, or of the usual size.
    fn is_explained(&self, wrong: &Explained, lines: &[usize], usual_noise: f64) -> bool {
        let n = self.numbers(lines) as f64;
        match self.known() {
            true => wrong.rest == 0.0 && is_chance(wrong.found.normal.chi_squared, n),
            false => wrong.level <= usual_noise,
        }
    }

    /// The most that noise leaves where it is not given: a little more than the responses alone show.
    fn usual_noise(&self) -> f64 {
        let of_responses =
            if self.known() { None } else { of_responses((self.omegas, self.measured), self.sigma) };
        of_responses.map_or(USUAL_NOISE, |noise| (MAX_NOISE_RATIO * noise).max(MIN_DOUBTFUL_MISFIT))
    }

    /// From a start to where lines are used from the lowest on, mode after mode: where a mode is off by many half-widths it has no slope towards
    /// its place, and the modes below it say where that is.
    fn upwards(&self, whole: &Fitting<'_, '_>, start: &[f64]) -> Option<Place> {
        let precision = whole.precision(&Sizes::prior(whole.known));
        let own = if self.known() { 1.0 } else { 0.0 };
        let mut place = whole.start(start);
        for below in whole.stages(MAX_STAGES) {
            let lines: Vec<usize> = thinned(below, FIRST_LINES).copied().collect();
            let stage = Fitting { lines: &lines, ..*whole };
            let mut at = stage.linearised(place)?;
            for added in ADDED_STAGE_NOISE {
                let sigma = self.sigma_at(&lines, own, added);
                at = stage.descend(at, &sigma, &precision, STAGE_STEPS)?.1;
            }
            place = at.place;
        }
        Some(place)
    }

    fn known(&self) -> bool {
        self.noise_scale == NoiseScale::Known
    }

    /// Whether several sensors agree at each frequency to roundoff: the model is right then, whatever the modulus does.
    fn is_exact(&self) -> bool {
        let level = self.level_per_frequency.filter(|_| !self.known() && self.counted_sensors().count() > 1);
        level.is_some_and(|level| level <= MAX_ROUNDOFF_OVER_RESPONSE)
    }

    /// Sensors that are not left out.
    fn counted_sensors(&self) -> impl Iterator<Item = usize> {
        (0..self.sigma[0].len()).filter(|&m| self.sigma[0][m].is_finite())
    }

    /// Whether noise is all that a smooth modulus leaves.
    fn is_noise(&self, right: &Explained, numbers: usize, curves: &Curves) -> bool {
        let n = numbers as f64;
        match self.known() {
            true => is_chance(right.found.normal.chi_squared, n),
            false => {
                let contradicted = self.counted_sensors().count() > 1 || curves.smooth().is_empty();
                let least = if contradicted { MIN_NOISE_OVER_RESPONSE } else { MIN_NOISE_OF_ONE_SENSOR };
                let usual = self.level_per_frequency.map_or(0.0, |level_per_frequency| {
                    level_per_frequency * (1.0 + NOISE_CHI_SQUARED_STD / n.sqrt())
                });
                right.level <= least.max(usual)
            }
        }
    }

    /// The least squares with the noise approached from above, and the sizes of largest evidence.
    fn explain(&self, fitting: &Fitting<'_, '_>, place: Place, from_above: &[f64]) -> Option<Explained> {
        let known = self.known();
        let sizes = Sizes::prior(fitting.known).of_kinds(fitting.kinds, fitting.known);
        let numbers = self.numbers(fitting.lines) as f64;
        let (mut at, mut level) = (fitting.linearised(place)?, 1.0);
        for &added in from_above {
            let sigma = self.sigma_at(fitting.lines, if known { 1.0 } else { 0.0 }, added);
            let (found, near) = fitting.descend(at, &sigma, &fitting.precision(&sizes), STEPS_PER_LEVEL)?;
            at = near;
            if !known {
                level = added;
                // The noise itself is larger than what would come next.
                if found.normal.chi_squared > numbers {
                    break;
                }
            }
        }
        self.settled(fitting, at, sizes, level)
    }

    /// The same from a place that is near, with the noise that it leaves: more would let go what was found.
    fn settled_near(&self, fitting: &Fitting<'_, '_>, place: Place) -> Option<Explained> {
        let sizes = Sizes::prior(fitting.known).of_kinds(fitting.kinds, fitting.known);
        let sigma = fitting.lines.iter().map(|&line| &self.sigma[line]);
        let at = fitting.linearised(place)?;
        let left = chi_squared(&at.squares(), sigma) / self.numbers(fitting.lines) as f64;
        let level = if self.known() { 1.0 } else { left.sqrt().max(MIN_NOISE_OVER_RESPONSE) };
        self.settled(fitting, at, sizes, level)
    }

    /// The least squares near a place, with the noise and the sizes of largest evidence: those to begin with are nearly right.
    fn settled(
        &self,
        fitting: &Fitting<'_, '_>,
        mut at: Linearised,
        mut sizes: Sizes,
        mut level: f64,
    ) -> Option<Explained> {
        let known = self.known();
        let numbers = self.numbers(fitting.lines) as f64;
        let mut rest = 0.0;
        let mut last = None;
        for _ in 0..MAX_SIZE_ROUNDS {
            let sigma = self.sigma_beside(fitting.lines, level, rest);
            let precision = fitting.precision(&sizes);
            let found;
            (found, at) = fitting.descend(at, &sigma, &precision, STEPS_AT_LAST_LEVEL)?;
            let (n, place) = (fitting.count(), &at.place);
            let whole = found.normal.with_prior(&precision);
            let factor = Cholesky::new(n, &whole).ok()?;
            let inverse = factor.inverse();
            let variance = |i: usize| inverse[i * n + i];
            let logs: f64 = sigma.iter().flatten().filter(|s| s.is_finite()).map(|s| 4.0 * s.ln()).sum();
            let of_prior = Cholesky::new(n, &precision).ok()?.log_determinant();
            let evidence =
                logs + found.normal.chi_squared + found.prior + factor.log_determinant() - of_prior;
            let determined: f64 =
                (0..n).map(|i| 1.0 - precision[i * n + i] * variance(i)).map(|t| t.clamp(0.0, 1.0)).sum();
            let chi_squared = found.normal.chi_squared;
            let before = (level, sizes, rest);
            if known && !fitting.shapes().is_empty() {
                rest = self.rest(fitting.lines, &at.squares(), (numbers - determined).max(1.0));
            }
            let same = last
                .as_ref()
                .is_some_and(|last: &Explained| (last.evidence - evidence).abs() <= EVIDENCE_TOL);
            last = Some(Explained { found, sizes, kinds: fitting.kinds, level, rest: before.2, evidence });
            if same {
                break;
            }
            if !known {
                level = (level * (chi_squared / (numbers - determined).max(1.0)).sqrt())
                    .max(MIN_NOISE_OVER_RESPONSE);
            }
            for part in 0..2 {
                let (bends, count) = fitting.curves.bends(part);
                let m = fitting.curves.count();
                let sum = |of: &dyn Fn(usize, usize) -> f64| -> f64 {
                    (0..m * m).map(|k| bends[k] * of(k / m, k % m)).sum()
                };
                let squares = sum(&|i, j| place[i] * place[j]);
                let undetermined = sum(&|i, j| inverse[i * n + j]) / sizes.bend[part].powi(2);
                let determined = (count as f64 - undetermined).clamp(0.0, count as f64);
                let [least, most] = BEND_RANGE;
                sizes.bend[part] =
                    ((squares + PRIOR_MODES) / (determined + PRIOR_MODES)).sqrt().clamp(least, most);
            }
            if !fitting.shapes().is_empty() {
                // The size that some errors show; what was known of it counts as so many errors.
                let fresh = |of: Vec<usize>, size: f64, (prior, count): (f64, f64)| {
                    let squares: f64 = of.iter().map(|&i| (place[i] / fitting.growth(i)).powi(2)).sum();
                    let share = |i: usize| variance(i) / (size * fitting.growth(i)).powi(2);
                    let determined: f64 = of.iter().map(|&i| (1.0 - share(i)).clamp(0.0, 1.0)).sum();
                    ((squares + count * prior * prior) / (determined + count)).sqrt()
                };
                if self.given_sizes.frequency.is_none() {
                    let own = fitting.elastic(true).collect();
                    sizes.frequency = fresh(own, sizes.frequency, (FREQUENCY_PRIOR_STD, PRIOR_MODES));
                }
                if fitting.kinds.damping == Damping::Own {
                    let own = fitting.elastic(false).collect();
                    sizes.loss_factor =
                        fresh(own, sizes.loss_factor, (MODAL_LOSS_FACTOR_PRIOR_STD, PRIOR_MODES));
                }
                if self.given_sizes.shape.is_none() {
                    sizes.shape =
                        fresh(fitting.shapes().collect(), sizes.shape, (SHAPE_PRIOR_STD, PRIOR_MODES));
                }
                if self.given_sizes.calibration.is_none() {
                    let gains = fitting.gains().collect();
                    let prior = (CALIBRATION_PRIOR_STD, PRIOR_CALIBRATIONS);
                    sizes.calibration = fresh(gains, sizes.calibration, prior);
                }
                if fitting.kinds.masses {
                    // A light structure carries a large one: a narrow prior would make other errors and the unknown take a part of it.
                    let masses = fitting.masses().collect();
                    sizes.mass = fresh(masses, sizes.mass, (SENSOR_MASS_PRIOR_STD, PRIOR_CALIBRATIONS));
                }
                sizes = sizes.with_common(fitting.known);
                if self.given_sizes.frequency.is_none() {
                    // No frequency shows a common error, but its trend over the band does.
                    let common = fitting.in_common(true).collect();
                    let shown = fresh(common, before.1.common, (sizes.common, PRIOR_COMMON));
                    sizes.common = sizes.common.max(shown);
                    // A stiffness that shifts all natural frequencies may have no damping, or more than the structure.
                    sizes.common_loss = sizes.common_loss.max(UNDAMPED_SHARE_RATIO * shown);
                }
            }
            let settled = |a: f64, b: f64| (a - b).abs() <= 0.03 * b;
            if settled(level, before.0)
                && (rest - before.2).abs() <= 0.03 * rest
                && settled(sizes.frequency, before.1.frequency)
                && settled(sizes.loss_factor, before.1.loss_factor)
                && settled(sizes.shape, before.1.shape)
                && (0..2).all(|part| (sizes.bend[part] / before.1.bend[part] - 1.0).abs() < 0.2)
            {
                break;
            }
        }
        last
    }

    /// What the response has beside a given noise, relative to itself, so that χ² is what n numbers have: none where noise leaves as much.
    fn rest(&self, lines: &[usize], squares: &[Vec<f64>], n: f64) -> f64 {
        let chi_squared = |rest: f64| chi_squared(squares, &self.sigma_beside(lines, 1.0, rest));
        if is_chance(chi_squared(0.0), n) {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, MAX_REST);
        for _ in 0..REST_HALVINGS {
            let middle = 0.5 * (low + high);
            *(if chi_squared(middle) > n { &mut low } else { &mut high }) = middle;
        }
        high
    }

    fn posterior(&self, fitting: &Fitting<'_, '_>, wrong: Explained, evidence: f64) -> Option<Estimated> {
        let precision = fitting.precision(&wrong.sizes.with_dependent_shapes(fitting.sensors()));
        let sigma = self.sigma_beside(fitting.lines, wrong.level, wrong.rest);
        let at = fitting.linearised(wrong.found.place)?;
        let (found, _) = fitting.descend(at, &sigma, &precision, STEPS_AT_LAST_LEVEL)?;
        let whole = found.normal.with_prior(&precision);
        let inverse = Cholesky::new(fitting.count(), &whole).ok()?.inverse();
        let sizes = wrong.sizes;
        let estimated = self.estimated(fitting, Explained { found, ..wrong }, &inverse);
        let mut estimated = Estimated { evidence, ..estimated };
        if fitting.modes() > 0 {
            let (count, theta) = (estimated.count(), estimated.theta().to_vec());
            add_local_compliance(&mut estimated.covariance, count, fitting, &theta)?;
            let first_error = estimated.first_of_modes();
            add_modal_loss(&mut estimated.covariance, (count, first_error), fitting, &theta, sizes);
        }
        Some(estimated)
    }

    /// What is at a minimum, with the covariance of the search's coordinates there, n × n.
    fn estimated(&self, fitting: &Fitting<'_, '_>, at: Explained, covariance: &[f64]) -> Estimated {
        let Explained { found, sizes, level, rest, .. } = at;
        let n = fitting.count();
        let loss = fitting.of_unknown_loss();
        let errors = ModalErrors {
            loss: loss.map_or(0.0, |i| found.place[i]),
            of_loss: fitting.unknown_losses(&found.place),
            ..fitting.errors(&found.place)
        };
        let first = fitting.first_own();
        let modes = errors.stiffness.len();
        let theta = fitting.curves.count();
        // θ, e, ε of the loss factors of unknowns, then the errors of single modes and what follows them.
        let first_kept: Vec<usize> = (0..theta).chain(fitting.of_scale()).chain(loss).collect();
        let before_errors = first_kept.len();
        let kept = n - first + before_errors;
        let of = |a: usize, b: usize| covariance[a * n + b];
        // What of each of the search's coordinates is in θ, e, ε, δ_i, ν_t, a_mi.
        let parts = |a: usize| -> Vec<(usize, f64)> {
            let Some(error) = a.checked_sub(before_errors) else { return vec![(first_kept[a], 1.0)] };
            let own = std::iter::once((first + error, 1.0));
            let shared = (theta..first).filter(|_| error < modes);
            let of_mesh = fitting.of_mesh().filter(|_| error >= modes);
            let of_mesh = of_mesh.map(|(p, _)| (p, fitting.between_shapes(first + error)));
            own.chain(shared.map(|p| (p, fitting.common(error)[p - theta]))).chain(of_mesh).collect()
        };
        let parts: Vec<Vec<(usize, f64)>> = (0..kept).map(parts).collect();
        let entry = |a: usize, b: usize| {
            let row = |&(i, x): &(usize, f64)| parts[b].iter().map(|&(j, y)| x * y * of(i, j)).sum::<f64>();
            parts[a].iter().map(row).sum::<f64>()
        };
        let covariance = (0..kept * kept).map(|k| entry(k % kept, k / kept)).collect();
        Estimated {
            modes: fitting.modes.clone(),
            errors,
            covariance,
            sizes: if modes == 0 { [0.0; 3] } else { [sizes.frequency, sizes.loss_factor, sizes.shape] },
            chi_squared: found.normal.chi_squared,
            numbers: self.numbers(fitting.lines),
            level,
            rest,
            evidence: 0.0,
            kinds: fitting.kinds,
            highest_rad_s: fitting.highest_rad_s,
            curves: fitting.curves.clone(),
            factors: fitting.factors.to_vec(),
            mesh: fitting.mesh.cloned(),
            contradicted_assumptions: fitting.contradicted_assumptions(&found.place, self.given_sizes),
            bars_over_noise: None,
            mesh_error: fitting.of_mesh().map(|(p, mesh)| MeshError {
                paired: mesh.partner_rad_s.iter().flatten().count(),
                expected: mesh.remainder,
                remainder: found.place[p],
                std: of(p, p).max(0.0).sqrt(),
            }),
            place: found.place,
        }
    }
}
