//! Several parameters along one direction: a system in one parameter.

use crate::c64;
use crate::response::{Response, Work};
use frfit_linalg::solve::Breakdown;

/// The corrections c = t d as one parameter t: $$ D(t) = A_0 + \sum_q t^q \sum_j d_j^q A_{j,q}. $$
///
/// Series, [`convergence_radius`](super::convergence_radius) and all that takes a system of one parameter hold along the direction: with d the corrections that are
/// to be made the series in several parameters converges there iff ρ at t = 1 is below one.
#[derive(Debug)]
pub struct Along<'a, R> {
    system: &'a R,
    direction: Vec<c64>,
}

impl<'a, R: Response> Along<'a, R> {
    /// A direction, with one entry for each of the system's first parameters; the others stay at their nominal values.
    pub fn new(system: &'a R, direction: &[c64]) -> Self {
        Self { system, direction: direction.to_vec() }
    }

    fn corrections(&self, t: c64) -> Vec<c64> {
        self.direction.iter().map(|d| t * d).collect()
    }
}

impl<R: Response> Response for Along<'_, R> {
    fn frequency_hz(&self) -> f64 {
        self.system.frequency_hz()
    }

    fn dim(&self) -> usize {
        self.system.dim()
    }

    fn sensors(&self) -> usize {
        self.system.sensors()
    }

    /// Zero: t counts from the nominal values.
    fn nominal(&self, _: usize) -> c64 {
        c64::default()
    }

    fn degree(&self, _: usize) -> usize {
        (0..self.direction.len()).map(|j| self.system.degree(j)).max().unwrap_or(0)
    }

    fn load(&self) -> &[c64] {
        self.system.load()
    }

    fn solve_nominal(&self, x: &mut [c64]) -> Result<(), Breakdown> {
        self.system.solve_nominal(x)
    }

    fn solve_nominal_block(&self, block: &mut [c64]) -> Result<(), Breakdown> {
        self.system.solve_nominal_block(block)
    }

    fn multiply_add(&self, _: usize, power: usize, factor: c64, x: &[c64], out: &mut [c64]) {
        if power == 0 {
            return self.system.multiply_add(0, 0, factor, x, out);
        }
        for (j, d) in self.direction.iter().enumerate() {
            if power <= self.system.degree(j) && *d != c64::default() {
                self.system.multiply_add(j, power, factor * d.powu(power as u32), x, out);
            }
        }
    }

    fn observe(&self, x: &[c64]) -> Vec<c64> {
        self.system.observe(x)
    }

    fn solve_at(&self, corrections: &[c64]) -> Result<Vec<c64>, Breakdown> {
        self.system.solve_at(&self.corrections(corrections[0]))
    }

    fn work(&self) -> Work {
        self.system.work()
    }
}
