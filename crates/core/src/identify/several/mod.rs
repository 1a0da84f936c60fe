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
mod outcome;
mod outlier_sensor;
mod path;
mod search;
mod starts;
#[cfg(test)]
mod tests;

pub(super) use outcome::SeveralOutcome;
pub use outcome::{BandCoordinate, BandValue, Direction, Number, NumberOf, Profile};

use super::channel::Calibration;
use super::context::Context;
use super::dead_channel::dead_channels;
use super::noise::{NoiseLevel, standard_deviations, without};
use super::options::Options;
use super::outcome::Line;
use super::problem::Problem;
use super::unknown::{Composite, Unknown};
use crate::c64;
use crate::frequency::omega_rad_s;
use crate::material::OutsideTable;
use crate::response::Work;
use crate::subspace::Subspace;
use frfit_linalg::solve::Breakdown;
use neighbourhoods::Neighbourhoods;

/// What there is to work with.
struct Task<'t, 'a> {
    /// As it is searched: what is smooth is free at every frequency.
    problem: &'t Problem<'a>,
    /// As it was asked.
    asked: &'t Problem<'a>,
    /// `[frequency][unknown]`.
    nominal: &'t [Vec<c64>],
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
) -> Result<SeveralOutcome, OutsideTable> {
    let frfs = problem.frfs;
    let nominal = nominal_of(problem)?;
    let dead = dead_channels(frfs.receptance);
    let freed: Vec<Unknown> = problem.unknowns.iter().map(Unknown::freed).collect();
    let task = Task {
        problem: &problem.with_unknowns(&freed),
        asked: problem,
        nominal: &nominal,
        omegas: frfs.frequency_hz.iter().map(|&f| omega_rad_s(f)).collect(),
        sigma: without(&standard_deviations(frfs.receptance, frfs.noise), &dead),
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
            let mut found = task.search(&mut reduced);
            let contradicting = task.contradicting(&mut reduced, &found);
            let rejected = if options.reject_outliers { contradicting.as_slice() } else { &[] };
            let kept = task.leaving_out(&[task.left_out.as_slice(), rejected].concat());
            if !rejected.is_empty() {
                found = kept.search(&mut reduced);
            }
            let right = kept.judge(&reduced, &found, None);
            let mut outcome = kept.correct(&mut reduced, &found, right);
            outcome.sensors = kept.sensor_fits(&task.sigma, &contradicting, &outcome);
            *trained = Some(reduced.into_subspace());
            outcome
        }
        Err(breakdown) => task.broken(breakdown),
    })
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
    fn broken(&self, breakdown: Breakdown) -> SeveralOutcome {
        let at = |(nominal, &frequency_hz): (&Vec<c64>, &f64)| {
            Line::broken(frequency_hz, nominal, 0, breakdown.clone())
        };
        SeveralOutcome {
            band: Vec::new(),
            lines: self.nominal.iter().zip(self.problem.frfs.frequency_hz).map(at).collect(),
            coordinates: Vec::new(),
            correlation: Vec::new(),
            directions: Vec::new(),
            channels: vec![Calibration::default(); self.problem.channels.len()],
            profile: None,
            noise: NoiseLevel::new(self.problem.frfs.noise, None, None),
            fit: None,
            sensors: Vec::new(),
            model_errors: None,
            leverage: Vec::new(),
            converged: false,
            starts: 0,
            agreeing: 0,
            work: Work { factorisations: 2, solves: 0 },
            subspace_size: 0,
            breakdown: Some(breakdown),
        }
    }
}
