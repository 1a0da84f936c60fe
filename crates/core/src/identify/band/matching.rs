//! Which solutions at two frequencies are one and the same.

use super::candidates::LineCandidates;
use crate::c64;
use crate::model::ModelAt;

/// One and the same solution at two frequencies is nearer to itself than this part of the distance to any other …
const PAIR_DISTANCE_RATIO: f64 = 1.0 / 3.0;

/// … and differs by no more than this part of itself: solutions move by a few times the step in frequency, and scatter by what noise does to them.
const PAIR_CHANGE_RTOL: f64 = 0.2;

/// Largest misfit of a solution that could be chosen, over the larger of what noise leaves and of what the best solution leaves.
const MAX_MISFIT_OVER_USUAL: f64 = 100.0;

/// Pairs (left, right) of what is the same solution, in the order of the left ones; `None` where that is not beyond doubt for all within the bounds on both
/// sides that could be chosen. A misfit up to `usual` is noise. Solutions that could be chosen on neither side are left out.
pub(super) fn pairs(
    at: &[ModelAt<'_>],
    left: &LineCandidates,
    right: &LineCandidates,
    usual: f64,
) -> Option<Vec<(usize, usize)>> {
    let factors = |found: &LineCandidates| {
        let nominal = at[found.index].parameters[0].nominal;
        found.explored.all_near().map(|s| nominal + s.correction).collect::<Vec<c64>>()
    };
    let doubtful = |found: &LineCandidates| {
        found.explored.is_unsure()
            || found.explored.breakdown.is_some()
            || found.explored.solutions.is_empty()
    };
    if doubtful(left) || doubtful(right) {
        return None;
    }
    let (a, b) = (factors(left), factors(right));
    let same = |k: usize| {
        let other = nearest(&b, a[k], None)?;
        let near = (b[other] - a[k]).norm();
        let apart = apart(&a, k).min(apart(&b, other));
        let same = near <= PAIR_DISTANCE_RATIO * apart && near <= PAIR_CHANGE_RTOL * a[k].norm();
        (same && nearest(&a, b[other], None) == Some(k)).then_some((k, other))
    };
    let [possible_left, possible_right] = [left, right].map(|found| possible(found, usual));
    let matters = |&(own, other): &(usize, usize)| possible_left[own] || possible_right[other];
    let pairs: Vec<(usize, usize)> = (0..a.len()).filter_map(same).filter(matters).collect();
    // Those within the bounds come first.
    let within = |found: &LineCandidates| 0..found.explored.solutions.len();
    let all = within(left).all(|k| !possible_left[k] || pairs.iter().any(|&(own, _)| own == k))
        && within(right).all(|k| !possible_right[k] || pairs.iter().any(|&(_, own)| own == k));
    all.then_some(pairs)
}

/// Whether each solution, those within the bounds first, explains the sensors well enough to be chosen.
fn possible(found: &LineCandidates, usual: f64) -> Vec<bool> {
    let least = found.explored.solutions.iter().map(|solution| solution.misfit).fold(f64::INFINITY, f64::min);
    let most = MAX_MISFIT_OVER_USUAL * usual.max(least);
    found.explored.all_near().map(|solution| solution.misfit <= most).collect()
}

/// Whether a factor is that of several which was expected to be there.
pub(super) fn is_same(expected: &[c64], k: usize, factor: c64) -> bool {
    let moved = (factor - expected[k]).norm();
    moved <= PAIR_DISTANCE_RATIO * apart(expected, k) && moved <= PAIR_CHANGE_RTOL * expected[k].norm()
}

/// The nearest of several to a value, one of them left out.
fn nearest(all: &[c64], to: c64, but: Option<usize>) -> Option<usize> {
    let others = (0..all.len()).filter(|&k| Some(k) != but);
    others.min_by(|&a, &b| (all[a] - to).norm().total_cmp(&(all[b] - to).norm()))
}

/// How far one of several is from all others.
fn apart(all: &[c64], k: usize) -> f64 {
    nearest(all, all[k], Some(k)).map_or(f64::INFINITY, |other| (all[other] - all[k]).norm())
}
