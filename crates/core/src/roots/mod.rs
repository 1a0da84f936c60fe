//! Roots of P-30: which corrections make the truncated response equal the measured one, and which to believe.

mod bounds;
mod candidates;

pub use bounds::{Bounds, BoundsError};
pub use candidates::{Candidate, Refusal, RootOptions, candidates, least_admissible, refuse_diverged};
