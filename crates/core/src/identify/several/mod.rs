//! Several unknowns at once: moduli at every frequency beside constants, laws and geometric parameters (P-10, B-5, B-8).
//!
//! With per-frequency unknowns c_i and numbers θ that hold for the band,
//! $$ \min_{\theta, c_1 \dots c_n} \sum_i \sum_m \frac{|u_m(\omega_i) - x_m(\omega_i, c_i, \theta)|^2}{\sigma_{im}^2} $$
//! is made least with the c_i eliminated frequency by frequency: for given θ each c_i is the best of all solutions there, and the slopes of the residual, (1 − QQᵀ) ∂r/∂θ
//! with Q spanning ∂r/∂c_i, move θ (L. Kaufman, BIT 15 (1975) 49–57). One real subspace serves every frequency and every value of every unknown, so that the cost of
//! several unknowns is a larger subspace and not more factorisations.
//!
//! | file | contents |
//! |---|---|
//! | `coordinates` | θ ↔ what holds for the band |
//! | `neighbourhoods` | the reduced model over the box of all unknowns |
//! | `starts` | where to begin |
//! | `at_frequency` | one frequency |
//! | `path` | which of several solutions belong together |
//! | `search` | θ |
//! | `information` | which directions of θ are identifiable |
//! | `judge` | error bars, what is not identifiable, statuses |
//! | `corrected` | errors of the model |

mod at_frequency;
mod coordinates;
mod corrected;
mod information;
mod judge;
mod neighbourhoods;
mod outlier_sensor;
mod path;
mod search;
mod starts;
#[cfg(test)]
mod tests;

use super::channel::Calibration;
use super::context::Context;
use super::dead_channel::dead_channels;
use super::far_nominal::{Far, MeasuredShapes, are_stiffnesses};
use super::identification::{Identification, SearchReport};
use super::noise::{NoiseLevel, without};
use super::options::Options;
use super::outcome::Line;
use super::problem::Problem;
use super::unknown::{Composite, Dependence, Unknown};
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::frfs::standard_deviations;
use crate::material::OutsideTable;
use crate::response::Work;
use crate::subspace::{Point, Subspace};
use frfit_linalg::solve::Breakdown;
use neighbourhoods::Neighbourhoods;
use search::BandSolution;

/// What there is to work with.
struct Task<'t, 'a> {
    /// As it is searched: what is smooth is free at every frequency.
    problem: &'t Problem<'a>,
    /// As it was asked.
    asked: &'t Problem<'a>,
    /// About which answers are searched, `[frequency][unknown]`.
    nominal: &'t [Vec<c64>],
    /// The nominal values that were given.
    given: &'t [Vec<c64>],
    omegas: Vec<f64>,
    /// σ of real and imaginary part each; infinite of a sensor that is left out.
    sigma: Vec<Vec<f64>>,
    left_out: Vec<usize>,
    options: &'t Options,
    context: Context<'t>,
}

/// Identifies several unknowns over a band.
///
/// Starts are the nominal values and points of the box of all unknowns, judged by the logarithms of the responses with everything constant over the band; what is per frequency is
/// then freed. Unknowns that the measurements cannot separate are found from the singular directions of the information, and named: their standard deviations are large, and their
/// status is `not_identifiable`.
///
/// # Errors
/// [`OutsideTable`] where a table does not reach a frequency.
///
/// # Limits
/// Of several per-frequency unknowns solutions are those that several starts lead to, not provably all; a single one that stands for a factor has all of them (B-2).
pub(super) fn identify_several<'a>(
    problem: &Problem<'a>,
    trained: &mut Option<Subspace<'a>>,
    options: &Options,
    context: Context<'_>,
) -> Result<Identification, OutsideTable> {
    let frfs = problem.frfs;
    let nominal = nominal_of(problem)?;
    let dead = dead_channels(frfs.receptance);
    let freed: Vec<Unknown> = problem.unknowns.iter().map(Unknown::freed).collect();
    let task = Task {
        problem: &problem.with_unknowns(&freed),
        asked: problem,
        nominal: &nominal,
        given: &nominal,
        omegas: frfs.frequency_hz.iter().map(|&f| omega_rad_s(f)).collect(),
        sigma: without(&standard_deviations(frfs.frequency_hz, frfs.receptance, frfs.noise), &dead),
        left_out: dead,
        options,
        context,
    };
    let subspace = match trained.take() {
        Some(subspace) => Ok(subspace),
        None => train(None, problem, context)?,
    };
    Ok(match subspace {
        Ok(subspace) => {
            let mut reduced = Neighbourhoods::new(subspace, problem, &nominal, context);
            let mut found = task.searched(&mut reduced);
            let moved: Vec<Vec<c64>>;
            let mut about = Vec::new();
            let mut task = task;
            if let Some(factors) = task.far(&reduced, &found) {
                let times = |values: &Vec<c64>| values.iter().zip(&factors).map(|(p, f)| p * f).collect();
                moved = nominal.iter().map(times).collect();
                match neighbourhoods::train(Some(reduced.into_subspace()), problem, &moved, context)? {
                    Ok(subspace) => reduced = Neighbourhoods::new(subspace, problem, &moved, context),
                    Err(breakdown) => return Ok(task.broken(breakdown)),
                }
                task = Task { nominal: &moved, ..task };
                found = task.searched(&mut reduced);
                about = factors;
            }
            let kept = task.leaving_out(&found.left_out);
            let mut outcome = kept.correct(&mut reduced, &found.solution, found.right);
            outcome.search.about = about;
            outcome.sensors = kept.sensor_fits(&task.sigma, &found.contradicting, &outcome);
            *trained = Some(reduced.into_subspace());
            outcome
        }
        Err(breakdown) => task.broken(breakdown),
    })
}

