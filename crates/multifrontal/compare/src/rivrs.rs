//! rivrs-sparse: a posteriori threshold pivoting after SSIDS, real only.

use crate::case::{Case, Number};
use crate::faer_solvers::parallelism;
use crate::round::{Report, Round, solves, timed};
use crate::symbolic::Full;
use faer::Col;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use rivrs_sparse::symmetric::{AnalyzeOptions, FactorOptions, OrderingStrategy, SparseLDLT};

/// How it orders and scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Its default: METIS after a matching, whose scaling it takes too.
    MatchMetis,
    /// METIS without scaling, which its manual recommends for structures.
    Metis,
}

/// One round; its solves take one right-hand side at a time.
///
/// # Errors
/// What it says; complex numbers.
pub fn round<T: Number>(order: Order, case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
    let Some(values) = T::real(&case.values) else { return Err("real only".to_owned()) };
    let Some(rhs) = T::real(&case.rhs) else { return Err("real only".to_owned()) };
    let (par, n) = (parallelism(threads), case.dim());
    let full = Full::new(&case.pattern);
    let values = full.source.iter().map(|&k| values[k]).collect();
    let pattern = SymbolicSparseColMat::new_checked(n, n, full.col_ptr, None, full.row_idx);
    let matrix = SparseColMat::new(pattern, values);
    let ordering = match order {
        Order::MatchMetis => OrderingStrategy::MatchOrderMetis,
        Order::Metis => OrderingStrategy::Metis,
    };
    let options = AnalyzeOptions { ordering };
    let (solver, analysis) = timed(|| SparseLDLT::analyze_with_matrix(&matrix, &options));
    let mut solver = solver.map_err(|error| error.to_string())?;
    let options = FactorOptions { par, ..FactorOptions::default() };
    let (outcome, factor) = timed(|| solver.factor(&matrix, &options));
    outcome.map_err(|error| error.to_string())?;
    let mut buffer = MemBuffer::new(solver.solve_scratch(1));
    let mut solve = |x: &mut [f64]| {
        x.chunks_mut(n).try_for_each(|x| {
            let mut column = Col::from_fn(n, |i| x[i]);
            solver
                .solve_in_place(&mut column, MemStack::new(&mut buffer), par)
                .map_err(|error| error.to_string())?;
            x.iter_mut().enumerate().for_each(|(i, x)| *x = column[i]);
            Ok::<_, String>(())
        })
    };
    let (x, solve_8) = solves(rhs, &mut solve)?;
    let (_, solve_1) = solves(&rhs[..n], &mut solve)?;
    let delayed = solver.stats().map_or(0, |stats| stats.total_delayed);
    let report = Report {
        negative: solver.inertia().map(|inertia| inertia.negative),
        remark: if delayed > 0 { format!("{delayed} pivots delayed") } else { String::new() },
        ..Report::default()
    };
    Ok(Round { analysis, factor, solve_1, solve_8, report, peak: None, solution: T::of_real(x) })
}
