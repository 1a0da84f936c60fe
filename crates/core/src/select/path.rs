//! Paths through the candidates in one direction; of those that end alike the best few are kept.

use super::trend::Trend;
use crate::c64;

/// A candidate as the search sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// Its index among the nodes.
    pub(super) node: usize,
    /// ln E.
    pub(super) log: c64,
    /// Variance of real and imaginary part of ln E.
    pub(super) variance: f64,
    /// Nats that the other sensors hold against it, beyond what a solution has on average.
    pub(super) misfit: f64,
}

impl Point {
    /// Whether two are one solution, as far as each is known.
    pub(super) fn is(&self, other: &Self) -> bool {
        (self.log - other.log).norm_sqr() <= 4.0 * self.variance.max(other.variance)
    }
}

/// A path as far as one frequency.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    /// What it costs so far, in nats.
    pub(super) cost: f64,
    /// The part of it that says that this is no material.
    pub(super) material: f64,
    /// The part of it that the other sensors have.
    pub(super) misfit: f64,
    /// Beside it: what says how well its points were expected, relative to points that may be anywhere. With the cost it is the likelihood of the
    /// sizes of scatter and curvature. Not a part of the cost: solutions next to a pole lie on smooth branches that no noise moves.
    pub(super) spread: f64,
    /// What is known of the curve here; `None` where nothing has been chosen yet.
    pub(super) trend: Option<Trend>,
    /// The point chosen at this frequency.
    pub(super) chosen: Option<usize>,
    /// Step and point that were chosen last.
    last: Option<(usize, usize)>,
    /// Number of points chosen.
    pub(super) count: usize,
    /// Whether none was chosen at the last frequency that has any.
    gap: bool,
    /// Index of the path that it continues, among those of the frequency before.
    pub(super) parent: usize,
}

impl Path {
    /// Before the first frequency.
    pub(super) const START: Self = Self {
        cost: 0.0,
        material: 0.0,
        misfit: 0.0,
        spread: 0.0,
        trend: None,
        chosen: None,
        last: None,
        count: 0,
        gap: false,
        parent: 0,
    };

    /// Carried a step further.
    pub(super) fn advanced(self, step: f64, curvature: f64) -> Self {
        Self { trend: self.trend.map(|trend| trend.advanced(step, curvature)), ..self }
    }

    /// What this path, which has chosen a point here, and one from the other end of the band cost together.
    pub(super) fn with(&self, other: &Self) -> f64 {
        self.cost + other.cost + self.trend.zip(other.trend).map_or(0.0, |(a, b)| a.apart(&b))
    }

    /// What this path costs with a point, but for what says that it is no material: not more than it does cost.
    fn cost_with(&self, point: &Point) -> f64 {
        let surprise = self.trend.map_or(0.0, |trend| trend.surprise(point.log, point.variance));
        self.cost + point.misfit + surprise
    }

    /// With a point, which [`Self::cost_with`] has the cost of.
    fn through(&self, index: usize, point: &Point, cost: f64, step: f64, at: usize) -> Self {
        let (material, trend) = match self.trend {
            None => (0.0, Trend::start(point.log, point.variance)),
            Some(trend) => trend.joined(point.log, point.variance).as_material(step),
        };
        Self {
            cost: cost + material,
            material: self.material + material,
            misfit: self.misfit + point.misfit,
            spread: self.spread + self.trend.map_or(0.0, |trend| trend.spread(point.variance)),
            trend: Some(trend),
            chosen: Some(index),
            last: Some((at, index)),
            count: self.count + 1,
            gap: false,
            ..*self
        }
    }

    fn past(&self, empty: bool) -> Self {
        let cost = match (empty, self.gap) {
            (true, _) => 0.0,
            (false, false) => GAP_NATS,
            (false, true) => SKIP_NATS,
        };
        Self { cost: self.cost + cost, chosen: None, gap: self.gap || !empty, ..*self }
    }
}

/// Cost of choosing nothing where there are candidates: one solution in 400 is not found …
const GAP_NATS: f64 = 6.0;

/// … and if one is not, the next is likely not to be either. A right point costs one nat on average and must be cheaper than none.
const SKIP_NATS: f64 = 4.0;

/// Paths kept that end in one point, each by way of another.
const PATHS_PER_POINT: usize = 4;

/// Paths kept that choose nothing at a frequency, each with another last point; through a gap all histories are such.
const PATHS_IN_GAP: usize = 16;

/// The best paths up to and including a frequency, one frequency after the other.
#[derive(Debug, Clone)]
pub(super) struct Search {
    /// κ: size of the curvature d² ln E/d(ln ω)².
    curvature: f64,
    /// Frequencies so far.
    at: usize,
    now: Vec<Path>,
    /// Those of the frequency before.
    before: Vec<Path>,
}

impl Search {
    /// Before the first frequency.
    pub(super) fn new(curvature: f64) -> Self {
        Self { curvature, at: 0, now: vec![Path::START], before: Vec::new() }
    }

    /// The best paths so far.
    pub(super) fn paths(&self) -> &[Path] {
        &self.now
    }

    /// One frequency on: the step in ln ω that leads there, and the points there.
    pub(super) fn advance(&mut self, step: f64, points: &[Point]) {
        std::mem::swap(&mut self.now, &mut self.before);
        for (parent, path) in self.before.iter_mut().enumerate() {
            *path = Path { parent, ..path.advanced(step, self.curvature) };
        }
        self.now.clear();
        for (index, point) in points.iter().enumerate() {
            keep_best(&self.before, PATHS_PER_POINT, &mut self.now, |path, limit| {
                let cost = path.cost_with(point);
                (cost < limit).then(|| path.through(index, point, cost, step, self.at))
            });
        }
        keep_best(&self.before, PATHS_IN_GAP, &mut self.now, |path, _| Some(path.past(points.is_empty())));
        self.at += 1;
    }

    /// The cheapest path so far, by its place.
    pub(super) fn cheapest(&self) -> Option<usize> {
        (0..self.now.len()).min_by(|&a, &b| self.now[a].cost.total_cmp(&self.now[b].cost))
    }
}

/// Of what becomes of each path the cheapest of each history (what was chosen last before), and of those the cheapest; the one that has chosen nothing so far
/// stays, for it alone can start again. What costs more than a limit may be left out: most do, and are not looked at closely.
fn keep_best(
    before: &[Path],
    count: usize,
    kept: &mut Vec<Path>,
    further: impl Fn(&Path, f64) -> Option<Path>,
) {
    let first = kept.len();
    let (mut anew, mut limit) = (None, f64::INFINITY);
    for path in before {
        let Some(history) = path.last else {
            anew = further(path, f64::INFINITY);
            continue;
        };
        let Some(new) = further(path, limit).filter(|new| new.cost < limit) else { continue };
        match kept[first..].iter_mut().find(|other| before[other.parent].last == Some(history)) {
            Some(same) if new.cost < same.cost => *same = new,
            Some(_) => continue,
            None => kept.push(new),
        }
        if kept.len() - first >= count {
            let own = &mut kept[first..];
            own.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            limit = own[count - 1].cost;
            kept.truncate(first + count);
        }
    }
    kept[first..].sort_by(|a, b| a.cost.total_cmp(&b.cost));
    if let Some(anew) = anew {
        let place = kept[first..].partition_point(|other| other.cost <= anew.cost);
        if place < count {
            kept.truncate(first + count - 1);
        }
        kept.insert(first + place, anew);
    }
}
