//! The candidates of a whole band, paths through it in both directions, and what they say about each candidate.

use super::path::{Path, Point, Search};

/// Sizes of curvature that are tried. Fractional laws stay below 0.2, a sharp relaxation reaches 1; below the last all is straight.
const CURVATURES: [f64; 7] = [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01];

/// Before anything is known of a path's curvature. Not taken from the straightest path there is: that may well be a wrong one.
pub(super) const DEFAULT_CURVATURE: f64 = 0.5;

/// A path that covers at least this share of the frequencies with points covers the band.
const MIN_COVERED_SHARE: f64 = 0.85;

/// In the likelihood of sizes the cost of not being a material counts once for so many frequencies. Counted once for the band it would lose against solutions beside
/// poles: noise does not move their branches, so they win some ten nats at each frequency where no scatter is allowed.
const FREQUENCIES_PER_MATERIAL: f64 = 30.0;

/// Points over a band.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// ln ω but for a constant.
    pub(super) log_frequency: Vec<f64>,
    /// The candidates at each frequency.
    pub(super) points: Vec<Vec<Point>>,
}

impl Band {
    /// That of several bands(b, every) of every so-many-th frequency which makes its cheapest path likeliest: the same candidates, with more or less scatter
    /// allowed, least first.
    pub(super) fn likeliest(count: usize, frequencies: usize, band: impl Fn(usize, usize) -> Self) -> Self {
        band(lowest(count, frequencies, |b, every| band(b, every).likelihood(DEFAULT_CURVATURE, 1)), 1)
    }

    /// κ of largest likelihood, and one size more: what is too stiff for the right path skips it. For a band of one path.
    pub(super) fn curvature(&self) -> f64 {
        let cost = |k: usize, every: usize| self.likelihood(CURVATURES[k], every);
        CURVATURES[lowest(CURVATURES.len(), self.points.len(), cost).saturating_sub(1)]
    }

    /// Whether a path has a point at most of the frequencies that have any.
    pub(super) fn is_covered<T>(&self, path: &[Option<T>]) -> bool {
        let count = path.iter().flatten().count() as f64;
        count >= MIN_COVERED_SHARE * self.occupied() as f64
    }

    /// Frequencies that have any points.
    pub(super) fn occupied(&self) -> usize {
        self.points.iter().filter(|points| !points.is_empty()).count()
    }

    /// The cheapest path, and the point that it chooses at each frequency.
    pub(super) fn cheapest(&self, curvature: f64) -> Option<(Path, Vec<Option<usize>>)> {
        // Of the ways that lead to each path no more than this is kept: a band has thousands of frequencies.
        let mut ways: Vec<Vec<(Option<usize>, usize)>> = Vec::with_capacity(self.points.len());
        let mut search = Search::new(curvature);
        for (k, points) in self.points.iter().enumerate() {
            search.advance(self.step(k), points);
            ways.push(search.paths().iter().map(|path| (path.chosen, path.parent)).collect());
        }
        let mut at = search.cheapest()?;
        let whole = search.paths()[at];
        let mut chosen = vec![None; ways.len()];
        for (own, ways) in chosen.iter_mut().zip(&ways).rev() {
            (*own, at) = ways[at];
        }
        Some((whole, chosen))
    }

    /// The point that the cheapest path chooses at each frequency, and for each candidate the cost of the best path through it (min-marginals, by a pass from
    /// either end). The pass from the first frequency keeps where it was before each stretch, and makes the paths of one stretch at a time again: those of a hundred
    /// thousand frequencies would not fit.
    ///
    /// # Limits
    /// Of the paths that were kept; a candidate that none of them meets has its cost from the nearest.
    pub(super) fn through_each(&self, curvature: f64) -> (Vec<Option<usize>>, Vec<Vec<f64>>) {
        let n = self.points.len();
        let stretch = (n as f64).sqrt().ceil().max(1.0) as usize;
        let mut search = Search::new(curvature);
        // Before the first frequency of each stretch.
        let mut starts: Vec<Search> = Vec::with_capacity(n.div_ceil(stretch));
        for k in 0..n {
            if k % stretch == 0 {
                starts.push(search.clone());
            }
            search.advance(self.step(k), &self.points[k]);
        }
        let mut chosen = vec![None; n];
        let mut at = search.cheapest();
        let mut costs: Vec<Vec<f64>> =
            self.points.iter().map(|points| vec![f64::INFINITY; points.len()]).collect();
        let mut backward = Search::new(curvature);
        // What is beyond the last frequency starts there.
        let mut step = 0.0;
        for (s, mut search) in starts.into_iter().enumerate().rev() {
            let own = s * stretch..((s + 1) * stretch).min(n);
            let paths_after = |k: usize| {
                search.advance(self.step(k), &self.points[k]);
                search.paths().to_vec()
            };
            let forward: Vec<Vec<Path>> = own.clone().map(paths_after).collect();
            for (k, before) in own.zip(&forward).rev() {
                let way = at.map(|at| before[at]);
                (chosen[k], at) = (way.and_then(|way| way.chosen), way.map(|way| way.parent));
                let after: Vec<Path> =
                    backward.paths().iter().map(|path| path.advanced(step, curvature)).collect();
                for (path, chosen) in before.iter().filter_map(|path| Some((path, path.chosen?))) {
                    for other in &after {
                        costs[k][chosen] = costs[k][chosen].min(path.with(other));
                    }
                }
                backward.advance(step, &self.points[k]);
                step = -self.step(k);
            }
        }
        (chosen, costs)
    }

