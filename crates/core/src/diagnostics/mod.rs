//! What is wrong with data against a model, in words that name what to change, before anything is identified.
//!
//! The unknowns are not known yet. So every way to read the data is judged after the likeliest values for it: the nominal ones times a number each, with a slope
//! over log ω, a damping and its slope that they have in common, within the bounds and a factor of four. One subspace for the whole box (B-3) answers for all values: of one
//! unknown its response at each of some forty frequencies is a sum over poles, x_m(c) = Σ_k ρ_mk/(1 + cλ_k); of several it is a sum over the modes at values near by,
//! which the natural frequencies of the measurement show whatever is wrong with its values.
//! What is compared are residuals ln(measured/model), magnitude and phase together, by the
//! likelihood of Student's distribution with a scale that is free (`misfit`), and by what BIC takes for each free number.
//!
//! Single changes are tried, and pairs of them where no single one explains the data. They are findings where their log-likelihood ratio to the data without them is
//! at least [`FINDING_NATS`], leaves a misfit that is smaller by [`MAX_MISFIT_RATIO`], and is larger than that of every other explanation by [`MIN_MARGIN_NATS`].
//! Otherwise the explanations are named between which the data do not decide. Three faults are not searched: data with three faults mean a wrong model.
//!
//! # Limits
//! Load and response that are swapped give the same FRF (reciprocity), and cannot be distinguished. A factor of all sensors and the modulus are one where nothing but stiffness
//! answers (a clamped structure below its first resonance), and then nothing is said. Damping that shows gives a conjugated FRF away; where it is less than the noise, nothing is said.
//! A dof is one of several where neighbours or mirror images answer alike: all of them are named. Faults that depend on frequency (a filter, a mounting resonance) are not searched.

mod by_modes;
mod data_hypothesis;
mod dof_mismatch;
mod explanation;
mod few;
mod finding;
mod many;
mod mesh;
mod misfit;
mod moduli;
mod responses;
mod row_pairs;
mod rows;
mod search;

pub use explanation::{FINDING_NATS, MAX_MISFIT_RATIO, MIN_MARGIN_NATS};
pub use finding::{
    Diagnosis, Evidence, Fault, Finding, KNOWN_FACTOR_RTOL, KnownFactor, NotJudged, OtherExplanation,
    OtherRow,
};

use crate::for_each::ForEach;
use crate::identify::{
    CommonNoise, Context, Noise, Options, Problem, ProblemError, ReducedBand, dead_channels, live_channels,
};
use crate::quantity::Quantity;
use crate::subspace::Subspace;
use few::{Measured, Model, Part};

/// How far to look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// At everything.
    Full,
    /// Before an identification, which says itself whether it explains the data: at other rows and axes only where much is left (a misfit of 0.3) or
    /// something else would be accused, and at nominal values that are ten times off only where something is accused that stiffness could do.
    Quick,
}

/// Looks for what is wrong with a band's data against its model; `quantities` says what each sensor's values were before they were made receptances.
///
/// Where the band is identified too, [`diagnose_on`] shares its reduced model.
///
/// Costs one real factorisation and some dozens of solves; two more for each of three searches for another row, for each other axis, and for nominal values ten times off to either side.
/// Of more than twenty sensors that many are looked at
/// together, all others are compared with the moduli that they have, and those that differ most are looked at one by one: the cost beyond that of
/// twenty sensors is one product with the basis at each frequency, and one residual a sensor and frequency.
///
/// # Errors
/// [`ProblemError`]: where there is not one quantity for each sensor, or an option does not belong to the problem.
///
/// # Limits
/// Several unknowns share one slope over frequency and one ratio of their losses.
pub fn diagnose(
    problem: &Problem<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    diagnose_by((None, Depth::Full), problem, quantities, options, for_each)
}

/// The same on a reduced model that is shared with [`identify_on`](crate::identify::identify_on), and trained now where it is not
/// yet: for all unknowns and sensors one, and no factorisation except in the search for another row or axis.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_on<'a>(
    reduced: &mut ReducedBand<'a>,
    depth: Depth,
    problem: &'a Problem<'a>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    let before = reduced.work();
    let context = Context { for_each, progress: &|_, _, _| {} };
    let trained = reduced.trained(problem, options, context)?;
    let mut found = diagnose_by((trained, depth), problem, quantities, options, for_each)?;
    found.work += reduced.work().since(before);
    Ok(found)
}

fn diagnose_by(
    (trained, depth): (Option<&Subspace<'_>>, Depth),
    problem: &Problem<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    let sensors = problem.experiment().sensors.len();
    if quantities.len() != sensors {
        let (what, expected) = ("quantities".to_owned(), format!("{sensors}, one for each sensor"));
        return Err(ProblemError::Count { what, expected, found: quantities.len() });
    }
    let receptance = problem.frfs().receptance;
    let dead = dead_channels(receptance);
    let live = live_channels(receptance);
    let std = match problem.frfs().noise {
        Noise::Known(std) | Noise::Common(CommonNoise { std, .. }) => Some(std),
        Noise::Relative(_) | Noise::Floor(_) | Noise::Unknown => None,
    };
    let all = Measured { experiment: problem.experiment(), receptance, quantities, std };
    let part = Part::of(all, &live);
    let measured = if dead.is_empty() { all } else { part.measured() };
    let model = Model { problem, trained, sensors: live.clone(), depth };
    let mut found = match live.len() > many::MAX_FITTED_SENSORS {
        true => many::diagnose(&model, measured, options, for_each)?,
        false => few::look(&model, measured, options, for_each, &|_| ())?.0,
    };
    found.of_sensors(|k| live[k]);
    let without_signal = |m: usize| Finding { fault: Fault::NoSignal, sensors: vec![m], evidence: None };
    found.findings.splice(0..0, dead.into_iter().map(without_signal));
    Ok(found)
}
