//! A zoo of wrong models: how far the modulus is off where the model is not the structure that was measured, and whether error bars and statuses say so.
//!
//! `wrong-models [CASES] [SEED] [--class CLASS] [--way WAY] [--csv FILE] [--case K] [--meshes one|finer|two]
//! [--nominal-within FACTOR] [--faults one|all]`: so many cases (default 40) of a seed (default 1), of all classes
//! and ways or of one; with `--case` the case K alone, line by line. With `--meshes finer` the model has elements of half the size, with
//! `two` also what would be the model as a coarser mesh beside it. With `--way several` all stiffnesses of a case are unknown: of orthotropic plates, sandwiches and beams
//! on springs; with `--way several-smooth` the core of a sandwich is smooth. With `--nominal-within 10` the nominal value is off by up to ten times to either side, not
//! by 0.6 to 1.4. With `--faults all` a case has smaller faults of all kinds beside that of its class. Case K of a seed is always the same, and its class is the K-th, counted round.
//!
//! Each case draws a structure, its material, load, sensors and noise, and measures the truth, which is another model by class, with direct solves.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

use frfit::identify::Options;
use frfit_bench::cases::{Cases, number};
use frfit_bench::machine;
use frfit_bench::wrong_models::case::{Faults, Meshes, Setting};
use frfit_bench::wrong_models::fault::{Class, Unknowns};
use frfit_bench::wrong_models::report::{LEGEND, csv, described, errors, lines, markdown};
use frfit_bench::wrong_models::way::Way;
use frfit_bench::wrong_models::{Failure, tried};

/// What was asked for.
struct Arguments {
    cases: usize,
    seed: u64,
    class: Option<Class>,
    ways: Vec<Way>,
    csv: Option<String>,
    case: Option<u64>,
    meshes: Meshes,
    nominal_within: Option<f64>,
    faults: Faults,
}

impl Arguments {
    fn read(mut words: impl Iterator<Item = String>) -> Result<Self, Failure> {
        let ways = Way::OF_ONE.to_vec();
        let mut read = Self {
            cases: 40,
            seed: 1,
            class: None,
            ways,
            csv: None,
            case: None,
            meshes: Meshes::One,
            nominal_within: None,
            faults: Faults::One,
        };
        let mut positions = 0;
        while let Some(word) = words.next() {
            if !word.starts_with("--") {
                match positions {
                    0 => read.cases = number(&word)?,
                    1 => read.seed = number(&word)?,
                    _ => return Err(format!("expected CASES and SEED, found {word:?} besides").into()),
                }
                positions += 1;
                continue;
            }
            let value = words.next().ok_or_else(|| format!("{word}: expected a value"))?;
            match word.as_str() {
                "--class" => read.class = Some(value.parse()?),
                "--way" => read.ways = vec![value.parse()?],
                "--csv" => read.csv = Some(value),
                "--case" => read.case = Some(number(&value)?),
                "--nominal-within" => read.nominal_within = Some(factor(&value)?),
                "--meshes" => {
                    read.meshes = match value.as_str() {
                        "one" => Meshes::One,
                        "finer" => Meshes::Finer,
                        "two" => Meshes::Two,
                        _ => {
                            return Err(format!("--meshes: expected one, finer or two, found {value}").into());
                        }
                    }
                }
                "--faults" => {
                    read.faults = match value.as_str() {
                        "one" => Faults::One,
                        "all" => Faults::All,
                        _ => return Err(format!("--faults: expected one or all, found {value}").into()),
                    }
                }
                _ => {
                    let expected = "--class, --way, --csv, --case, --nominal-within, --meshes or --faults";
                    return Err(format!("expected {expected}, found {word}").into());
                }
            }
        }
        Ok(read)
    }
}

/// A factor of more than one.
fn factor(word: &str) -> Result<f64, Failure> {
    let factor = word.parse().ok().filter(|factor| *factor > 1.0 && f64::is_finite(*factor));
    factor.ok_or_else(|| format!("--nominal-within: expected a number above 1, found {word:?}").into())
}

fn main() -> Result<(), Failure> {
    let arguments = Arguments::read(std::env::args().skip(1))?;
    let Arguments { cases, seed, class, ways, .. } = &arguments;
    println!("Wrong models: the modulus, its error bars and statuses\n{}\n", machine());
    let options = Options::default();
    let (first, count) = arguments.case.map_or((0, *cases), |index| (index, 1));
    let unknowns = Unknowns::of(ways);
    let is_asked = |index: &u64| {
        let own = Class::of(*index);
        arguments.case.is_some()
            || (class.is_none_or(|class| own == class) && !own.kinds(unknowns).is_empty())
    };
    let indices: Vec<u64> = (first..).filter(is_asked).take(count).collect();
    let Arguments { meshes, nominal_within, faults, .. } = arguments;
    let setting = Setting { meshes, nominal_within, faults };
    let one = |index| tried(*seed, index, ways, setting, &options);
    let all = Cases::try_all(&indices, one, described)?;
    if let Some(file) = &arguments.csv {
        std::fs::write(file, csv(&all.tried))?;
    }
    if arguments.case.is_some() {
        for case in &all.tried {
            println!("{}\n", described(case));
            case.runs.iter().for_each(|run| println!("{}\n{}", lines(run), errors(case, run)));
        }
    }
    println!("{} cases of seed {seed}\n\n{}\n{LEGEND}", all.tried.len(), markdown(&all.tried));
    all.all_made()
}
