//! How often the modulus that is found is the right one: the paper's way, all roots with the smallest taken, and all roots
//! with all sensors and frequencies together.
//!
//! `truth [SAMPLE]`: the two that take the smallest correction run on the full model, at so many of the frequencies (default 60). They
//! look at the first sensor alone: what they find does not depend on the others.
//!
//! Measured is the exact response of the full model with the true factor, without noise. BCSSTK09 and the sandwich beam of NLEVP are read from
//! FRFIT_DATA, or `shared/data` beside the project; the latter needs a Python with SciPy (FRFIT_PYTHON, or python3).
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

mod cases;
mod files;

use cases::{CASES, Case};
use frfit::identify::{Options, Reduction, Selection};
use frfit_bench::{Run, Structure, Table, machine, measurement};
use std::error::Error;

/// Frequencies of a case.
const FREQUENCIES: usize = 300;

/// Threads, as the workflow would take on this machine.
const THREADS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let sample = std::env::args().nth(1).map_or(Ok(60), |sample| sample.parse())?;
    println!(
        "Fraction of frequencies with the right modulus, in brackets how many are wrong and called ok\n{}",
        machine()
    );
    println!("{FREQUENCIES} frequencies; series and smallest at {sample} of them, on the full model\n");
    let heading = [
        "case",
        "δ",
        "sensors",
        "series n = 30",
        "rational, smallest",
        "rational, joint",
        "right and ok",
        "factorisations",
        "solves",
        "vectors",
        "reduction_error",
        "CPU (s)",
    ];
    let mut table = Table::new(heading);
    for case in &CASES {
        eprintln!("{} …", case.name);
        let mut structure = match (case.structure)(FREQUENCIES)? {
            Ok(structure) => structure,
            Err(why) => {
                println!("{} is left out: {why}", case.name);
                continue;
            }
        };
        structure.measured = measurement::direct(&structure)?;
        for &delta in case.deltas {
            add(&mut table, case, &structure, delta, sample)?;
        }
    }
    println!("{table}");
    Ok(())
}

/// The rows of one structure and one nominal: one sensor, and all.
fn add(
    table: &mut Table,
    case: &Case,
    structure: &Structure,
    delta: f64,
    sample: usize,
) -> Result<(), Box<dyn Error>> {
    let smallest = Options::default().with_selection(Selection::Smallest).with_reduction(Reduction::Full);
    let alone = |options: &Options| structure.task(1, delta)?.sample(sample).run(options, THREADS);
    let (series, smallest) = (alone(&Options::paper())?, alone(&smallest)?);
    for sensors in 1..=structure.experiment.sensors.len() {
        let joint = structure.task(sensors, delta)?.run(&Options::default(), THREADS)?;
        let once = |run: &Run| if sensors == 1 { run.score.to_string() } else { "″".to_owned() };
        let or_none = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
        table.push([
            case.name.to_owned(),
            format!("{delta:+.2}"),
            sensors.to_string(),
            once(&series),
            once(&smallest),
            joint.score.to_string(),
            joint.score.right_ok.to_string(),
            joint.found.search.work.factorisations.to_string(),
            joint.found.search.work.solves.to_string(),
            or_none(joint.found.search.reduced_size.map(|size| size.to_string())),
            or_none(joint.found.reduction_error().map(|error| format!("{error:.1e}"))),
            format!("{:.2}", joint.cpu),
        ]);
    }
    Ok(())
}
