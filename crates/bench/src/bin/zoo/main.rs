//! A zoo of right models: how many identifiable lines are refused, and how many `ok` values are wrong.
//!
//! `zoo [CASES] [SEED] [--case K] [--published]`: so many cases (default 40) of a seed (default 1), or the case K alone. Case K of a seed is always the same.
//! With `--published` the models are matrices of the Harwell–Boeing collection, read from FRFIT_DATA, or `shared/data` beside the project.
//!
//! Each case draws a model, its material, load, sensors, band, noise, nominal value and bounds, and measures the truth, which is the model, with direct solves.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit_bench::cases::{Cases, arguments};
use frfit_bench::machine;
use frfit_bench::wrong_models::Failure;
use frfit_bench::zoo::case::Kind;
use frfit_bench::zoo::report::{LEGEND, described, markdown};
use frfit_bench::zoo::tried;

fn main() -> Result<(), Failure> {
    let (indices, seed, published) = arguments([40, 1], Some("--published"))?;
    let kind = |index| if published { Kind::Published } else { Kind::of(index) };
    println!("Right models: what is identified of what is identifiable\n{}\n", machine());
    let all = Cases::try_all(&indices, |index| tried(kind(index), seed, index), described)?;
    println!("{} cases of seed {seed}\n\n{}\n\n{LEGEND}", all.tried.len(), markdown(&all.tried));
    all.all_made()
}
