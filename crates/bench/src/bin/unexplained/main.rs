//! What data cost that no modulus explains, beside explained ones: measured responses of which only every eighth line is right, the others are interpolated.
//!
//! `unexplained [NX] [FREQUENCIES]`: a sandwich of NX × NX/8 elements in plan (default 100: 20 000 degrees of freedom); default 1000 frequencies.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::{ModelErrors, Options, Status};
use frfit_bench::measurement::by_subspace;
use frfit_bench::{Run, Structure, Table, machine};
use frfit_examples::sandwich;
use std::error::Error;

/// The nominal core is 1 + δ times the true one.
const DELTA: f64 = 0.5;

/// Lines from one right line to the next.
const STEP: usize = 8;

/// The strip's mesh, and the one that it is measured on.
const COARSE: [usize; 2] = [40, 4];
const FINE: [usize; 2] = [60, 6];
const STRIP_LINES: usize = 991;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let nx: usize = arguments.next().map_or(Ok(100), |nx| nx.parse())?;
    let lines: usize = arguments.next().map_or(Ok(1000), |lines| lines.parse())?;
    println!("Data that no modulus explains\n{}\n", machine());
    let mut table = Table::new([
        "data",
        "dofs",
        "errors of the model",
        "CPU (s)",
        "subspace",
        "solutions",
        "selection",
        "explored",
        "factorisations",
        "vectors",
        "ok",
    ]);
    let mut add = |data: &str, structure: &Structure| -> Result<(), Box<dyn Error>> {
        for model_errors in [ModelErrors::None, ModelErrors::Estimated] {
            let options = Options::default().with_model_errors(model_errors);
            let run: Run = structure.task(structure.experiment.sensors.len(), DELTA)?.run(&options, 1)?;
            let (stages, search) = (run.stages, &run.found.search);
            table.push([
                data.to_owned(),
                structure.stiffness.dim().to_string(),
                format!("{model_errors:?}"),
                format!("{:.2}", run.cpu),
                format!("{:.2}", stages.subspace),
                format!("{:.2}", stages.solutions),
                format!("{:.2}", stages.selection),
                search.explored.to_string(),
                search.work.factorisations.to_string(),
                search.reduced_size.map_or("–".to_owned(), |size| size.to_string()),
                format!("{} of {}", run.found.count(Status::Ok), run.score.count),
            ]);
        }
        Ok(())
    };
    let mut sandwich = measured(nx, nx / 8, lines)?;
    add("exact", &sandwich)?;
    sandwich.measured = interpolated(&sandwich.measured);
    add("interpolated", &sandwich)?;
    let mut strip = measured(COARSE[0], COARSE[1], STRIP_LINES)?;
    add("exact", &strip)?;
    strip.measured = measured(FINE[0], FINE[1], STRIP_LINES)?.measured;
    add("of a finer mesh", &strip)?;
    println!("{table}");
    Ok(())
}

/// A sandwich with its exact response.
fn measured(nx: usize, ny: usize, lines: usize) -> Result<Structure, Box<dyn Error>> {
    let model = sandwich(nx, ny, 2)?;
    let [first, last] = model.band_hz;
    let mut structure = Structure::of(model, linear_hz(first, last, lines), 1e-5, 3.0);
    structure.measured = by_subspace(&structure, 0)?.measured;
    Ok(structure)
}

/// Every so many lines are as they are, those between them on straight lines.
fn interpolated(measured: &[Vec<c64>]) -> Vec<Vec<c64>> {
    let n = measured.len();
    let line = |i: usize| -> Vec<c64> {
        let left = i / STEP * STEP;
        let right = (left + STEP).min(n - 1);
        let t = if right > left { (i - left) as f64 / (right - left) as f64 } else { 0.0 };
        measured[left].iter().zip(&measured[right]).map(|(a, b)| a * (1.0 - t) + b * t).collect()
    };
    (0..n).map(line).collect()
}