/// What a search found.
struct Searched {
    solution: BandSolution,
    /// As a right model has it.
    right: Identification,
    /// Sensors that contradict all others, and those that are left out.
    contradicting: Vec<usize>,
    left_out: Vec<usize>,
}

/// The nominal values, `[frequency][unknown]`.
fn nominal_of(problem: &Problem<'_>) -> Result<Vec<Vec<c64>>, OutsideTable> {
    let composite = Composite { model: problem.model, unknowns: problem.unknowns };
    problem.frfs.frequency_hz.iter().map(|&f| composite.nominal(f)).collect()
}

/// A subspace that is good over the box of all unknowns: a new one, or one that was kept.
pub(super) fn train<'a>(
    kept: Option<Subspace<'a>>,
    problem: &Problem<'a>,
    context: Context<'_>,
) -> Result<Result<Subspace<'a>, Breakdown>, OutsideTable> {
    neighbourhoods::train(kept, problem, &nominal_of(problem)?, context)
}

impl Task<'_, '_> {
    /// What a right model has, without sensors that contradict all others.
    fn searched(&self, reduced: &mut Neighbourhoods<'_>) -> Searched {
        let mut solution = self.search(reduced);
        let contradicting = self.contradicting(reduced, &solution);
        let rejected = if self.options.reject_outliers { contradicting.as_slice() } else { &[] };
        let left_out = [self.left_out.as_slice(), rejected].concat();
        let kept = self.leaving_out(&left_out);
        if !rejected.is_empty() {
            solution = kept.search(reduced);
        }
        let right = kept.judge(reduced, &solution, None);
        Searched { solution, right, contradicting, left_out }
    }

    /// By which factors nominal values are far off, where the band is not explained and natural frequencies say that all stiffnesses together are, or a single one. A
    /// value outside the bounds of its unknown is no candidate.
    fn far(&self, reduced: &Neighbourhoods<'_>, found: &Searched) -> Option<Vec<f64>> {
        if found.right.fit.is_some_and(|fit| fit.is_explained()) {
            return None;
        }
        let Problem { model, unknowns, frfs, .. } = self.problem;
        let is_stiffness = |j: &usize| match &unknowns[*j].dependence {
            Dependence::Factor(terms) => are_stiffnesses(model, terms.iter().copied()),
            Dependence::Powers(_) => false,
        };
        let all: Vec<usize> = (0..unknowns.len()).filter(is_stiffness).collect();
        if all.is_empty() {
            return None;
        }
        let single = all.iter().map(|&j| vec![j]).filter(|_| all.len() > 1);
        let measured = (frfs.receptance, self.sigma.as_slice());
        let for_each = self.context.for_each;
        let shapes = MeasuredShapes::new(&self.omegas, measured, model.decay_per_s(), for_each)?;
        let middle = frfs.frequency_hz.len() / 2;
        let of = |which: Vec<usize>| -> Option<(Far, Vec<usize>)> {
            let first = *which.first()?;
            let nominal: Vec<(f64, c64)> =
                frfs.frequency_hz.iter().zip(self.nominal).map(|(&f, values)| (f, values[first])).collect();
            let point = |factor: f64| {
                let mut values = self.nominal[middle].clone();
                which.iter().for_each(|&j| values[j] *= factor);
                let frequency_hz = frfs.frequency_hz[middle];
                let at = match which.len() {
                    1 => reduced.composite.about_one(frequency_hz, &values, first).ok()?,
                    _ => reduced.composite.at(frequency_hz, &values).ok()?,
                };
                Some(Point { at, correction: c64::default() })
            };
            let far = shapes.far(reduced.whole(), &nominal, &point)?;
            Some((far, which))
        };
        let is_within = |(far, which): &(Far, Vec<usize>)| {
            let broken = |j: usize| unknowns[j].bounds.broken_by(far.factor * self.nominal[middle][j]);
            which.iter().all(|&j| broken(j) != Some("storage"))
        };
        let (far, which) = std::iter::once(all.clone())
            .chain(single)
            .filter_map(of)
            .filter(is_within)
            .max_by(|a, b| a.0.gain.total_cmp(&b.0.gain))?;
        let factor = |j: usize| if which.contains(&j) { far.factor } else { 1.0 };
        Some((0..unknowns.len()).map(factor).collect())
    }

    fn broken(&self, breakdown: Breakdown) -> Identification {
        let at = |(nominal, &frequency_hz): (&Vec<c64>, &f64)| {
            Line::broken(frequency_hz, nominal, 0, breakdown.clone())
        };
        let lines = self.given.iter().zip(self.problem.frfs.frequency_hz).map(at).collect();
        let noise = NoiseLevel::new(self.problem.frfs.noise, None, None);
        Identification {
            channels: vec![Calibration::default(); self.problem.channels.len()],
            search: SearchReport {
                work: Work { factorisations: 2, solves: 0 },
                breakdown: Some(breakdown),
                ..SearchReport::default()
            },
            ..Identification::of_lines(lines, noise)
        }
    }
}
