//! The joint choice among exact solutions over a band, B-4: which of them are one material, and where the data cannot decide.
//!
//! A solution at one frequency can match the measured response to the last digit and be the wrong modulus; wrong ones form smooth
//! branches too. The choice minimises over all paths through the band, and over leaving out what fits none,
//! $$ \sum_k \Big( \tfrac 1 2 \chi_k^2 + \frac{|\ln E_k - \hat L_k|^2}{2 \sigma_k^2} + \text{material}_k \Big) + \text{gaps}, $$
//! where L̂_k is what the path so far predicts: a curve of ln E over ln ω with a curvature of the size κ, which is fitted to the band. A
//! material's slope is tied to its loss by causality; wrong branches, on which about ω²/E is constant, break that tie.
//!
//! | file | contents |
//! |---|---|
//! | `agreement` | what several sensors agree on, where no material explains it |
//! | `trend` | what a path knows of its curve, and what it expects next |
//! | `path` | the search in one direction (dynamic programming over the last point, with gaps) |
//! | `band` | both directions together: the best path through each candidate |
//! | `track` | whole paths that compete: not the longest wins, but the one that is a material |

mod agreement;
mod band;
mod path;
mod track;
mod trend;

use crate::c64;
use crate::frequency::omega_rad_s;
use crate::with_fields::with_fields;
use agreement::agreement;
use band::Band;
use path::Point;
use track::tracks;
pub(crate) use trend::{SLOPE_TOLERANCE, slope_of_material};

/// A solution at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The factor p̄ + c.
    pub factor: c64,
    /// χ² = Σ_m |u_m − x_m|²/σ_m² over the sensors, σ_m the standard deviation of real and imaginary part each; 0 where one sensor
    /// is matched exactly.
    pub misfit: f64,
    /// Standard deviation of the factor's real and imaginary part each; 0 without noise, or where it is not known: up to 1 % is
    /// then taken from the scatter along the path.
    pub std: f64,
}

/// What is chosen at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The node that belongs to the path; `None` where none does.
    pub chosen: Option<usize>,
    /// Other nodes that the data cannot exclude: where there are any, the frequency is ambiguous.
    pub rivals: Vec<usize>,
    /// By how much the best path through another node costs more, in nats; infinite where no other path exists.
    pub margin: f64,
}

/// How to choose.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SelectOptions {
    /// Sensors in the misfit. Default 1.
    pub sensors: usize,
    /// Whether σ_m is known. Default true; what the best misfits have above it is then taken for error of the model. Otherwise σ_m is known
    /// up to a factor for the band and not below 1e-6 of what is given, such as the size of the response.
    pub sigma_known: bool,
}

impl Default for SelectOptions {
    fn default() -> Self {
        Self { sensors: 1, sigma_known: true }
    }
}

with_fields!(SelectOptions { with_sensors: sensors as usize, with_sigma_known: sigma_known as bool });

/// Nats within which another node is an alternative: odds of a thousand to one.
const RIVAL_NATS: f64 = 7.0;

