//! A basis that is good for derivatives too: at the sensors, and where wanted everywhere.

use super::train::{MAX_STALLED_ROUNDS, SOLVES_PER_ROUND, keep, real_directions};
use super::{ChangePoint, Changed, Point, Subspace, TrainOptions, Trained};
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::with_fields::with_fields;
use frfit_linalg::solve::Breakdown;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ChangeOptions {
    /// Largest estimated error of a derivative at a sensor ([`Changed::relative_truncation`]) to accept. Default 1e-6: error bars are read to two digits, and what
    /// parameters have in common differs from what they have not by as little.
    pub tolerance: f64,
    /// Largest estimated error of response and derivatives everywhere ([`Changed::everywhere`]) to accept; `None` (default): it does not matter.
    pub everywhere: Option<f64>,
}

impl Default for ChangeOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, everywhere: None }
    }
}

with_fields!(ChangeOptions { with_tolerance: tolerance as f64, with_everywhere: everywhere as Option<f64> });

/// Solves after which to give up.
const MAX_SOLVES: usize = 600;

/// Errors of the response that are asked for in turn: those of derivatives are products of a residual of the response and one of its derivative, which
/// the basis need not have.
const RESPONSE_TOLS: [f64; 4] = [1e-8, 1e-10, 1e-12, 1e-14];

impl<'m> Subspace<'m> {
    /// Grows the basis until response and derivatives are within the tolerance at all points; returns the largest estimated error of a derivative at a sensor.
    ///
    /// # Errors
    /// [`Breakdown`] where a solve fails.
    pub fn train_changes(
        &mut self,
        points: &[ChangePoint<'m>],
        options: &ChangeOptions,
        for_each: ForEach<'_>,
    ) -> Result<Trained, Breakdown> {
        let plain: Vec<Point<'m>> =
            points.iter().map(|p| Point { at: p.at.clone(), correction: c64::default() }).collect();
        let mut trained = Trained { error: f64::INFINITY, converged: false };
        for tolerance in RESPONSE_TOLS {
            let train = TrainOptions { tolerance, solves: MAX_SOLVES, ..TrainOptions::default() };
            let response = self.train(&plain, &train, for_each)?;
            let error = self.worst(points, for_each, Changed::relative_truncation);
            trained = Trained { error, converged: error <= options.tolerance };
            if trained.converged || !response.converged {
                break;
            }
        }
        if let Some(everywhere) = options.everywhere {
            self.train_everywhere(points, everywhere, for_each)?;
            let error = self.worst(points, for_each, Changed::relative_truncation);
            trained = Trained { error, converged: error <= options.tolerance };
        }
        Ok(trained)
    }

    fn worst(
        &self,
        points: &[ChangePoint<'m>],
        for_each: ForEach<'_>,
        of: impl Fn(&Changed) -> f64 + Sync,
    ) -> f64 {
        // Where the reduced system is singular is an undamped resonance: nothing can be read there.
        let at = |i: usize| self.projection().changes(&points[i]).map_or(0.0, |changed| of(&changed));
        map(for_each, points.len(), at).into_iter().fold(0.0, f64::max)
    }

    /// Adds S⁻¹ times the residuals of the response and of its derivatives, where these are largest.
    fn train_everywhere(
        &mut self,
        points: &[ChangePoint<'m>],
        tolerance: f64,
        for_each: ForEach<'_>,
    ) -> Result<(), Breakdown> {
        let (mut best, mut stalled) = (f64::INFINITY, 0);
        loop {
            let of = |i: usize| -> Vec<(f64, usize, usize)> {
                let changed = self.projection().changes(&points[i]);
                let everywhere = changed.map_or(Vec::new(), |changed| changed.everywhere);
                everywhere.into_iter().enumerate().map(|(which, error)| (error, i, which)).collect()
            };
            let mut errors: Vec<(f64, usize, usize)> =
                map(for_each, points.len(), of).into_iter().flatten().collect();
            errors.retain(|(error, ..)| *error > tolerance);
            errors.sort_by(|a, b| b.0.total_cmp(&a.0));
            let Some(&(worst, ..)) = errors.first() else { return Ok(()) };
            stalled = if worst < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(worst);
            if stalled > MAX_STALLED_ROUNDS
                || self.work().solves >= MAX_SOLVES
                || self.grow(points, &errors)? == 0
            {
                return Ok(());
            }
        }
    }

    /// One round, of the worst residuals as far as they are independent; returns how many vectors were new.
    fn grow(
        &mut self,
        points: &[ChangePoint<'m>],
        errors: &[(f64, usize, usize)],
    ) -> Result<usize, Breakdown> {
        let (mut kept, mut forces) = (Vec::new(), Vec::new());
        for &(_, i, which) in errors.iter().take(4 * SOLVES_PER_ROUND) {
            let Ok(changed) = self.projection().changes(&points[i]) else { continue };
            let residual = self.residual_elsewhere(&points[i], &changed, which);
            let dot = |a: &[f64], b: &[f64]| self.basis.force_dot(a, b);
            for direction in real_directions(&residual, dot) {
                // In coordinates in which the product of forces is the plain one.
                let scaled = self.basis.plain_force(&direction);
                if forces.len() < SOLVES_PER_ROUND && keep(&mut kept, &scaled) {
                    forces.push(direction);
                }
            }
            if forces.len() >= SOLVES_PER_ROUND {
                break;
            }
        }
        self.solve_and_append(&forces)
    }

    /// F − D V y, or −A_p V y − D V y_p for `which` = p + 1, in full.
    fn residual_elsewhere(&self, point: &ChangePoint<'m>, changed: &Changed, which: usize) -> Vec<c64> {
        let minus = c64::new(-1.0, 0.0);
        let full = |k: usize| self.basis.vectors().combine(&changed.coordinates[k]);
        let mut residual = match which.checked_sub(1) {
            None => self.experiment.load.clone(),
            Some(p) => {
                let mut force = vec![c64::default(); self.model.dim()];
                point.changes[p].multiply_add(self.model, minus, &full(0), &mut force);
                force
            }
        };
        point.at.nominal.multiply_add(self.model, minus, &full(which), &mut residual);
        residual
    }

    /// V at some rows of the model, column after column: the reduced model's answer at any place is this times coordinates.
    ///
    /// # Panics
    /// Where there is no such row.
    pub fn rows(&self, rows: &[usize]) -> Vec<f64> {
        let vectors = self.basis.vectors();
        (0..vectors.ncols()).flat_map(|j| rows.iter().map(move |&row| vectors.column(j)[row])).collect()
    }
}
