//! Fig. 1: how many times cheaper the series is than one more direct solve, by the formula P-51 and as measured.
//!
//! `speedup [DOFS]` leaves out models with more degrees of freedom.
//!
//! Measured is the time of one more direct solve at a new parameter value (assembly, numerical factorisation and solve;
//! the symbolic analysis is shared) over the time of an order-n series at that value, given the nominal factor: n + 1
//! solves, n products, and the sum. Every solve is a checked one, as everywhere in frfit.
#![allow(clippy::print_stdout, clippy::print_stderr)] // tables are what a benchmark is for

mod figures;
mod measure;
mod models;

use frfit::efficiency::speedup;
use frfit_bench::{Table, machine, save};
use measure::{ORDERS, Timing, measure};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let limit = std::env::args().nth(1).map_or(Ok(usize::MAX), |dofs| dofs.parse())?;
    println!("Fig. 1: speed-up of the order-n series over a direct solve\n{}", machine());
    println!("medians of at least {} runs, CPU time of one thread\n", frfit_bench::clock::RUNS);
    let mut timings = Vec::new();
    for kind in models::KINDS {
        for model in (kind.models)(limit)? {
            eprintln!("{}, N = {} …", kind.name, model.stiffness.dim());
            timings.push(measure(kind.name, &model)?);
        }
    }
    println!("{}", table(&timings));
    save("speedup", &figures::by_order(&timings))?;
    save("speedup-by-size", &figures::by_size(&timings))
}

fn table(timings: &[Timing]) -> Table {
    let shown = [10, 30, 50];
    let heading = ["model", "N", "nonzeros", "direct (s)", "term (s)", "direct/term"].map(str::to_owned);
    let measured = shown.map(|order| format!("n = {order}"));
    let formula = shown.map(|order| format!("P-51, {order}"));
    let mut table = Table::new(heading.into_iter().chain(measured).chain(formula));
    for timing in timings {
        let Timing { kind, dofs, nonzeros, direct_seconds, .. } = timing;
        let term = timing.term_seconds();
        let cells = [
            (*kind).to_owned(),
            dofs.to_string(),
            nonzeros.to_string(),
            format!("{direct_seconds:.2e}"),
            format!("{term:.2e}"),
            format!("{:.1}", direct_seconds / term),
        ];
        let measured = ORDERS.iter().zip(timing.speedups()).filter(|(order, _)| shown.contains(order));
        let measured = measured.map(|(_, ratio)| format!("{ratio:.2}"));
        let formula = shown.map(|order| format!("{:.1}", speedup(*dofs as f64, order as f64)));
        table.push(cells.into_iter().chain(measured).chain(formula));
    }
    table
}
