//! A smaller model for a few neighbouring frequencies, from the band's.

use super::assess::AssessedSolution;
use super::{Assessment, Point, Projection};
use crate::c64;
use crate::model::ModelAt;
use frfit_linalg::vector::transpose_dot;

/// Below this part of itself a direction is roundoff of those there are.
const LOCAL_DIRECTION_RTOL: f64 = 1e-12;

/// A compressed model of more than this fraction of the size saves nothing.
const MAX_COMPRESSED_SHARE: f64 = 0.6;

/// A local error of this many times the band's own is the band's.
const MAX_LOCAL_ERROR_RATIO: f64 = 3.0;

impl Projection {
    /// This model on the span of its own solutions at some of the points, as many as bring the estimated error at all of them under the tolerance, or
    /// near this model's own: a neighbourhood needs fewer vectors than a band. The same model where that is not so.
    ///
    /// # Limits
    /// Its [`Projection::assess`] estimates errors of the full model, not of this one.
    pub fn localised(&self, points: &[Point<'_>], tolerance: f64) -> Self {
        self.localised_with(points, tolerance, &[]).map_or_else(|| self.clone(), |(local, _)| local)
    }

    /// The same with some vectors in the span, and the coordinates W (r × q, column after column) of its basis VW; `None` where it would be no smaller.
    pub(super) fn localised_with(
        &self,
        points: &[Point<'_>],
        tolerance: f64,
        vectors: &[Vec<f64>],
    ) -> Option<(Self, Vec<f64>)> {
        let relative = |solved: &Assessment, point: &Point<'_>| {
            let nominal = point.at.parameters.first().map_or(c64::default(), |p| p.nominal);
            solved.relative_truncation(nominal + point.correction)
        };
        let mut directions = Vec::new();
        vectors.iter().for_each(|vector| append_real(&mut directions, vector.clone()));
        let mut done = vec![false; points.len()];
        let all: Vec<usize> = (0..points.len()).collect();
        let mut watched = all.clone();
        // Ends and middle first; then where it is worst.
        let mut next: Vec<(usize, f64)> =
            [0, points.len() / 2, points.len().saturating_sub(1)].map(|i| (i, f64::INFINITY)).into();
        loop {
            for (i, error) in next.drain(..).filter(|&(i, _)| i < points.len()) {
                let point = &points[i];
                if !std::mem::replace(&mut done[i], true)
                    && let Ok(solved) = AssessedSolution::new(self, &point.at, point.correction)
                    && error > MAX_LOCAL_ERROR_RATIO * relative(&solved.assessment, point)
                {
                    solved.solutions.iter().for_each(|y| append(&mut directions, y));
                }
            }
            if directions.is_empty() || directions.len() as f64 > MAX_COMPRESSED_SHARE * self.size as f64 {
                return None;
            }
            let basis = directions.concat();
            let local = self.compressed(&basis);
            let error = |i: usize| {
                let assessed = local.assess(&points[i].at, points[i].correction);
                assessed.map_or(f64::INFINITY, |assessed| relative(&assessed, &points[i]))
            };
            let lacking = |of: &[usize]| -> Vec<(usize, f64)> {
                let rest = of.iter().filter(|&&i| !done[i]).map(|&i| (i, error(i)));
                rest.filter(|(_, error)| *error > tolerance).collect()
            };
            // Those that were good are, most of them: all are looked at when no other is left.
            let mut bad = lacking(&watched);
            if bad.is_empty() {
                bad = lacking(&all);
            }
            match bad.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
                Some(&worst) => next.push(worst),
                None => return Some((local, basis)),
            }
            watched = bad.into_iter().map(|(i, _)| i).collect();
        }
    }
}

impl Projection {
    /// This model on the span of x, of every sensor's z_m and of their slopes by every parameter at the nominal values: response and slopes are exact there, and since residuals of
    /// x and of z_m are of second order, what they are off nearby is of fourth. `None` where the system is singular, where nothing responds, or where no vector would be saved.
    pub fn about(&self, at: &ModelAt<'_>) -> Option<Self> {
        let solutions = self.solutions_with_slopes(at).ok()?;
        let mut directions = Vec::new();
        for y in &solutions {
            append(&mut directions, y);
            if directions.len() as f64 > MAX_COMPRESSED_SHARE * self.size as f64 {
                return None;
            }
        }
        (!directions.is_empty()).then(|| self.compressed(&directions.concat()))
    }
}

/// The real and the imaginary part of y, orthonormalised.
fn append(directions: &mut Vec<Vec<f64>>, y: &[c64]) {
    for part in [|y: &c64| y.re, |y: &c64| y.im] {
        append_real(directions, y.iter().map(part).collect());
    }
}

fn append_real(directions: &mut Vec<Vec<f64>>, mut x: Vec<f64>) {
    let length = |x: &[f64]| transpose_dot(x, x).sqrt();
    let before = length(&x);
    for _ in 0..2 {
        for v in directions.iter() {
            let overlap = transpose_dot(v, &x);
            x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
        }
    }
    let rest = length(&x);
    if rest > LOCAL_DIRECTION_RTOL * before {
        x.iter_mut().for_each(|x| *x /= rest);
        directions.push(x);
    }
}
