//! A zoo of right models: how many identifiable lines are refused, and how many `ok` values are wrong.
//!
//! `zoo [CASES] [SEED] [--case K]`: so many cases (default 40) of a seed (default 1), or the case K alone. Case K of a seed is always the same.
//!
//! Each case draws a model, its material, load, sensors, band, noise, nominal value and bounds, and measures the truth, which is the model, with direct solves.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit_bench::wrong_models::Failure;
use frfit_bench::zoo::report::{LEGEND, Tried, described, markdown};
use frfit_bench::zoo::tried;
use frfit_bench::{in_pool, machine};
use rayon::prelude::*;

/// Threads, each with a case of its own.
const THREADS: usize = 2;

fn main() -> Result<(), Failure> {
    let mut positions = [40, 1];
    let (mut place, mut case) = (0, None);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if word == "--case" {
            case = Some(number(&words.next().ok_or("--case: expected a value")?)?);
        } else if place < positions.len() {
            positions[place] = number(&word)?;
            place += 1;
        } else {
            return Err(format!("expected CASES, SEED or --case, found {word:?}").into());
        }
    }
    let [cases, seed] = positions;
    println!("Right models: what is identified of what is identifiable\n{}\n", machine());
    let indices: Vec<u64> = case.map_or_else(|| (0..cases).collect(), |index| vec![index]);
    let one = |&index: &u64| {
        let done = tried(seed, index);
        eprintln!("{}", done.as_ref().map_or_else(ToString::to_string, described));
        done
    };
    let all: Vec<Result<Tried, Failure>> =
        in_pool(THREADS, || indices.par_iter().with_max_len(1).map(one).collect())?;
    let failed: Vec<String> =
        all.iter().filter_map(|one| one.as_ref().err()).map(ToString::to_string).collect();
    let all: Vec<Tried> = all.into_iter().flatten().collect();
    println!("{} cases of seed {seed}\n\n{}\n\n{LEGEND}", all.len(), markdown(&all));
    match failed.len() {
        0 => Ok(()),
        // The table is there without them, but a fault of this program is not a result.
        count => Err(format!("{count} cases could not be made: {}", failed.join("; ")).into()),
    }
}

fn number(text: &str) -> Result<u64, Failure> {
    text.parse().map_err(|_| format!("expected a number, found {text:?}").into())
}
