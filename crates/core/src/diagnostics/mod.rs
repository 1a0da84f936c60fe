//! What is wrong with data against a model, in words that name what to change, before anything is identified.
//!
//! The modulus is not known yet. So every way to read the data is judged after the likeliest modulus for it: the nominal times a number, with a slope over log ω
//! and a damping of its own (three numbers), within the bounds and a factor of four. One subspace for the whole box (B-3) answers for all moduli: at each of some forty
//! frequencies its response is a sum over poles, x_m(c) = Σ_k ρ_mk/(1 + cλ_k). What is compared are residuals ln(measured/model), magnitude and phase together, by the
//! likelihood of Student's distribution with a scale that is free (`misfit`), and by what BIC takes for each free number.
//!
//! A change is a finding where its log-likelihood ratio to the data as they are is at least [`FINDING_NATS`] and leaves a misfit that is smaller by [`MAX_MISFIT_RATIO`]; then a second change is looked for with
//! the first in force, and a third is not: who finds three faults has the wrong model.
//!
//! # Limits
//! Load and response that are swapped give the same FRF (reciprocity), and cannot be distinguished. A factor of all sensors and the modulus are one where nothing but stiffness
//! answers (a clamped structure below its first resonance), and then nothing is said. Damping that shows gives a conjugated FRF away; where it is less than the noise, nothing is said.
//! A dof is one of several where neighbours or mirror images answer alike: all of them are named. Faults that depend on frequency (a filter, a mounting resonance) are not looked for.

mod data_hypothesis;
mod dof_mismatch;
mod few;
mod finding;
mod many;
mod mesh;
mod misfit;
mod responses;
mod search;

pub use few::{FINDING_NATS, MAX_MISFIT_RATIO};
pub use finding::{Diagnosis, Evidence, Fault, Finding, KNOWN_FACTOR_RTOL, KnownFactor, NotJudged, OtherRow};

use crate::for_each::ForEach;
use crate::identify::{Context, Options, Problem, ProblemError, ReducedBand};
use crate::quantity::Quantity;
use crate::response::Work;
use crate::subspace::Subspace;
use few::Model;

/// Looks for what is wrong with a band's data against its model; `quantities` says what each sensor's values were before they were made receptances.
///
/// Where the band is identified too, [`diagnose_on`] shares its reduced model.
///
/// Costs one real factorisation and some dozens of solves; two more where another row is looked for. Of more than twenty sensors that many are looked at
/// together, all others are compared with the modulus that they have, and those that differ most are looked at one by one: the cost beyond that of
/// twenty sensors is one product with the basis at each frequency, and one residual a sensor and frequency.
///
/// Of several unknowns each in turn is free with the others at their nominal values, and the one with the least misfit is
/// believed, if it explains the data to a misfit of 0.3.
///
/// # Errors
/// [`ProblemError`]: where there is not one quantity for each sensor, or an option does not belong to the problem.
///
/// # Limits
/// Several unknowns that are all far from their nominal values hide a fault. A factor that has no name (a unit, gravity) is not a
/// finding beside several unknowns: these may be off by as much.
pub fn diagnose(
    problem: &Problem<'_>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    diagnose_by(None, problem, quantities, options, for_each)
}

/// The same on a reduced model that is shared with [`identify_on`](crate::identify::identify_on), and trained now where it is not
/// yet: for all unknowns and sensors one, and no factorisation but where another row is looked for.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_on<'a>(
    reduced: &mut ReducedBand<'a>,
    problem: &'a Problem<'a>,
    quantities: &[Quantity],
    options: &Options,
    for_each: ForEach<'_>,
) -> Result<Diagnosis, ProblemError> {
    let before = reduced.work();
    let context = Context { for_each, progress: &|_, _, _| {} };
    let trained = reduced.trained(problem, options, context)?;
    let mut found = diagnose_by(trained, problem, quantities, options, for_each)?;
    found.work += reduced.work().since(before);
    Ok(found)
}

fn diagnose_by(
    trained: Option<&Subspace<'_>>,
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
    let mut best: Option<Diagnosis> = None;
    let mut work = Work::default();
    for (j, unknown) in problem.unknowns().iter().enumerate() {
        let Some(parameter) = unknown.parameter() else { continue };
        let band = problem.band(j, &parameter);
        let model = Model { problem, unknown: j, trained, sensors: (0..sensors).collect() };
        let mut found = match sensors > many::MAX_FITTED_SENSORS {
            true => many::diagnose(&model, &band, quantities, options, for_each)?,
            false => few::look(&model, &band, quantities, options, for_each, &|_| ())?.0,
        };
        work += found.work;
        if problem.unknowns().len() > 1 {
            // What the other unknowns may be off by looks like a factor without a name.
            found.findings.retain(|finding| !matches!(finding.fault, Fault::Factor { known: None, .. }));
        }
        let misfit = |found: &Diagnosis| found.misfit.unwrap_or(f64::INFINITY);
        if best.as_ref().is_none_or(|best| misfit(&found) < misfit(best)) {
            best = Some(found);
        }
    }
    let several = problem.unknowns().len() > 1;
    let open =
        |found: &Diagnosis| several && found.misfit.is_some_and(|misfit| misfit > MAX_MISFIT_OF_ONE_UNKNOWN);
    Ok(match best {
        Some(found) if !open(&found) => Diagnosis { work, ..found },
        found => Diagnosis {
            findings: Vec::new(),
            misfit: found.as_ref().and_then(|found| found.misfit),
            not_judged: Some(NotJudged::SeveralUnknowns),
            frequencies: found.map_or(0, |found| found.frequencies),
            work,
        },
    })
}

/// A misfit up to which one free unknown beside others at their nominal values is believed: a factor of 1.3, or 17 degrees.
const MAX_MISFIT_OF_ONE_UNKNOWN: f64 = 0.3;
