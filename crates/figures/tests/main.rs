//! Pictures of good and of nasty data.

mod drawing;
mod nasty;
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
