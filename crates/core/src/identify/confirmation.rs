//! A root that is chosen, and confirmed by a fresh direct solve.

use super::goodness_of_fit::MAX_ERROR;
use super::outcome::Line;
use crate::c64;
use crate::response::{Response, relative_error};
use crate::roots::{Candidate, least_admissible};
use frfit_linalg::solve::Breakdown;

/// The sensor whose polynomial gives the roots; the others enter the error.
pub(super) const SENSOR: usize = 0;

/// Solves again with the correction, records error and response, and says whether the sensor that gave the root is matched.
pub(super) fn confirm(
    system: &impl Response,
    measured: &[c64],
    correction: c64,
    outcome: &mut Line,
) -> Result<bool, Breakdown> {
    let updated = system.solve_at(&[correction])?;
    let here = relative_error(&measured[SENSOR..=SENSOR], &updated[SENSOR..=SENSOR]);
    outcome.set_correction(correction);
    outcome.error = Some(relative_error(measured, &updated)).filter(|error| error.is_finite());
    outcome.updated_response = updated;
    // False for NaN too.
    Ok(here <= MAX_ERROR)
}

/// The admissible root of least |c|, or failing that the one of least |c| within the bounds, as evidence.
pub(super) fn choose(roots: &[Candidate]) -> Option<Candidate> {
    roots.iter().find(|root| root.refusal.is_none()).or_else(|| least_admissible(roots)).copied()
}
