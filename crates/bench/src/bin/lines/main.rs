//! Time and memory of a band over the number of its frequencies.
//!
//! `lines [MAX_LINES]` leaves out bands of more frequencies (default: 100 000).
//!
//! A clamped plate of 972 degrees of freedom with a loss factor of one per mille and a few per cent, exact measurements, one thread. Memory is that of the process before
//! the identification, and the largest during it.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::frequency::linear_hz;
use frfit::identify::{Options, Status};
use frfit::model::Sensor;
use frfit_bench::measurement::by_subspace;
use frfit_bench::{Structure, Table, machine, memory};
use frfit_examples::clamped_plate;
use std::error::Error;

const FREQUENCIES: [usize; 4] = [1000, 3000, 10_000, 100_000];

/// Elements along an edge.
const ELEMENTS: usize = 19;

/// The nominal modulus is 1 + δ times the true one.
const DELTA: f64 = 0.25;

fn main() -> Result<(), Box<dyn Error>> {
    let most = std::env::args().nth(1).map_or(Ok(100_000), |most| most.parse())?;
    println!("Cost of a band over its frequencies\n{}\n", machine());
    let heading = [
        "frequencies",
        "sensors",
        "CPU (s)",
        "subspace",
        "solutions",
        "selection",
        "before (MB)",
        "peak (MB)",
        "explored",
        "factorisations",
        "ok",
        "right",
    ];
    let mut table = Table::new(heading);
    for count in FREQUENCIES.into_iter().filter(|&count| count <= most) {
        for sensors in [2, 1] {
            eprintln!("{count} frequencies, {sensors} sensors …");
            let mut model = clamped_plate(ELEMENTS)?;
            let sensors_there = &mut model.experiment.sensors;
            // Three elements further along x and as many back along y.
            let row = sensors_there[0].row + 3 * 3 - 3 * 3 * (ELEMENTS - 1);
            sensors_there.push(Sensor { row, ..sensors_there[0] });
            let [first, last] = model.band_hz;
            let mut structure = Structure::of(model, linear_hz(first, last, count), 1e-5, 3.0);
            structure.measured = by_subspace(&structure, 0)?.measured;
            memory::forget_peak();
            let before = memory::resident().unwrap_or(0);
            let run = structure.task(sensors, DELTA)?.run(&Options::default(), 1)?;
            let peak = memory::peak().unwrap_or(0);
            let megabytes = |bytes: usize| format!("{:.0}", bytes as f64 / 1e6);
            table.push([
                count.to_string(),
                sensors.to_string(),
                format!("{:.2}", run.cpu),
                format!("{:.2}", run.stages.subspace),
                format!("{:.2}", run.stages.solutions),
                format!("{:.2}", run.stages.selection),
                megabytes(before),
                megabytes(peak),
                run.found.search.explored.to_string(),
                run.found.search.work.factorisations.to_string(),
                run.found.count(Status::Ok).to_string(),
                run.score.to_string(),
            ]);
        }
    }
    println!("{table}");
    Ok(())
}
