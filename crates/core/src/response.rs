//! What the methods ask of a model at one frequency, and the full model's answer.

use crate::c64;
use crate::model::{Experiment, ModelAt};
use frfit_linalg::solve::{Breakdown, CheckedFactor};
use std::sync::atomic::{AtomicUsize, Ordering};

/// How much work was done; the unit in which costs are asserted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Numerical factorisations of an N × N matrix.
    pub factorisations: usize,
    /// Right-hand sides solved with such factors.
    pub solves: usize,
}

impl Work {
    /// What has been done since there was this much.
    pub(crate) fn since(self, before: Self) -> Self {
        Self {
            factorisations: self.factorisations - before.factorisations,
            solves: self.solves - before.solves,
        }
    }
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.factorisations += other.factorisations;
        self.solves += other.solves;
    }
}

/// A model at one frequency that can be solved at its nominal values, multiplied, observed, and solved again.
///
/// Series, roots and identification are written against this, once, whatever stands behind it.
pub trait Response {
    /// The frequency.
    fn frequency_hz(&self) -> f64;
    /// Number of unknowns of the linear systems.
    fn dim(&self) -> usize;
    /// Number of sensors.
    fn sensors(&self) -> usize;
    /// Nominal value p̄ of parameter j.
    fn nominal(&self, parameter: usize) -> c64;
    /// Highest power d of parameter j.
    fn degree(&self, parameter: usize) -> usize;
    /// The load F.
    fn load(&self) -> &[c64];
    /// x ← A₀⁻¹ x.
    ///
    /// # Errors
    /// [`Breakdown`] where the nominal system cannot be solved.
    fn solve_nominal(&self, x: &mut [c64]) -> Result<(), Breakdown>;
    /// X ← A₀⁻¹ X, column after column: the factor is met once for all of them where that is cheaper.
    ///
    /// # Errors
    /// [`Breakdown`] where the nominal system cannot be solved.
    ///
    /// # Panics
    /// Where the length is not a multiple of the number of unknowns.
    fn solve_nominal_block(&self, block: &mut [c64]) -> Result<(), Breakdown>;
    /// Receptance at the sensors with the nominal parameters, P-16, with the factor that is there.
    ///
    /// # Errors
    /// [`Breakdown`] where the nominal system cannot be solved.
    fn respond_nominal(&self) -> Result<Vec<c64>, Breakdown> {
        let mut x = self.load().to_vec();
        self.solve_nominal(&mut x)?;
        Ok(self.observe(&x))
    }
    /// out += factor · A_{j,q} x, for q = 1 … d; q = 0 stands for A₀.
    fn multiply_add(&self, parameter: usize, power: usize, factor: c64, x: &[c64], out: &mut [c64]);
    /// x at the sensors.
    fn observe(&self, x: &[c64]) -> Vec<c64>;
    /// Receptance at the sensors by a fresh direct solve of D(c) x = F, P-12; `corrections[j]` is c_j.
    ///
    /// # Errors
    /// [`Breakdown`] where D(c) cannot be solved.
    fn solve_at(&self, corrections: &[c64]) -> Result<Vec<c64>, Breakdown>;
    /// Work done so far.
    fn work(&self) -> Work;
}

/// The full sparse model at one frequency, with the factor of A₀.
#[derive(Debug)]
pub struct FullModel<'a> {
    at: ModelAt<'a>,
    experiment: &'a Experiment,
    factor: CheckedFactor<c64>,
    factorisations: AtomicUsize,
    solves: AtomicUsize,
}

impl<'a> FullModel<'a> {
    /// Assembles and factorises A₀.
    ///
    /// # Errors
    /// [`Breakdown`] where A₀ cannot be factorised.
    pub fn new(at: ModelAt<'a>, experiment: &'a Experiment) -> Result<Self, Breakdown> {
        let nominal = at.assemble(&vec![c64::default(); at.parameters.len()]);
        let factor = at.model.analysis().factor(&nominal)?;
        Ok(Self { at, experiment, factor, factorisations: AtomicUsize::new(1), solves: AtomicUsize::new(0) })
    }
}

impl Response for FullModel<'_> {
    fn frequency_hz(&self) -> f64 {
        self.at.frequency_hz
    }

    fn dim(&self) -> usize {
        self.at.model.dim()
    }

    fn sensors(&self) -> usize {
        self.experiment.sensors.len()
    }

    fn nominal(&self, parameter: usize) -> c64 {
        self.at.parameters[parameter].nominal
    }

    fn degree(&self, parameter: usize) -> usize {
        self.at.parameters[parameter].coefficients.len()
    }

    fn load(&self) -> &[c64] {
        &self.experiment.load
    }

    fn solve_nominal(&self, x: &mut [c64]) -> Result<(), Breakdown> {
        self.solves.fetch_add(1, Ordering::Relaxed);
        self.factor.solve(x).map(drop)
    }

    fn solve_nominal_block(&self, block: &mut [c64]) -> Result<(), Breakdown> {
        self.solves.fetch_add(block.len() / self.dim().max(1), Ordering::Relaxed);
        self.factor.solve(block).map(drop)
    }

    fn multiply_add(&self, parameter: usize, power: usize, factor: c64, x: &[c64], out: &mut [c64]) {
        let matrix = match power.checked_sub(1) {
            None => &self.at.nominal,
            Some(q) => &self.at.parameters[parameter].coefficients[q],
        };
        matrix.multiply_add(self.at.model, factor, x, out);
    }

    fn observe(&self, x: &[c64]) -> Vec<c64> {
        self.experiment.observe(x)
    }

    fn solve_at(&self, corrections: &[c64]) -> Result<Vec<c64>, Breakdown> {
        self.factorisations.fetch_add(1, Ordering::Relaxed);
        let factor = self.at.model.analysis().factor(&self.at.assemble(corrections))?;
        let mut x = self.experiment.load.clone();
        self.solves.fetch_add(1, Ordering::Relaxed);
        factor.solve(&mut x)?;
        Ok(self.experiment.observe(&x))
    }

    fn work(&self) -> Work {
        Work {
            factorisations: self.factorisations.load(Ordering::Relaxed),
            solves: self.solves.load(Ordering::Relaxed),
        }
    }
}

/// ε = ‖u − x‖ / ‖u‖ over the sensors, P-40.
pub fn relative_error(measured: &[c64], response: &[c64]) -> f64 {
    let misfit: f64 = measured.iter().zip(response).map(|(u, x)| (u - x).norm_sqr()).sum();
    let size: f64 = measured.iter().map(|u| u.norm_sqr()).sum();
    (misfit / size).sqrt()
}

/// The same over the sensors that are not left out.
pub(crate) fn relative_error_without(left_out: &[usize], measured: &[c64], response: &[c64]) -> f64 {
    let kept = |values: &[c64]| -> Vec<c64> {
        let kept = values.iter().enumerate().filter(|(m, _)| !left_out.contains(m));
        kept.map(|(_, value)| *value).collect()
    };
    relative_error(&kept(measured), &kept(response))
}
