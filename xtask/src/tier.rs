//! The two tiers of tests.

/// Set for the tests of the long tier.
pub(crate) const LONG: &str = "FRFIT_LONG";

/// How much of the tests is run.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Tier {
    /// What a change has to pass: minutes.
    Daily,
    /// Statistical tests with all their seeds and cases, the site, and the report in a browser too.
    Long,
}
