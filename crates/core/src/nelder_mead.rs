//! The competitor of the paper's Fig. 5: a simplex search over the complex factor, each evaluation a direct solve.
//!
//! # Source
//! J. A. Nelder, R. Mead, Computer Journal 7 (1965) 308–313; iteration by the crate argmin.

use crate::c64;
use crate::response::{Response, relative_error};
use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;

/// Where a search ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// The correction c of least error.
    pub correction: c64,
    /// ε there, P-40.
    pub error: f64,
    /// Direct solves made.
    pub evaluations: usize,
}

/// Minimises ε (P-40) over (Re c, Im c) from the nominal value, for at most `iterations` simplex steps.
///
/// The first simplex is the nominal value and 5 % of it in each direction, as MATLAB's fminsearch sets it.
/// A value at which the system cannot be solved counts as infinitely bad.
///
/// # Limits
/// A local search: it ends in the valley that it starts in.
pub fn search(system: &impl Response, measured: &[c64], iterations: usize) -> Minimum {
    let scale = match system.nominal(0).norm() {
        0.0 => 1.0,
        size => size,
    };
    let simplex = vec![vec![0.0, 0.0], vec![0.05, 0.0], vec![0.0, 0.05]];
    let problem = Misfit { system, measured, scale };
    let fallback = Minimum { correction: c64::default(), error: f64::INFINITY, evaluations: 0 };
    let Ok(solver) = NelderMead::new(simplex).with_sd_tolerance(0.0) else { return fallback };
    let run = Executor::new(problem, solver).configure(|state| state.max_iters(iterations as u64)).run();
    let Ok(result) = run else { return fallback };
    let state = result.state();
    let best = state.get_best_param().map_or(c64::default(), |p| c64::new(p[0], p[1]) * scale);
    Minimum {
        correction: best,
        error: state.get_best_cost(),
        evaluations: state.get_func_counts().values().sum::<u64>() as usize,
    }
}

struct Misfit<'a, R> {
    system: &'a R,
    measured: &'a [c64],
    scale: f64,
}

impl<R: Response> CostFunction for Misfit<'_, R> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, p: &Vec<f64>) -> Result<f64, Error> {
        let correction = c64::new(p[0], p[1]) * self.scale;
        Ok(self.system.solve_at(&[correction]).map_or(f64::INFINITY, |x| relative_error(self.measured, &x)))
    }
}
