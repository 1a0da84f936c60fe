//! How much of a statistical test is run, for all crates, by path.
//!
//! The daily tier draws one seed, or a few, of every case that a test is about; `cargo xtask test --long` sets
//! `FRFIT_LONG` and draws them all. The bounds of a share or of a mean come from the number of draws, in both.
#![allow(dead_code, reason = "each crate uses a part")]

/// Whether all is run.
pub(crate) fn is_long() -> bool {
    std::env::var_os("FRFIT_LONG").is_some()
}

/// How many are drawn, or what else differs between the tiers.
pub(crate) fn of_tier<T>(daily: T, long: T) -> T {
    if is_long() { long } else { daily }
}

/// How far a share of about 0.95 may be off among so many independent draws: 3.3 standard deviations, once in a thousand.
pub(crate) fn scatter_of_95(draws: f64) -> f64 {
    3.3 * (0.95 * 0.05 / draws).sqrt()
}