/// Chooses a path through the candidates of a band; frequencies ascend, and each has any number of nodes, also none.
///
/// Nodes that differ by less than twice their standard deviation, or 2e-7 of their value, are one. Nothing is chosen where no node fits the
/// path, where a rival path that cannot be excluded has no node, or anywhere if no path is a material's or covers a sixth of the band:
/// unless several sensors agree on one solution at most of the frequencies and leave no more than a noise that is known, or 5 % of the response. That is chosen then, material or
/// not, and where the path of a material has a gap too.
///
/// # Limits
/// - The factor is that of a stiffness, E′ > 0 and η ≥ 0, or a constant; bounds are applied before.
/// - With one sensor continuity and causality alone decide: a band of less than a tenth of a unit in ln ω is likely ambiguous.
/// - Where the right node is missing, a wrong one that lies where the path is expected is taken for it; where most are missing and a wrong
///   branch has the slope of a material, that branch is.
/// - The search keeps the best few paths of each history, so margins are upper bounds in crowded bands.
///
/// # Panics
/// Where there is not one list of nodes for each frequency.
pub fn choose(frequency_hz: &[f64], nodes: &[Vec<Node>], options: &SelectOptions) -> Vec<Choice> {
    assert_eq!(frequency_hz.len(), nodes.len());
    let noise = Noise::of(nodes, options);
    let log_frequency: Vec<f64> = frequency_hz.iter().map(|&f| omega_rad_s(f).ln()).collect();
    // At 0 Hz there is no ln ω; nothing is chosen there.
    let scatters: Vec<Scatter> = noise.scatters(nodes).collect();
    let band = |k: usize, every: usize| {
        let points = nodes.iter().zip(&log_frequency).step_by(every);
        let points = points
            .map(|(nodes, log)| if log.is_finite() { noise.points(nodes, scatters[k]) } else { Vec::new() });
        let log_frequency = log_frequency.iter().step_by(every).copied().collect();
        Band { points: points.collect(), log_frequency }
    };
    let nothing = Choice { chosen: None, rivals: Vec::new(), margin: f64::INFINITY };
    let band = Band::likeliest(scatters.len(), nodes.len(), band);
    let can_agree = options.sensors > 1 && noise.is_all();
    let agreed = if can_agree { agreement(&band) } else { None };
    let agreed = agreed.map(|agreed| -> Vec<Choice> {
        let of = |points: &[Point], (index, margin): (usize, f64)| Choice {
            chosen: Some(points[index].node),
            margin,
            ..nothing.clone()
        };
        let each = band.points.iter().zip(agreed);
        each.map(|(points, one)| one.map_or_else(|| nothing.clone(), |one| of(points, one))).collect()
    });
    let tracks = tracks(band.clone());
    let Some((best, rivals)) = tracks.split_first() else {
        return agreed.unwrap_or_else(|| vec![nothing; nodes.len()]);
    };
    let rivals: Vec<_> = rivals.iter().filter(|rival| rival.score < best.score + RIVAL_NATS).collect();
    let curvature = best.restricted().curvature();
    let (mut path, costs) = best.band.through_each(curvature);
    bridge(&mut path, &best.chosen);
    // A material on which most of the band lies needs no sensors to overrule it; where it has a gap they may know what is there.
    let node = |k: usize| path[k].map(|index| best.band.points[k][index].node);
    let agreed = match agreed {
        Some(agreed) if !band.is_covered(&path) => return agreed,
        Some(agreed) if is_same(&agreed, node) => agreed,
        _ => vec![nothing.clone(); nodes.len()],
    };
    let choose_at = |k: usize| {
        let mut choice = nothing.clone();
        let points = &best.band.points[k];
        let Some(index) = path[k] else { return agreed[k].clone() };
        // Where one of the paths that cannot be excluded has nothing, the right solution may be missing.
        if rivals.iter().any(|rival| rival.chosen[k].is_none()) {
            return choice;
        }
        choice.chosen = Some(points[index].node);
        let others = points.iter().zip(&costs[k]).map(|(point, cost)| (point, cost - costs[k][index]));
        let rivals = rivals.iter().filter_map(|rival| Some((rival.at(k)?, rival.score - best.score)));
        for (other, margin) in others.chain(rivals).filter(|(other, _)| !other.is(&points[index])) {
            choice.margin = choice.margin.min(margin);
            if margin < RIVAL_NATS && !choice.rivals.contains(&other.node) {
                choice.rivals.push(other.node);
            }
        }
        choice
    };
    (0..nodes.len()).map(choose_at).collect()
}

/// Of the frequencies at which two ways of choosing have a node, the share at which it may be another one.
const MAX_OTHER_SHARE: f64 = 0.05;

/// Whether what sensors agree on is what a path has, where both have something.
fn is_same(agreed: &[Choice], node: impl Fn(usize) -> Option<usize>) -> bool {
    let both = agreed.iter().enumerate().filter_map(|(k, one)| one.chosen.zip(node(k)));
    let (all, other) = both.fold((0, 0), |(all, other), (a, b)| (all + 1, other + usize::from(a != b)));
    other as f64 <= MAX_OTHER_SHARE * f64::from(all)
}

/// Nodes side by side that are no accident: what noise or a stray makes of one frequency does not join on to both sides through several.
const MIN_SEGMENT_NODES: usize = 3;

/// Goes through a stretch that a path of the band's own curvature leaves out where the track of a larger curvature goes through it without a gap and meets the path at
/// both ends: the curve bends there more than elsewhere, as by an error of the measurement that is smooth over frequency. A shorter one stays left out.
fn bridge(path: &mut [Option<usize>], track: &[Option<usize>]) {
    let mut first = 0;
    while first < path.len() {
        let length = path[first..].iter().take_while(|point| point.is_none()).count();
        let end = first + length;
        let joined = |k: usize| path[k].is_some() && path[k] == track[k];
        let whole = track[first..end].iter().all(Option::is_some);
        if length >= MIN_SEGMENT_NODES
            && whole
            && first > 0
            && end < path.len()
            && joined(first - 1)
            && joined(end)
        {
            path[first..end].copy_from_slice(&track[first..end]);
        }
        first = end + 1;
    }
}

/// Standard deviation of ln E that is left to a root without noise: half the digits, as a nearly double root has.
const ROOT_LN_STD: f64 = 1e-7;

/// Least factor on a variance that is not known: a millionth of the response is roundoff near a resonance.
const MIN_VARIANCE_FACTOR: f64 = 1e-12;

/// The variance over a given one up to which nothing but noise is to be seen, and the part of the response that noise of unknown size may be.
const MAX_USUAL_FACTOR: f64 = 1.5;
const MAX_UNKNOWN_NOISE: f64 = 0.05;

