//! multifrontal, which all others are here for.

use crate::case::{Case, Number};
use crate::round::{Report, Round, solves, timed};
use multifrontal::{Options, Symbolic, Threads};
use rayon::ThreadPoolBuilder;
use std::time::Duration;

/// One round with all its defaults, in a pool of so many threads.
///
/// # Errors
/// What it says.
pub fn round<T: Number>(case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
    if threads < 2 {
        return round_on(case, Threads::One);
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    pool.install(|| round_on(case, Threads::Spinning(Duration::from_millis(1))))
}

fn round_on<T: Number>(case: &Case<T>, threads: Threads) -> Result<Round<T>, String> {
    let (n, pattern) = (case.dim(), &case.pattern);
    let options = Options::default().with_threads(threads);
    let (symbolic, analysis) = timed(|| Symbolic::new(n, pattern.col_ptr(), pattern.row_idx(), &options));
    let symbolic = symbolic.map_err(|error| error.to_string())?;
    let (outcome, factor) = timed(|| symbolic.factor(&case.values, &options));
    let factorised = outcome.map_err(|error| error.to_string())?;
    let solve = |x: &mut [T]| {
        factorised.solve_in_place(x, threads);
        Ok::<_, String>(())
    };
    let (solution, solve_8) = solves(&case.rhs, solve)?;
    let (_, solve_1) = solves(&case.rhs[..n], solve)?;
    let mut remark = Vec::new();
    for (count, of) in [(factorised.delayed(), "pivots delayed"), (factorised.pairs(), "pairs")] {
        if count > 0 {
            remark.push(format!("{count} {of}"));
        }
    }
    let report = Report {
        memory: Some((symbolic.bytes() + factorised.bytes()) as f64 / 1e6),
        entries: Some(symbolic.factor_entries() as f64 / 1e6),
        gflop: Some(T::FLOPS * symbolic.flops() / 1e9),
        negative: T::real(&case.values).map(|_| factorised.inertia().negative),
        remark: remark.join(", "),
    };
    Ok(Round { analysis, factor, solve_1, solve_8, report, peak: None, solution })
}
