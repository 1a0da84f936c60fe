//! Errors of factors that are taken for known: what is known of them before the data.

use super::sizes::FREQUENCY_PRIOR_STD;
use crate::identify::options::ErrorSizes;
use crate::model::{FactorPart, ModelAt, Role};

/// Before the data: known factors are good to two per cent, loss factors of known stiffnesses to a tenth of themselves or what bearings and air have.
const FACTOR_PRIOR_STD: f64 = 0.02;
const LOSS_FACTOR_PRIOR_STD: f64 = 0.002;
const LOSS_FACTOR_PRIOR_RATIO: f64 = 0.1;

/// What the stiffness of an unknown is known to at least, however little of the strain energy it has: no natural frequency shows it.
const MAX_FACTOR_PRIOR_STD: f64 = 0.25;

/// What is known of the error of a known factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FactorPrior {
    pub(super) term: usize,
    pub(super) part: FactorPart,
    pub(super) std: f64,
    /// Whether the model says so, and it is no default.
    pub(super) is_given: bool,
    /// Whether the term has no unknown.
    pub(super) is_known: bool,
}

/// Prior standard deviations of the errors of factors: what the model says, or what is usual. The stiffness matrix of an unknown has an error too.
/// The data cannot separate it from the unknown, which is therefore as uncertain. Where natural frequencies are good to s, a stiffness with the share p of the
/// strain energy is good to 2s/p.
pub(super) fn priors(at: &ModelAt<'_>, sizes: ErrorSizes, share_of_unknowns: f64) -> Vec<FactorPrior> {
    let of_unknown = 2.0 * FREQUENCY_PRIOR_STD / share_of_unknowns;
    let of_unknown = of_unknown.clamp(FACTOR_PRIOR_STD, MAX_FACTOR_PRIOR_STD);
    let of_term = |term: usize| {
        let is_known = !at.is_unknown(term);
        let (given, one) = (at.model.factor_std(term), &at.model.terms()[term]);
        let factor = one.factor.at(at.frequency_hz).unwrap_or_default();
        let loss_factor = if factor.re == 0.0 { 0.0 } else { factor.im / factor.re };
        let prior = |part, std: Option<f64>, usual| FactorPrior {
            term,
            part,
            std: std.unwrap_or(usual),
            is_given: std.is_some(),
            is_known,
        };
        let usual = if is_known { FACTOR_PRIOR_STD } else { of_unknown };
        let storage = prior(FactorPart::Storage, given.storage, usual);
        let usual = LOSS_FACTOR_PRIOR_STD.hypot(LOSS_FACTOR_PRIOR_RATIO * loss_factor);
        let loss = prior(FactorPart::LossFactor, given.loss_factor, usual);
        let is_stiffness = one.role == Role::Stiffness;
        let has_error = is_known || (is_stiffness && sizes.frequency.is_none());
        has_error.then_some(storage).into_iter().chain((is_known && is_stiffness).then_some(loss))
    };
    (0..at.model.terms().len()).flat_map(of_term).collect()
}