    /// Step in ln ω from the frequency before.
    fn step(&self, k: usize) -> f64 {
        if k == 0 { 0.0 } else { self.log_frequency[k] - self.log_frequency[k - 1] }
    }

    /// −ln likelihood of the cheapest path through every so-many-th frequency.
    fn likelihood(&self, curvature: f64, every: usize) -> f64 {
        let mut search = Search::new(curvature);
        for k in (0..self.points.len()).step_by(every) {
            let step = if k == 0 { 0.0 } else { self.log_frequency[k] - self.log_frequency[k - every] };
            search.advance(step, &self.points[k]);
        }
        search.cheapest().map_or(0.0, |cheapest| {
            let path = &search.paths()[cheapest];
            let more = ((self.points.len() / every) as f64 / FREQUENCIES_PER_MATERIAL - 1.0).max(0.0);
            path.cost + path.spread + more * path.material
        })
    }
}

/// So many frequencies determine sizes of scatter and curvature, which are tried in steps of two and more: of longer bands not every frequency is looked at.
const MAX_SIZE_FREQUENCIES: usize = 2000;

/// … first at so many of them: what holds for them holds for more, or on a neighbouring size.
const FIRST_SIZE_FREQUENCIES: usize = 500;

/// The place of the lowest of some costs(k, every) over every so-many-th frequency, k = 0 … count − 1, that fall towards one and rise from there on: of a
/// long band first that on a small part, from which it goes downhill on a larger one.
fn lowest(count: usize, frequencies: usize, cost: impl Fn(usize, usize) -> f64) -> usize {
    let least = |every: usize| {
        let costs: Vec<f64> = (0..count).map(|k| cost(k, every)).collect();
        (0..count).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0)
    };
    if frequencies <= MAX_SIZE_FREQUENCIES {
        return least(1);
    }
    let mut best = least(frequencies / FIRST_SIZE_FREQUENCIES);
    let mut costs = vec![None; count];
    let mut larger = |k: usize| *costs[k].get_or_insert_with(|| cost(k, frequencies / MAX_SIZE_FREQUENCIES));
    loop {
        let beside = [best.checked_sub(1), Some(best + 1).filter(|&k| k < count)];
        match beside.into_iter().flatten().find(|&k| larger(k) < larger(best)) {
            Some(lower) => best = lower,
            None => return best,
        }
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
        let (path, chosen) = band.cheapest(DEFAULT_CURVATURE).unwrap();
        let (again, costs) = band.through_each(DEFAULT_CURVATURE);
        assert_eq!(again, chosen);
        for k in 0..30 {
            assert_eq!(chosen[k], Some(19), "{k}");
            // What is known of a slope beforehand counts on both sides of the seam.
            assert!((costs[k][19] - path.cost).abs() < 0.5, "{k}: {} against {}", costs[k][19], path.cost);
            assert!(costs[k][..19].iter().all(|cost| cost - path.cost > -0.5), "{k}");
        }
    }

    /// A power law with some scatter and strays beside it, 6000 frequencies: the sizes of scatter and curvature found from a part of the band first are those of
    /// largest likelihood on all of it.
    #[test]
    fn a_part_of_a_long_band_leads_to_what_is_likeliest_on_the_whole() {
        let n = 6000;
        let sizes = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2];
        for (scatter, bend) in [(2e-5, 0.0), (5e-4, 0.1), (4e-3, 0.4)] {
            let log_frequency: Vec<f64> = (0..n).map(|k| (1.0 + 9.0 * k as f64 / n as f64).ln()).collect();
            let random = |k: usize| ((k * k) as f64 * 0.618_034).fract() - 0.5;
            let at = |k: usize, size: f64| {
                let x = log_frequency[k];
                let level = c64::new(0.1 * x + 0.5 * bend * x * x, 0.2);
                let point = |node: usize, log: c64| Point { node, log, variance: size * size, misfit: 0.0 };
                let off = 3.5 * scatter * c64::new(random(k), random(k + n));
                vec![point(0, level + off), point(1, c64::new(2.0 * x - 1.0 + random(7 * k), 0.1))]
            };
            let band = |s: usize, every: usize| Band {
                log_frequency: log_frequency.iter().step_by(every).copied().collect(),
                points: (0..n).step_by(every).map(|k| at(k, sizes[s])).collect(),
            };
            let lowest =
                |costs: Vec<f64>| (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap();
            let best =
                lowest((0..sizes.len()).map(|s| band(s, 1).likelihood(DEFAULT_CURVATURE, 1)).collect());
            let found = Band::likeliest(sizes.len(), n, band);
            assert_eq!(found.points[0][0].variance, sizes[best].powi(2), "{scatter}");
            let costs = CURVATURES.iter().map(|&curvature| found.likelihood(curvature, 1));
            assert_eq!(found.curvature(), CURVATURES[lowest(costs.collect()).saturating_sub(1)], "{scatter}");
        }
    }
}
