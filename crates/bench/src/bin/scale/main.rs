//! Time, memory and counts of a band over the size of the model, with the exponents of the powers of N that fit them.
//!
//! `scale [DOFS]` leaves out models with more degrees of freedom (default: 300 000, some GB of memory).
//!
//! A sandwich in bricks, 1000 frequencies, one thread. The measurement is made with a subspace of its own
//! ([`frfit_bench::measurement::by_subspace`]); its estimated error is given, and up to 100 000 degrees of freedom that at two direct solves.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::frequency::linear_hz;
use frfit::identify::Options;
use frfit_bench::measurement::{BySubspace, by_subspace};
use frfit_bench::{Run, Structure, Table, exponent, machine, memory, panel, panel_dofs};
use std::error::Error;

/// Elements along the sandwich; an eighth of it across, and four through the thickness: 10k, 30k, 50k, 100k, 300k degrees of freedom.
const LENGTHS: [usize; 5] = [72, 120, 160, 224, 400];

const FREQUENCIES: usize = 1000;

/// The nominal core is 1 + δ times the true one.
const DELTA: f64 = 0.5;

/// A direct solve of more degrees of freedom costs more than all the rest.
const CHECKED: usize = 110_000;

/// What one size costs.
struct Cost {
    dofs: usize,
    /// Resident before: model and measurement.
    before: usize,
    /// Largest resident during the identification.
    peak: usize,
    measurement: BySubspace,
    run: Run,
}

fn main() -> Result<(), Box<dyn Error>> {
    let limit = std::env::args().nth(1).map_or(Ok(310_000), |dofs| dofs.parse())?;
    println!("Cost of a band over the size of the model\n{}", machine());
    println!(
        "{FREQUENCIES} frequencies, one thread; stages in CPU seconds; before: resident memory before the identification\n"
    );
    let mut costs = Vec::new();
    for nx in LENGTHS.into_iter().filter(|&nx| panel_dofs(nx) <= limit) {
        eprintln!("{} degrees of freedom …", panel_dofs(nx));
        costs.push(cost(nx)?);
    }
    println!("{}", table(&costs));
    Ok(())
}

fn cost(nx: usize) -> Result<Cost, Box<dyn Error>> {
    let model = panel(nx)?;
    let dofs = model.stiffness.dim();
    let [first, last] = model.band_hz;
    let mut structure = Structure::of(model, linear_hz(first, last, FREQUENCIES), 1e-5, 3.0);
    let mut measurement = by_subspace(&structure, if dofs <= CHECKED { 2 } else { 0 })?;
    structure.measured = std::mem::take(&mut measurement.measured);
    let task = structure.task(structure.experiment.sensors.len(), DELTA)?;
    memory::forget_peak();
    let before = memory::resident().unwrap_or(0);
    let run = task.run(&Options::default(), 1)?;
    Ok(Cost { dofs, before, peak: memory::peak().unwrap_or(0), measurement, run })
}

fn table(costs: &[Cost]) -> Table {
    let heading = [
        "N",
        "CPU (s)",
        "wall (s)",
        "subspace",
        "solutions",
        "selection",
        "peak (MB)",
        "before",
        "factorisations",
        "solves",
        "vectors",
        "right",
        "reduction_error",
        "measurement",
        "checked",
    ];
    let mut table = Table::new(heading);
    let megabytes = |bytes: usize| bytes as f64 / 1e6;
    for cost in costs {
        let Cost { dofs, before, peak, measurement, run } = cost;
        let stages = run.stages;
        let or_none = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.1e}"));
        table.push([
            dofs.to_string(),
            format!("{:.1}", run.cpu),
            format!("{:.1}", run.wall),
            format!("{:.1}", stages.subspace),
            format!("{:.1}", stages.solutions),
            format!("{:.2}", stages.selection),
            format!("{:.0}", megabytes(*peak)),
            format!("{:.0}", megabytes(*before)),
            run.found.search.work.factorisations.to_string(),
            run.found.search.work.solves.to_string(),
            run.found.search.reduced_size.map_or("–".to_owned(), |size| size.to_string()),
            run.score.to_string(),
            or_none(run.found.reduction_error()),
            or_none(Some(measurement.truncation)),
            or_none(measurement.checked),
        ]);
    }
    let dofs: Vec<f64> = costs.iter().map(|cost| cost.dofs as f64).collect();
    let power = |of: &dyn Fn(&Cost) -> f64| {
        let values: Vec<f64> = costs.iter().map(of).collect();
        format!("{:.2}", exponent(&dofs, &values))
    };
    table.push([
        "∝ N to the".to_owned(),
        power(&|cost| cost.run.cpu),
        power(&|cost| cost.run.wall),
        power(&|cost| cost.run.stages.subspace),
        power(&|cost| cost.run.stages.solutions),
        power(&|cost| cost.run.stages.selection),
        power(&|cost| megabytes(cost.peak)),
        power(&|cost| megabytes(cost.before)),
        power(&|cost| cost.run.found.search.work.factorisations as f64),
        power(&|cost| cost.run.found.search.work.solves as f64),
        power(&|cost| cost.run.found.search.reduced_size.unwrap_or(0) as f64),
    ]);
    table
}
