//! Where the basis grows: where the estimated error at the sensors is largest.

use super::assess::{AssessedSolution, weights};
use super::shift::Shift;
use super::{Assessment, Subspace};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::frequency::omega_rad_s;
use crate::model::ModelAt;
use crate::with_fields::with_fields;
use frfit_linalg::solve::Breakdown;
use frfit_linalg::vector::transpose_dot;

/// A frequency and a value of the first parameter.
#[derive(Debug, Clone)]
pub struct Point<'m> {
    /// The model at that frequency.
    pub at: ModelAt<'m>,
    /// c.
    pub correction: c64,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TrainOptions {
    /// Largest estimated error ([`super::Assessment::relative_truncation`]) to accept. Default 1e-9.
    pub tolerance: f64,
    /// Solves after which to give up, beside those that brought missing modes and four for each of these. Default 400.
    pub(crate) solves: usize,
    /// Real factorisations at most. Default 4.
    pub(crate) factorisations: usize,
}

impl Default for TrainOptions {
    fn default() -> Self {
        Self { tolerance: 1e-9, solves: 400, factorisations: 4 }
    }
}

with_fields!(TrainOptions { with_tolerance: tolerance as f64 });

/// How a training ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trained {
    /// Largest estimated error over the points that were given.
    pub error: f64,
    /// Whether that is within the tolerance.
    pub converged: bool,
}

/// Real right-hand sides of one round: enough to block the solves, few enough that each round learns from the one before.
pub(super) const SOLVES_PER_ROUND: usize = 8;

/// A residual of which less than this is new among those of its round is left for the next.
const MIN_NEW_SHARE: f64 = 0.1;

/// Solves with the factors there are before another one is worth its price.
const SOLVES_PER_SHIFT: usize = 64;

/// Points whose errors are followed from round to round; all are looked at when these are good.
const MAX_WATCHED_POINTS: usize = 48;

/// Relative errors above this are those of a model that has not yet what the band needs.
const MEANINGLESS_ERROR: f64 = 0.1;

/// Rounds without progress (by a factor of two of the error) after which the rest of the error is roundoff.
pub(super) const MAX_STALLED_ROUNDS: usize = 6;

/// A residual that is wanted in full.
struct Wanted<'p, 'm> {
    point: &'p Point<'m>,
    /// 0: of the response; m + 1: of the m-th sensor's.
    which: usize,
    /// The reduced solution.
    y: Vec<c64>,
    /// Which of its directions are.
    new: Vec<bool>,
}

impl<'m> Subspace<'m> {
    /// S⁻¹F and S⁻¹ℓ_m.
    pub(super) fn start(&mut self) -> Result<(), Breakdown> {
        let sensors = (0..self.experiment.sensors.len()).map(|m| self.experiment.unit_force(m));
        let given: Vec<Vec<c64>> = std::iter::once(self.experiment.load.clone()).chain(sensors).collect();
        let dot = |a: &[f64], b: &[f64]| self.basis.force_dot(a, b);
        let forces: Vec<Vec<f64>> = given.iter().flat_map(|force| real_directions(force, dot)).collect();
        self.solve_and_append(&forces).map(drop)
    }

