//! Intel MKL: PARDISO, and the matrix product that is the ceiling of all.

mod foreign;

pub use foreign::{Mkl, trim_memory};

use crate::case::{Case, Number};
use crate::round::{Report, Round, solves, timed};
use foreign::Handle;

/// One round of PARDISO: METIS, its default pivoting, no scaling or matching (the defaults for these matrices), no refinement
/// that was asked for.
///
/// # Errors
/// Its number of the error.
pub fn pardiso<T: Number>(mkl: &Mkl, case: &Case<T>, threads: usize) -> Result<Round<T>, String> {
    mkl.set_threads(threads);
    let pattern = &case.pattern;
    // The lower triangle by columns is the upper one by rows.
    let mut handle = Handle::new(mkl, pattern.col_ptr(), pattern.row_idx(), &case.values);
    handle.iparm[1] = 2; // METIS
    handle.iparm[7] = 0; // no refinement, but two steps where pivots were perturbed
    handle.iparm[17] = -1; // count the factor's entries
    handle.iparm[18] = -1; // count operations
    let failed = |error| format!("PARDISO's error {error}");
    let (outcome, analysis) = timed(|| handle.phase(11));
    outcome.map_err(failed)?;
    let (outcome, factor) = timed(|| handle.phase(22));
    outcome.map_err(failed)?;
    let n = case.dim();
    let mut x = vec![T::default(); case.rhs.len()];
    let (_, solve_8) = solves(&case.rhs, |b| handle.solve(b, &mut x)).map_err(failed)?;
    let (_, solve_1) = solves(&case.rhs[..n], |b| handle.solve(b, &mut x[..n])).map_err(failed)?;
    let iparm = handle.iparm;
    let megabytes = |kilobytes: i32| f64::from(kilobytes) * 1024.0 / 1e6;
    let mut remark = format!(
        "analysis peak {:.0}, kept {:.0}, factor {:.0} MB",
        megabytes(iparm[14]),
        megabytes(iparm[15]),
        megabytes(iparm[16])
    );
    if iparm[13] > 0 || iparm[6] > 0 {
        remark += &format!("; {} pivots perturbed, {} steps of refinement", iparm[13], iparm[6]);
    }
    let report = Report {
        memory: Some(megabytes(iparm[15] + iparm[16])),
        entries: Some(f64::from(iparm[17]) / 1e6),
        gflop: Some(f64::from(iparm[18]) / 1e3),
        negative: T::real(&case.values).map(|_| iparm[22] as usize),
        remark,
    };
    Ok(Round { analysis, factor, solve_1, solve_8, report, peak: None, solution: x })
}
