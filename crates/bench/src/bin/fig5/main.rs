//! Fig. 5: error of the updated response against the CPU time that it took, series and Nelder–Mead, at one frequency.
//!
//! The series' time is everything from the assembled matrices to the answer: factorisation of A₀, n + 1 solves, roots of
//! the last orders, choice. That of Nelder–Mead is the search alone. The error is P-40 from a fresh direct solve with the
//! correction found, outside the time.
#![allow(clippy::print_stdout)] // tables are what a benchmark is for

mod contest;
mod figure;

use contest::{Contest, Run};
use frfit_bench::{Table, machine, save};
use frfit_examples::rubber_bar;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let contest = Contest::at(&rubber_bar(100)?, 1500.0)?;
    let title = "Rubber bar, 101 degrees of freedom, 1500 Hz";
    println!("Fig. 5: error against CPU time\n{title}\n{}", machine());
    println!("means over {} repeats, CPU time of one thread\n\n{}", contest::REPEATS, table(&contest));
    verdicts(&contest).iter().for_each(|line| println!("{line}"));
    save("fig5", &figure::error_against_time(title, &contest))
}

/// Both methods side by side: their n-th runs.
fn table(contest: &Contest) -> Table {
    let mut table = Table::new(["n", "series: ε", "seconds", "±", "Nelder–Mead: ε", "seconds", "±"]);
    let cells = |run: Option<&Run>| match run {
        Some(run) => [run.error, run.seconds, run.deviation].map(|value| format!("{value:.2e}")),
        None => Default::default(),
    };
    for n in 0..contest.series.len().max(contest.nelder_mead.len()) {
        let sides = cells(contest.series.get(n)).into_iter().chain(cells(contest.nelder_mead.get(n)));
        table.push(std::iter::once((n + 1).to_string()).chain(sides));
    }
    table
}

/// How many times faster the series is at equal error: the least time of each method to reach it.
fn verdicts(contest: &Contest) -> Vec<String> {
    let best = |runs: &[Run]| runs.iter().map(|run| run.error).fold(f64::INFINITY, f64::min);
    let levels = [1e-2, 1e-4, 1e-6, best(&contest.nelder_mead), best(&contest.series)];
    levels.into_iter().map(|error| verdict(contest, error)).collect()
}

fn verdict(contest: &Contest, error: f64) -> String {
    let least = |runs: &[Run]| {
        let reaching = runs.iter().enumerate().filter(|(_, run)| run.error <= error);
        reaching.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds)).map(|(n, run)| (n + 1, run.seconds))
    };
    match (least(&contest.series), least(&contest.nelder_mead)) {
        (Some((order, series)), Some((iterations, search))) => format!(
            "ε ≤ {error:.0e}: series (order {order}) {:.2} times as fast as Nelder–Mead ({iterations} iterations)",
            search / series
        ),
        (Some((order, _)), None) => format!("ε ≤ {error:.0e}: series (order {order}) only"),
        (None, Some((iterations, _))) => {
            format!("ε ≤ {error:.0e}: Nelder–Mead ({iterations} iterations) only")
        }
        (None, None) => format!("ε ≤ {error:.0e}: neither"),
    }
}