    /// Grows the basis until the error is within the tolerance at all points.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve fails.
    pub fn train(
        &mut self,
        points: &[Point<'m>],
        options: &TrainOptions,
        for_each: ForEach<'_>,
    ) -> Result<Trained, Breakdown> {
        let all: Vec<usize> = (0..points.len()).collect();
        let assess = |subspace: &Self, of: &[usize]| -> Vec<(f64, usize)> {
            let mut errors: Vec<(f64, usize)> =
                map(for_each, of.len(), |i| (subspace.error_at(&points[of[i]]), of[i]));
            errors.sort_by(|a, b| b.0.total_cmp(&a.0));
            errors
        };
        let (mut best, mut stalled, mut patience) = (f64::INFINITY, 0, self.work.solves + SOLVES_PER_SHIFT);
        let mut errors = assess(self, &all);
        loop {
            if errors.first().is_none_or(|&(worst, _)| worst <= options.tolerance) {
                // Points that were not followed may be far worse: the count of progress starts again.
                errors = assess(self, &all);
                (best, stalled) = (f64::INFINITY, 0);
            }
            let Some(&(worst, at)) = errors.first() else {
                return Ok(Trained { error: 0.0, converged: true });
            };
            let converged = worst <= options.tolerance;
            // As long as nothing is right, errors of one round say nothing of the next.
            stalled = if worst < 0.5 * best || worst > MEANINGLESS_ERROR { 0 } else { stalled + 1 };
            best = best.min(worst);
            if converged
                || stalled > MAX_STALLED_ROUNDS
                || self.work.solves >= options.solves + self.more_solves
            {
                return Ok(Trained { error: worst, converged });
            }
            if self.work.solves >= patience && self.work.factorisations < options.factorisations {
                patience = self.work.solves + SOLVES_PER_SHIFT;
                self.renew_shift(&points[at].at);
            }
            errors.retain(|&(error, _)| error > options.tolerance);
            errors.truncate(MAX_WATCHED_POINTS);
            let floor = 1e-3 * worst;
            let picked: Vec<&Point<'m>> =
                errors.iter().filter(|(error, _)| *error > floor).map(|&(_, i)| &points[i]).collect();
            if self.enrich(&picked)? == 0 {
                return Ok(Trained { error: worst, converged });
            }
            let watched: Vec<usize> = errors.iter().map(|&(_, i)| i).collect();
            errors = assess(self, &watched);
        }
    }

    fn error_at(&self, point: &Point<'m>) -> f64 {
        let nominal = point.at.parameters.first().map_or(c64::default(), |p| p.nominal);
        let error = self
            .projection()
            .assess(&point.at, point.correction)
            .map(|a| a.relative_truncation(nominal + point.correction));
        // A point where the reduced system is singular is an undamped resonance: nothing can be read there.
        error.unwrap_or(0.0)
    }

    /// A real factorisation near the worst frequency in place of the one there is; none where that breaks down.
    fn renew_shift(&mut self, at: &ModelAt<'m>) {
        // Two factors would take twice the memory.
        self.shift.forget_factor();
        self.work.factorisations += 1;
        if let Ok(shift) = Shift::new(at, -omega_rad_s(at.frequency_hz).powi(2)) {
            self.shift = shift;
        }
    }

    /// Adds S⁻¹ times the residuals at the worst points, as far as they are independent; returns how many vectors were new.
    ///
    /// Their sketches show which are; only those that are kept are formed in full.
    fn enrich(&mut self, points: &[&Point<'m>]) -> Result<usize, Breakdown> {
        let mut kept: Vec<Vec<f64>> = Vec::new();
        let (mut wanted, mut count) = (Vec::new(), 0);
        for point in points.iter().take(2 * SOLVES_PER_ROUND) {
            let Ok(solved) = AssessedSolution::new(self.projection(), &point.at, point.correction) else {
                continue;
            };
            let Assessment { truncation, .. } = &solved.assessment;
            let worst = (0..truncation.len()).max_by(|&a, &b| truncation[a].total_cmp(&truncation[b]));
            for which in std::iter::once(0).chain(worst.map(|m| m + 1)) {
                let directions = real_directions(&solved.residuals[which], transpose_dot);
                let new: Vec<bool> = directions.iter().map(|direction| keep(&mut kept, direction)).collect();
                if new.contains(&true) {
                    count += new.iter().filter(|&&new| new).count();
                    wanted.push(Wanted { point, which, y: solved.solutions[which].clone(), new });
                }
            }
            if count >= SOLVES_PER_ROUND {
                break;
            }
        }
        let mut forces = Vec::new();
        for (Wanted { new, .. }, full) in wanted.iter().zip(self.residuals(&wanted)) {
            let directions = real_directions(&full, |a, b| self.basis.force_dot(a, b));
            let new = directions.into_iter().zip(new).filter(|(_, new)| **new);
            forces.extend(new.map(|(force, _)| force));
        }
        self.solve_and_append(&forces)
    }

    /// F − D V y, or ℓ_m − D V z_m for `which` = m + 1, in full; each matrix is met once for all of them.
    fn residuals(&self, wanted: &[Wanted<'_, 'm>]) -> Vec<Vec<c64>> {
        let (n, parts) = (self.model.dim(), &self.projection().parts);
        let of = |w: &Wanted<'_, 'm>, part: fn(&c64) -> f64| w.y.iter().map(part).collect::<Vec<f64>>();
        let y: Vec<f64> = wanted.iter().flat_map(|w| [of(w, |y| y.re), of(w, |y| y.im)]).flatten().collect();
        let x = self.basis.vectors().times(&y);
        let given = |w: &Wanted<'_, 'm>| match w.which.checked_sub(1) {
            None => self.experiment.load.clone(),
            Some(m) => self.experiment.unit_force(m),
        };
        let mut residuals: Vec<Vec<c64>> = wanted.iter().map(given).collect();
        let theta: Vec<Vec<c64>> =
            wanted.iter().map(|w| weights(self.projection(), &w.point.at, w.point.correction).0).collect();
        let mut images = vec![0.0; x.len()];
        for g in 0..parts.len() {
            images.fill(0.0);
            parts.multiply_add(self.model, g, &x, &mut images);
            for ((rest, theta), image) in residuals.iter_mut().zip(&theta).zip(images.chunks_exact(2 * n)) {
                let (re, im) = image.split_at(n);
                let image = re.iter().zip(im).map(|(&re, &im)| c64::new(re, im));
                rest.iter_mut().zip(image).for_each(|(rest, image)| *rest -= theta[g] * image);
            }
        }
        residuals
    }

    /// Solves each force (of norm one), remembers the gain, and adds what is new.
    pub(super) fn solve_and_append(&mut self, forces: &[Vec<f64>]) -> Result<usize, Breakdown> {
        if forces.is_empty() {
            return Ok(0); // nothing was learnt about the gain either
        }
        let mut block = forces.concat();
        self.shift.factor(self.model, &mut self.work)?.solve(&mut block)?;
        self.work.solves += forces.len();
        let sizes = block.chunks_exact(self.model.dim()).map(|x| self.basis.norm(x));
        self.basis.projection.gain = sizes.fold(0.0, f64::max);
        Ok(self.basis.append(self.model, self.experiment, block))
    }
}

/// One or two real vectors of norm one for a complex one: its real part after the rotation of phase that makes that largest, and its imaginary part where
/// that is not small beside it.
pub(super) fn real_directions(complex: &[c64], dot: impl Fn(&[f64], &[f64]) -> f64) -> Vec<Vec<f64>> {
    let re: Vec<f64> = complex.iter().map(|r| r.re).collect();
    let im: Vec<f64> = complex.iter().map(|r| r.im).collect();
    let (aa, bb, ab) = (dot(&re, &re), dot(&im, &im), dot(&re, &im));
    let turn = c64::from_polar(1.0, -0.5 * c64::new(aa - bb, 2.0 * ab).arg());
    let turned = |part: fn(c64) -> f64| complex.iter().map(|&r| part(r * turn)).collect::<Vec<f64>>();
    let mut directions = vec![turned(|r| r.re), turned(|r| r.im)];
    let norms: Vec<f64> = directions.iter().map(|d| dot(d, d).sqrt()).collect();
    directions.truncate(if norms[1] > MIN_NEW_SHARE * norms[0] { 2 } else { 1 });
    directions.retain_mut(|direction| {
        let norm = dot(direction, direction).sqrt();
        direction.iter_mut().for_each(|d| *d /= norm);
        norm > 0.0 && norm.is_finite()
    });
    directions
}

/// Keeps what a vector of norm one has beyond those that are kept already, of norm one; false where that is little.
pub(super) fn keep(kept: &mut Vec<Vec<f64>>, vector: &[f64]) -> bool {
    let mut new = vector.to_vec();
    for other in kept.iter() {
        let overlap = transpose_dot(other, &new);
        new.iter_mut().zip(other).for_each(|(n, o)| *n -= overlap * o);
    }
    let rest = transpose_dot(&new, &new).sqrt();
    new.iter_mut().for_each(|n| *n /= rest);
    let is_new = rest > MIN_NEW_SHARE;
    if is_new {
        kept.push(new);
    }
    is_new
}
