//! One frequency by the rational response: all solutions within the bounds, not only those of a convergent series.

use super::confirmation::{SENSOR, choose, confirm};
use super::options::Options;
use super::outcome::{Line, Status};
use super::unknown::Unknown;
use crate::c64;
use crate::rational::{RationalResponse, RationalRoot};
use crate::response::{Response, relative_error};
use crate::roots::{Candidate, Refusal, RootOptions};
use crate::series::convergence_radius;
use frfit_linalg::dense::NoConvergence;
use frfit_linalg::solve::Breakdown;

/// Vectors of the first attempt, and how many each further one adds.
const VECTORS_PER_ATTEMPT: usize = 8;

/// A root whose true residual is below this solves the full system: the residual of a double precision solve with a
/// condition of 1e6, as a structure near resonance has.
pub(super) const ROOT_RESIDUAL_TOL: f64 = 1e-9;

/// Stiffer contrasts leave larger residuals to roundoff alone. There a direct solve decides: a root whose response is the measured one to
/// this is a solution, with a few digits to spare for the loss of this solve.
pub(super) const RESPONSE_MATCH_RTOL: f64 = 1e-6;

/// Grows the basis until there is a root within the bounds and every one solves the full system, or the order is reached.
///
/// Where a root within the bounds is still unsure at the highest order, it could be the answer: the status is then `ambiguous`, not
/// `ok`, however good another one is.
pub(super) fn by_rational(
    system: &impl Response,
    measured: &[c64],
    unknown: &Unknown,
    options: &Options,
    outcome: &mut Line,
) -> Result<(), Breakdown> {
    let mut order = VECTORS_PER_ATTEMPT.min(options.order);
    let mut response = RationalResponse::new(system, 0, order)?;
    loop {
        let judged = judge(&response, measured[SENSOR], outcome.nominal(), &unknown.roots());
        outcome.roots = judged.map_err(|NoConvergence| Breakdown::NotFinite)?;
        // That a low order has no solution is no proof that no solution exists.
        let settled = !unsure(&outcome.roots) && outcome.candidate_count() > 0;
        if settled || order == options.order || response.is_complete() {
            break;
        }
        order = (order + VECTORS_PER_ATTEMPT).min(options.order);
        response = response.extended(system, 0, order)?;
    }
    decide(system, measured, &mut outcome.roots);
    outcome.order = response.size().saturating_sub(1);
    outcome.nominal_response =
        response.respond(c64::default()).map_err(|NoConvergence| Breakdown::NotFinite)?;
    let radius = convergence_radius(system, 0)?;
    outcome.radius = Some(radius);
    let Some(chosen) = choose(&outcome.roots) else {
        outcome.status = Status::NoRoot;
        return Ok(());
    };
    outcome.spectral_radius = Some(radius.at(chosen.correction));
    let confirmed = confirm(system, measured, chosen.correction, outcome)?;
    outcome.status = match (confirmed && chosen.refusal.is_none(), outcome.candidate_count()) {
        (false, _) => Status::Failed,
        (true, 1) if !unsure(&outcome.roots) => Status::Ok,
        (true, _) => Status::Ambiguous,
    };
    Ok(())
}

/// Solves the full system at the roots that are unsure, and admits those that reproduce the measured response.
fn decide(system: &impl Response, measured: &[c64], roots: &mut [Candidate]) {
    for root in roots.iter_mut().filter(|root| root.refusal == Some(Refusal::Moves)) {
        let Ok(x) = system.solve_at(&[root.correction]) else { continue };
        if relative_error(&measured[SENSOR..=SENSOR], &x[SENSOR..=SENSOR]) <= RESPONSE_MATCH_RTOL {
            root.refusal = None;
        }
    }
}

/// Whether a root within the bounds does not yet solve the full system.
fn unsure(roots: &[Candidate]) -> bool {
    roots.iter().any(|root| root.refusal == Some(Refusal::Moves))
}

fn judge(
    response: &RationalResponse,
    measured: c64,
    nominal: c64,
    options: &RootOptions,
) -> Result<Vec<Candidate>, NoConvergence> {
    let judged = |root: RationalRoot| {
        let refusal = options.refuse(nominal, root.correction).or({
            // False for NaN too.
            let solves = root.residual <= ROOT_RESIDUAL_TOL;
            (!solves).then_some(Refusal::Moves)
        });
        let is_real = options.real && refusal != Some(Refusal::NotReal);
        let correction = if is_real { c64::new(root.correction.re, 0.0) } else { root.correction };
        Candidate { correction, drift: root.residual, refusal }
    };
    Ok(response.roots(SENSOR, measured)?.into_iter().map(judged).collect())
}
