//! Data with planted faults: which of them are named, and what is accused wrongly.
//!
//! `faults [CASES] [SEED] [--rows] [--case K]`: so many cases (default 60) of a seed (default 1), or the case K alone. Case K of a seed is always the same.
//! With `--rows` each case has the load and a sensor on other rows than the case says.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit_bench::cases::{Cases, arguments};
use frfit_bench::faults::{LEGEND, Which, described, markdown, tried};
use frfit_bench::machine;
use frfit_bench::wrong_models::Failure;

fn main() -> Result<(), Failure> {
    let (indices, seed, is_of_rows) = arguments([60, 1], Some("--rows"))?;
    let which = if is_of_rows { Which::Rows } else { Which::All };
    println!("Planted faults: what the diagnostics name\n{}\n", machine());
    let all = Cases::try_all(&indices, |index| tried(seed, index, which), described)?;
    println!("{} cases of seed {seed}\n\n{}\n\n{LEGEND}", all.tried.len(), markdown(&all.tried));
    all.all_made()
}
