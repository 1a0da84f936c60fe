//! A smaller model for a few neighbouring frequencies, from the band's.

use super::assess::Solved;
use super::{Point, Projection};
use crate::c64;

/// Below this part of itself a direction is roundoff of those there are.
const NEW: f64 = 1e-12;

/// A compressed model of more than this fraction of the size saves nothing.
const WORTHWHILE: f64 = 0.6;

impl Projection {
    /// This model on the span of its own solutions at some of the points, as many as bring the estimated error at all of them under the tolerance:
    /// a neighbourhood needs fewer vectors than a band. The same model where that is not so.
    ///
    /// # Limits
    /// Its [`Projection::assess`] tells errors of the full model, not of this one.
    pub fn localised(&self, points: &[Point<'_>], tolerance: f64) -> Self {
        let mut directions = Vec::new();
        let mut sampled = vec![false; points.len()];
        // Ends and middle first; then where it is worst.
        let mut next: Vec<usize> = vec![0, points.len() / 2, points.len().saturating_sub(1)];
        loop {
            for i in next.drain(..).filter(|&i| i < points.len()) {
                if !std::mem::replace(&mut sampled[i], true)
                    && let Ok(solved) = Solved::new(self, &points[i].at, points[i].correction)
                {
                    solved.solutions.iter().for_each(|y| append(&mut directions, y));
                }
            }
            if directions.is_empty() || directions.len() as f64 > WORTHWHILE * self.size as f64 {
                return self.clone();
            }
            let local = self.compressed(&directions.concat());
            let error = |i: usize| {
                let nominal = points[i].at.parameters.first().map_or(c64::default(), |p| p.nominal);
                let assessed = local.assess(&points[i].at, points[i].correction);
                assessed.map_or(f64::INFINITY, |a| a.relative_truncation(nominal + points[i].correction))
            };
            let rest = (0..points.len()).filter(|&i| !sampled[i]).map(|i| (error(i), i));
            match rest.max_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((worst, i)) if worst > tolerance => next.push(i),
                _ => return local,
            }
        }
    }
}

/// The real and the imaginary part of y, orthonormalised.
fn append(directions: &mut Vec<Vec<f64>>, y: &[c64]) {
    for part in [|y: &c64| y.re, |y: &c64| y.im] {
        let mut x: Vec<f64> = y.iter().map(part).collect();
        let length = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let before = length(&x);
        for _ in 0..2 {
            for v in directions.iter() {
                let overlap: f64 = v.iter().zip(&x).map(|(v, x)| v * x).sum();
                x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
            }
        }
        let rest = length(&x);
        if rest > NEW * before {
            x.iter_mut().for_each(|x| *x /= rest);
            directions.push(x);
        }
    }
}
