//! Data with planted faults: which of them are named, and what is accused wrongly.
//!
//! `faults [CASES] [SEED] [--case K]`: so many cases (default 60) of a seed (default 1), or the case K alone. Case K of a seed is always the same.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit_bench::cases::{Cases, arguments};
use frfit_bench::faults::{LEGEND, described, markdown, tried};
use frfit_bench::machine;
use frfit_bench::wrong_models::Failure;

fn main() -> Result<(), Failure> {
    let (indices, seed) = arguments([60, 1])?;
    println!("Planted faults: what the diagnostics name\n{}\n", machine());
    let all = Cases::try_all(&indices, |index| tried(seed, index), described)?;
    println!("{} cases of seed {seed}\n\n{}\n\n{LEGEND}", all.tried.len(), markdown(&all.tried));
    all.all_made()
}
