//! The roots over the orders: a root is believed when it stays where it is as terms are added.

use super::Bounds;
use crate::c64;
use crate::series::{ConvergenceRadius, NeumannSeries};
use crate::with_fields::with_fields;
use frfit_linalg::dense::{Root, evaluate, roots};

/// How roots are accepted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct RootOptions {
    /// Bounds on the updated factor.
    pub bounds: Bounds,
    /// Whether the parameter is known to be real: roots with an imaginary part are refused, and that of the
    /// others is dropped.
    pub real: bool,
}

with_fields!(RootOptions { with_bounds: bounds as Bounds });

impl RootOptions {
    /// What the user knows that speaks against a correction: it is not real, or breaks a bound.
    pub fn refuse(&self, nominal: c64, correction: c64) -> Option<Refusal> {
        let factor = nominal + correction;
        if self.real && correction.im.abs() > REAL_RTOL * factor.norm() {
            return Some(Refusal::NotReal);
        }
        let tested = if self.real { c64::new(factor.re, 0.0) } else { factor };
        self.bounds.broken_by(tested).map(Refusal::OutOfBounds)
    }
}

/// Why a root is not believed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// It does not satisfy its polynomial.
    NotARoot,
    /// The updated factor breaks the bound of this name.
    OutOfBounds(&'static str),
    /// It has an imaginary part, and the parameter is real.
    NotReal,
    /// It is further from the nominal than anything was looked at closely.
    Far,
    /// It moves as terms are added, or the series does not converge there; of a rational response: it does not solve the full
    /// system.
    Moves,
}

/// A root of the polynomial of the highest order, as a correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// c, of the unit of the parameter.
    pub correction: c64,
    /// How far it may still move, relative to |p̄ + c|: its largest distance from the nearest roots of the last few lower
    /// orders, or what the terms that were cut off can do to it, whichever is larger. Of a rational response: the true residual.
    pub drift: f64,
    /// Why it is not admissible; `None` where it is.
    pub refusal: Option<Refusal>,
}

/// Orders below n in which a root must reappear. Ghosts on the circle of convergence lie 2π/n apart and move by
/// about 2π/n² an order: over four orders that is more than the tolerance where over one it is not.
const LOOK_BACK_ORDERS: usize = 4;

/// Largest change of a root over the last orders, relative to the updated factor: the paper's measured bar (ρ = 0.82 at
/// n = 30) has 0.6 % left, ghosts on the circle of convergence move by some percent.
const MAX_DRIFT: f64 = 1e-2;

/// Roots are double-precision numbers of a polynomial known to roundoff: beyond this it is no root.
const MAX_BACKWARD_ERROR: f64 = 1e-10;

/// An imaginary part up to this fraction of the factor counts as the roundoff, or noise, of a real answer.
const REAL_RTOL: f64 = 1e-3;

/// All roots of P-30 at a sensor for the orders up to n, those of order n as candidates, least |c| first.
///
/// `measured` is a receptance, `nominal` the parameter's nominal value p̄.
///
/// # Limits
/// Only solutions inside the series' circle of convergence are roots that stay; others exist and are not seen (B-2 sees
/// them). A root that stays reproduces the measurement; on lightly damped structures it may still be the wrong one.
pub fn candidates(
    series: &NeumannSeries,
    sensor: usize,
    measured: c64,
    nominal: c64,
    order: usize,
    options: &RootOptions,
) -> Vec<Candidate> {
    let at_order = |order| roots_of_order(series, sensor, measured, order);
    let earlier: Vec<Vec<Root>> =
        (order.saturating_sub(LOOK_BACK_ORDERS).max(1)..order).map(at_order).collect();
    let mut candidates: Vec<Candidate> = at_order(order)
        .into_iter()
        .map(|root| {
            let correction = root.value * series.scale();
            let factor = nominal + correction;
            let drift = drift(root, &earlier) * series.scale() / factor.norm();
            let mut candidate = Candidate { correction, drift, refusal: None };
            candidate.refusal = refuse(root, &candidate, nominal, options);
            if options.real && candidate.refusal.is_none() {
                candidate.correction.im = 0.0;
            }
            candidate
        })
        .collect();
    candidates.sort_by(|a, b| a.correction.norm().total_cmp(&b.correction.norm()));
    candidates
}

/// Refuses candidates at which the series does not converge (ρ ≥ 1, P-14), and those that the terms cut off can move by more
/// than the tolerance.
///
/// The tail is at most the largest of the last terms times ρ/(1 − ρ), and moves a root by tail/|p′|. Ghosts on the circle of
/// convergence (Jentzsch) have ρ just below one and terms that do not fall: this separates them from solutions.
pub fn refuse_diverged(
    candidates: &mut [Candidate],
    series: &NeumannSeries,
    sensor: usize,
    nominal: c64,
    radius: &ConvergenceRadius,
) {
    let t = series.coefficients(sensor);
    let slope: Vec<c64> = t.iter().enumerate().skip(1).map(|(k, &t)| t * k as f64).collect();
    let last = t.len().saturating_sub(LOOK_BACK_ORDERS)..t.len();
    for candidate in candidates.iter_mut().filter(|candidate| candidate.refusal.is_none()) {
        let rho = radius.at(candidate.correction);
        let z = candidate.correction / series.scale();
        let term = last.clone().map(|k| (t[k] * z.powu(k as u32)).norm()).fold(0.0, f64::max);
        let moved = term * rho / (1.0 - rho) / evaluate(&slope, z).norm();
        let relative = moved * series.scale() / (nominal + candidate.correction).norm();
        candidate.drift = candidate.drift.max(relative);
        // False for NaN too.
        let stays = rho < 1.0 && relative <= MAX_DRIFT;
        if !stays {
            candidate.refusal = Some(Refusal::Moves);
        }
    }
}

/// The root of least |c| that no bound excludes, whether it stays or not: the paper's choice at a given order.
pub fn least_admissible(candidates: &[Candidate]) -> Option<&Candidate> {
    candidates.iter().find(|candidate| matches!(candidate.refusal, None | Some(Refusal::Moves)))
}

fn roots_of_order(series: &NeumannSeries, sensor: usize, measured: c64, order: usize) -> Vec<Root> {
    roots(&series.mismatch_polynomial(sensor, measured, order))
}

/// Largest distance to the nearest root over the earlier orders; infinite where there is no earlier order to compare.
fn drift(root: Root, earlier: &[Vec<Root>]) -> f64 {
    let nearest = |roots: &Vec<Root>| {
        roots.iter().map(|other| (other.value - root.value).norm()).fold(f64::INFINITY, f64::min)
    };
    earlier
        .iter()
        .map(nearest)
        .fold(None, |largest: Option<f64>, d| Some(largest.map_or(d, |l| l.max(d))))
        .unwrap_or(f64::INFINITY)
}

fn refuse(root: Root, candidate: &Candidate, nominal: c64, options: &RootOptions) -> Option<Refusal> {
    // Comparisons that are false for NaN, so that NaN is refused.
    let is_root = root.backward_error <= MAX_BACKWARD_ERROR;
    if !is_root {
        return Some(Refusal::NotARoot);
    }
    if let Some(refusal) = options.refuse(nominal, candidate.correction) {
        return Some(refusal);
    }
    let stays = candidate.drift <= MAX_DRIFT;
    (!stays).then_some(Refusal::Moves)
}
