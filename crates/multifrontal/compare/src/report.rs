//! Medians of the rounds, as a table and as lines of a file.

use crate::round::{Report, Round, Time, median};
use frfit_bench::Table;
use frfit_bench::clock;

/// All rounds of one solver with some threads on one matrix.
pub struct Entry {
    pub solver: &'static str,
    pub threads: usize,
    pub rounds: usize,
    analysis: Time,
    factor: Time,
    solve_1: Time,
    solve_8: Time,
    least: f64,
    peak: Option<f64>,
    error: f64,
    report: Report,
}

/// What all entries of a matrix are rated by.
pub struct Rating {
    /// 10⁹ operations of L D Lᵀ in the order of [`crate::symbolic`].
    pub gflop: f64,
    /// Threads, and 10⁹ operations a second of dense products with so many, MKL's or (without it) faer's.
    pub ceilings: Vec<(usize, f64)>,
}

impl Entry {
    /// From at least one round, and the backward error of the last.
    pub fn new<T>(solver: &'static str, threads: usize, rounds: &[Round<T>], error: f64) -> Self {
        let of = |time: fn(&Round<T>) -> &Time| median(rounds.iter().map(time));
        let peaks: Vec<f64> = rounds.iter().filter_map(|round| round.peak).collect();
        Self {
            solver,
            threads,
            rounds: rounds.len(),
            analysis: of(|round| &round.analysis),
            factor: of(|round| &round.factor),
            solve_1: of(|round| &round.solve_1),
            solve_8: of(|round| &round.solve_8),
            least: rounds.iter().map(|round| round.factor.wall).fold(f64::INFINITY, f64::min),
            peak: (!peaks.is_empty()).then(|| clock::median(peaks)),
            error,
            report: rounds.last().map(|round| round.report.clone()).unwrap_or_default(),
        }
    }

    /// Seconds that count: of one thread those of the processor, which other work on the machine disturbs little.
    fn seconds(&self, time: Time) -> f64 {
        if self.threads == 1 { time.cpu } else { time.wall }
    }

    fn speed(&self, rating: &Rating) -> f64 {
        rating.gflop / self.seconds(self.factor)
    }

    fn of_ceiling(&self, rating: &Rating) -> f64 {
        let ceiling = rating.ceilings.iter().find(|(threads, _)| *threads == self.threads);
        self.speed(rating) / ceiling.map_or(f64::NAN, |(_, speed)| *speed)
    }
}

/// The table of one matrix; ratios to PARDISO with as many threads, empty without it.
pub fn table(entries: &[Entry], rating: &Rating) -> Table {
    let mut table = Table::new([
        "solver",
        "threads",
        "rounds",
        "analysis s",
        "factor s",
        "on clock",
        "least",
        "/PARDISO",
        "GF/s",
        "of dense",
        "solve 1 ms",
        "/PARDISO",
        "solve 8 ms",
        "/PARDISO",
        "L M",
        "GF own",
        "memory MB",
        "peak MB",
        "error",
        "negative",
        "",
    ]);
    for entry in entries {
        let baseline =
            entries.iter().find(|other| other.solver == "pardiso" && other.threads == entry.threads);
        let ratio = |of: fn(&Entry) -> Time| {
            let ratio = |other: &Entry| entry.seconds(of(entry)) / other.seconds(of(other));
            baseline.map_or(String::new(), |other| format!("{:.2}", ratio(other)))
        };
        let milliseconds = |time| format!("{:.1}", 1e3 * entry.seconds(time));
        let or_none =
            |value: Option<f64>, digits| value.map_or("–".to_owned(), |value| format!("{value:.digits$}"));
        let report = &entry.report;
        table.push([
            entry.solver.to_owned(),
            entry.threads.to_string(),
            entry.rounds.to_string(),
            format!("{:.3}", entry.seconds(entry.analysis)),
            format!("{:.3}", entry.seconds(entry.factor)),
            format!("{:.3}", entry.factor.wall),
            format!("{:.3}", entry.least),
            ratio(|entry| entry.factor),
            format!("{:.1}", entry.speed(rating)),
            format!("{:.0}%", 100.0 * entry.of_ceiling(rating)),
            milliseconds(entry.solve_1),
            ratio(|entry| entry.solve_1),
            milliseconds(entry.solve_8),
            ratio(|entry| entry.solve_8),
            or_none(report.entries, 2),
            or_none(report.gflop, 2),
            or_none(report.memory, 0),
            or_none(entry.peak, 0),
            format!("{:.1e}", entry.error),
            report.negative.map_or("–".to_owned(), |count| count.to_string()),
            report.remark.clone(),
        ]);
    }
    table
}

/// Heading of the file.
pub const CSV_HEADING: &str = "matrix,numbers,n,gflop,solver,threads,rounds,analysis_wall_s,analysis_cpu_s,factor_wall_s,\
factor_cpu_s,factor_least_wall_s,solve1_wall_s,solve1_cpu_s,solve8_wall_s,solve8_cpu_s,gflops_per_s,of_dense,entries_millions,own_gflop,\
memory_mb,peak_mb,backward_error,negative,remark";

/// One line of the file, without its end.
pub fn csv_line(matrix: &str, numbers: &str, n: usize, entry: &Entry, rating: &Rating) -> String {
    let or_empty = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let mut cells = vec![matrix.to_owned(), numbers.to_owned(), n.to_string(), rating.gflop.to_string()];
    cells.extend([entry.solver.to_owned(), entry.threads.to_string(), entry.rounds.to_string()]);
    let times = |time: Time| [time.wall.to_string(), time.cpu.to_string()];
    cells.extend([entry.analysis, entry.factor].map(times).concat());
    cells.push(entry.least.to_string());
    cells.extend([entry.solve_1, entry.solve_8].map(times).concat());
    cells.extend([entry.speed(rating).to_string(), entry.of_ceiling(rating).to_string()]);
    let report = &entry.report;
    cells.extend([report.entries, report.gflop, report.memory, entry.peak].map(or_empty));
    cells.push(entry.error.to_string());
    cells.push(report.negative.map_or(String::new(), |count| count.to_string()));
    // A remark has commas.
    cells.push(format!("\"{}\"", report.remark.replace('"', "'")));
    cells.join(",")
}
