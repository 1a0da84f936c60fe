//! One frequency.

use super::choice::Method;
use super::confirmation::{SENSOR, choose, confirm};
use super::options::Options;
use super::outcome::{Line, Status};
use super::rational::by_rational;
use super::unknown::Unknown;
use crate::c64;
use crate::nelder_mead;
use crate::response::{Response, relative_error};
use crate::roots::{candidates, least_admissible, refuse_diverged};
use crate::series::{NeumannSeries, convergence_radius};
use frfit_linalg::solve::Breakdown;

/// Finds the correction of the model's first parameter that reproduces the measured receptances, one for each sensor.
///
/// The paper's Section 4: series of order n from one factorisation, roots of P-30 at the first sensor, those that converge
/// over the orders and respect the bounds, of these the one of least |c|, and the error P-40 from a fresh direct solve.
/// A numerical outcome is a [`Status`] with its evidence, never an error.
///
/// # Panics
/// Where there is not one measured value for each sensor.
///
/// # Limits
/// `ok` says that one root is admissible *inside the circle of convergence* and reproduces the first sensor's response. Roots outside it are not seen:
/// where the true one is outside, a wrong one inside can be `ok`. Another sensor's error shows it.
pub fn identify_at(system: &impl Response, measured: &[c64], unknown: &Unknown, options: &Options) -> Line {
    let mut outcome = Line::unknown(system.frequency_hz(), system.nominal(0), options.order);
    let result = match options.method {
        Method::Series => by_series(system, measured, unknown, options, &mut outcome),
        Method::Rational => by_rational(system, measured, unknown, options, &mut outcome),
        Method::NelderMead => by_search(system, measured, unknown, options, &mut outcome),
    };
    if let Err(breakdown) = result {
        outcome.status = Status::Failed;
        outcome.breakdown = Some(breakdown);
    }
    outcome.work = system.work();
    outcome
}

fn by_series(
    system: &impl Response,
    measured: &[c64],
    unknown: &Unknown,
    options: &Options,
    outcome: &mut Line,
) -> Result<(), Breakdown> {
    let series = NeumannSeries::new(system, 0, options.order)?;
    outcome.nominal_response = series.respond(c64::default(), 0);
    outcome.roots =
        candidates(&series, SENSOR, measured[SENSOR], outcome.nominal(), options.order, &unknown.roots());
    let radius = convergence_radius(system, 0)?;
    outcome.radius = Some(radius);
    let nominal = outcome.nominal();
    refuse_diverged(&mut outcome.roots, &series, SENSOR, nominal, &radius);
    let Some(chosen) = choose(&outcome.roots) else {
        outcome.status = Status::NoRoot;
        return Ok(());
    };
    outcome.spectral_radius = Some(radius.at(chosen.correction));
    let confirmed = confirm(system, measured, chosen.correction, outcome)? && chosen.refusal.is_none();
    outcome.status = match (confirmed, outcome.candidate_count()) {
        (false, _) => Status::Diverged,
        (true, 1) => Status::Ok,
        (true, _) => Status::Ambiguous,
    };
    Ok(())
}

fn by_search(
    system: &impl Response,
    measured: &[c64],
    unknown: &Unknown,
    options: &Options,
    outcome: &mut Line,
) -> Result<(), Breakdown> {
    outcome.nominal_response = system.respond_nominal()?;
    let found = nelder_mead::search(system, &measured[SENSOR..=SENSOR], options.order);
    let matched = confirm(system, measured, found.correction, outcome)?;
    outcome.status = if matched { Status::Ok } else { Status::Diverged };
    if unknown.bounds.broken_by(outcome.nominal() + found.correction).is_some() {
        outcome.forget_value(Status::NoRoot);
    }
    Ok(())
}

/// ε at the first sensor (P-40, fresh direct solve) when the series is cut after each order from 1 to `order`: a column of
/// the paper's Figs 3, 8 and 12. `None` where an order has no root within the bounds, or its system cannot be solved.
///
/// # Errors
/// [`Breakdown`] where the nominal system cannot be solved.
pub fn error_by_order(
    system: &impl Response,
    measured: &[c64],
    unknown: &Unknown,
    options: &Options,
) -> Result<Vec<Option<f64>>, Breakdown> {
    let series = NeumannSeries::new(system, 0, options.order)?;
    let at_order = |order| {
        let roots = candidates(&series, SENSOR, measured[SENSOR], system.nominal(0), order, &unknown.roots());
        let root = least_admissible(&roots)?;
        let updated = system.solve_at(&[root.correction]).ok()?;
        Some(relative_error(&measured[SENSOR..=SENSOR], &updated[SENSOR..=SENSOR]))
    };
    Ok((1..=options.order).map(at_order).collect())
}