/// Scatters that are tried: of ln E, beside what is given, or in units of the given standard deviation if that is of unknown size.
const SCATTERS: [f64; 14] = [0.0, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0];

/// The largest scatter of ln E that is not given: with more, any node would fit any path.
const MAX_SCATTER: f64 = 1e-2;

/// How far points may lie off their curve.
#[derive(Debug, Clone, Copy)]
struct Scatter {
    /// In units of the given standard deviation.
    given: f64,
    /// Beside it.
    more: f64,
}

/// What a misfit means.
struct Noise {
    /// True variance over the given one.
    factor: f64,
    /// Nats of a right node's misfit, on average.
    usual: f64,
    /// Whether the variance is.
    known: bool,
}

impl Noise {
    /// Whether the best misfits may be those of noise, of a model without errors.
    fn is_all(&self) -> bool {
        self.factor <= if self.known { MAX_USUAL_FACTOR } else { MAX_UNKNOWN_NOISE * MAX_UNKNOWN_NOISE }
    }

    /// From the lower quartile of the best misfits, which stands even where most frequencies have lost the right node.
    fn of(nodes: &[Vec<Node>], options: &SelectOptions) -> Self {
        let least = |nodes: &Vec<Node>| nodes.iter().map(|node| node.misfit).min_by(f64::total_cmp);
        let mut best: Vec<f64> = nodes.iter().filter_map(least).filter(|misfit| misfit.is_finite()).collect();
        best.sort_by(f64::total_cmp);
        // E. B. Wilson, M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684–688: quantiles of χ² for the normal deviate −0.6745.
        let freedom = 2.0 * options.sensors.saturating_sub(1).max(1) as f64;
        let quartile =
            freedom * (1.0 - 2.0 / (9.0 * freedom) - 0.6745 * (2.0 / (9.0 * freedom)).sqrt()).powi(3);
        let found = best.get(best.len() / 4).map_or(0.0, |misfit| misfit / quartile);
        let least = if options.sigma_known { 1.0 } else { MIN_VARIANCE_FACTOR };
        // Without other sensors, or noise, there is no misfit to expect.
        let usual = if found > least / 4.0 { freedom / 2.0 } else { 0.0 };
        Self { factor: found.max(least), usual, known: options.sigma_known }
    }

    /// What is to be tried, least first.
    fn scatters(&self, nodes: &[Vec<Node>]) -> impl Iterator<Item = Scatter> {
        let known = self.known || nodes.iter().flatten().all(|node| node.std == 0.0);
        let given = self.factor.sqrt();
        SCATTERS.into_iter().filter(move |&size| !known || size <= MAX_SCATTER).map(move |size| {
            if known { Scatter { given, more: size } } else { Scatter { given: size, more: 0.0 } }
        })
    }

    /// Nats that a frequency holds against its best node. They scatter by √usual: of one sensor beside the first by one nat, and so of any number, else noise alone would
    /// exclude a frequency of many sensors.
    fn surprise(&self, least: f64) -> f64 {
        (least / (2.0 * self.factor) - self.usual) / self.usual.sqrt().max(1.0)
    }

    fn points(&self, nodes: &[Node], scatter: Scatter) -> Vec<Point> {
        let least = nodes.iter().map(|node| node.misfit).fold(f64::INFINITY, f64::min);
        let point = |(node, Node { factor, misfit, std }): (usize, &Node)| {
            let given = scatter.given * std / factor.norm();
            Point {
                node,
                log: factor.ln(),
                variance: given * given + scatter.more * scatter.more + ROOT_LN_STD * ROOT_LN_STD,
                misfit: self.surprise(least) + (misfit - least) / (2.0 * self.factor),
            }
        };
        let is_number =
            |point: &Point| point.log.is_finite() && point.variance.is_finite() && point.misfit.is_finite();
        nodes.iter().enumerate().map(point).filter(is_number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_is_bridged_and_a_stray_is_not() {
        let path =
            [Some(0), None, None, None, Some(2), None, Some(1), None, None, None, Some(0), None, None, None];
        let track = path.map(|_| Some(0));
        let bridged = |mut track: [Option<usize>; 14], change: &dyn Fn(&mut [Option<usize>])| {
            // The track meets the path wherever that is.
            (0..14).for_each(|k| track[k] = path[k].or(track[k]));
            change(&mut track);
            let mut path = path;
            bridge(&mut path, &track);
            path.iter().map(|point| usize::from(point.is_some())).collect::<Vec<_>>()
        };
        assert_eq!(bridged(track, &|_| {}), [1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0]);
        // With a gap of its own, or another point at an end, it says nothing.
        assert_eq!(bridged(track, &|track| track[2] = None), [1, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0]);
        assert_eq!(bridged(track, &|track| track[4] = Some(1)), [1, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0]);
        bridge(&mut [], &[]);
    }
}
