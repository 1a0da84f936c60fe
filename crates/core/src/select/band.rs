//! The candidates of a whole band, paths through it in both directions, and what they say about each candidate.

use super::path::{Path, Point, Rule, cheapest, paths};

/// Sizes of curvature that are tried. Fractional laws stay below 0.2, a sharp relaxation reaches 1; below the last all is straight.
const CURVATURES: [f64; 7] = [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01];

/// Before anything is known of a path's curvature. Not taken from the straightest path there is: that may well be a wrong one.
pub(super) const CURVATURE: f64 = 0.5;

/// −ln likelihood of the cheapest path.
fn likelihood(paths: &[Vec<Path>]) -> f64 {
    cheapest(paths).map_or(0.0, |(path, _)| path.cost)
}

/// Points over a band.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// ln ω but for a constant.
    pub(super) log_frequency: Vec<f64>,
    /// The candidates at each frequency.
    pub(super) points: Vec<Vec<Point>>,
}

impl Band {
    /// That of several which makes its cheapest path likeliest: the same candidates, with more or less scatter allowed.
    pub(super) fn likeliest(bands: impl Iterator<Item = Self>) -> Option<Self> {
        let cost = |band: &Self| likelihood(&band.forward(Rule { curvature: CURVATURE, spread: true }));
        let costs = bands.map(|band| (cost(&band), band));
        costs.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, band)| band)
    }

    /// κ of largest likelihood, and one size more: what is too stiff for the right path skips it. For a band of one path.
    pub(super) fn curvature(&self) -> f64 {
        let cost = |&curvature: &f64| likelihood(&self.forward(Rule { curvature, spread: true }));
        let costs: Vec<f64> = CURVATURES.iter().map(cost).collect();
        let best = (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
        CURVATURES[best.saturating_sub(1)]
    }

    /// The cheapest path, and the point that it chooses at each frequency.
    pub(super) fn cheapest(&self, curvature: f64) -> Option<(Path, Vec<Option<usize>>)> {
        cheapest(&self.forward(Rule { curvature, spread: false }))
    }

    /// For each candidate the cost of the best path through it (min-marginals, by a pass from either end).
    ///
    /// # Limits
    /// Of the paths that were kept; a candidate that none of them meets has its cost from the nearest.
    pub(super) fn costs(&self, curvature: f64) -> Vec<Vec<f64>> {
        let rule = Rule { curvature, spread: false };
        let forward = self.forward(rule);
        let backward = self.backward(rule);
        let mut costs = Vec::with_capacity(forward.len());
        for (k, before) in forward.iter().enumerate() {
            let after: Vec<Path> = match backward.get(k + 1) {
                None => vec![Path::START],
                Some(paths) => paths.iter().map(|path| path.advanced(-self.step(k + 1), curvature)).collect(),
            };
            let mut best = vec![f64::INFINITY; self.points[k].len()];
            for (path, chosen) in before.iter().filter_map(|path| Some((path, path.chosen?))) {
                for other in &after {
                    best[chosen] = best[chosen].min(path.with(other));
                }
            }
            costs.push(best);
        }
        costs
    }

    /// Step in ln ω from the frequency before.
    fn step(&self, k: usize) -> f64 {
        if k == 0 { 0.0 } else { self.log_frequency[k] - self.log_frequency[k - 1] }
    }

    fn forward(&self, rule: Rule) -> Vec<Vec<Path>> {
        paths((0..self.points.len()).map(|k| (self.step(k), &self.points[k][..])), rule)
    }

    /// From the other end, in the order of frequencies.
    fn backward(&self, rule: Rule) -> Vec<Vec<Path>> {
        let count = self.points.len();
        let step = |k: usize| if k + 1 == count { 0.0 } else { -self.step(k + 1) };
        let mut all = paths((0..count).rev().map(|k| (step(k), &self.points[k][..])), rule);
        all.reverse();
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::c64;

    /// A straight line through the first half of a band, strays everywhere: both passes together must see what one sees from its end,
    /// although nothing lies in the second half that the line could start from.
    #[test]
    fn passes_from_both_ends_agree_with_one() {
        let point =
            |node: usize, log: f64| Point { node, log: c64::new(log, 0.1), variance: 1e-8, misfit: 0.0 };
        // Never where the line could go on.
        let stray =
            |k: usize, i: usize| (0.5 + ((7 * k + 13 * i) as f64 * 0.618).fract()) * [-1.0, 1.0][i % 2];
        let at = |k: usize| {
            let mut points: Vec<Point> = (1..20).map(|i| point(i, stray(k, i))).collect();
            if k < 30 {
                points.push(point(0, 0.0));
            }
            points
        };
        let band = Band {
            log_frequency: (0..60).map(|k| 0.02 * k as f64).collect(),
            points: (0..60).map(at).collect(),
        };
        let (path, chosen) = band.cheapest(CURVATURE).unwrap();
        let costs = band.costs(CURVATURE);
        for k in 0..30 {
            assert_eq!(chosen[k], Some(19), "{k}");
            // What is known of a slope beforehand counts on both sides of the seam.
            assert!((costs[k][19] - path.cost).abs() < 0.5, "{k}: {} against {}", costs[k][19], path.cost);
            assert!(costs[k][..19].iter().all(|cost| cost - path.cost > -0.5), "{k}");
        }
    }
}
