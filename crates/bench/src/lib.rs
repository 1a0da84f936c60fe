//! What the benchmarks share: a clock, a table, the machine's name, a place for figures.
//!
//! Every benchmark is a program in `src/bin`. Times are CPU times, of one thread where nothing else is said, so that other work on the
//! machine disturbs them little; what is claimed are ratios of times from one run, never the times themselves.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

pub mod cases;
pub mod clock;
pub mod data;
mod exponent;
pub mod faults;
mod machine;
pub mod measurement;
pub mod memory;
mod output;
mod panel;
pub mod plates;
mod score;
mod stages;
mod table;
mod task;
#[cfg(test)]
#[path = "../../core/tests/tier/mod.rs"]
mod tier;
pub mod wrong_models;
pub mod zoo;

pub use exponent::exponent;
pub use machine::machine;
pub use output::save;
pub use panel::{panel, panel_dofs};
pub use score::Score;
pub use stages::{StageClock, Stages};
pub use table::Table;
pub use task::{Run, Structure, Task, in_pool};
