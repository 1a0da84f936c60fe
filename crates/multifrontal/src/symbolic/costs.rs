//! Costs of fronts, and which subtrees are worth a thread.

use super::{NO_PARENT, Shape, Symbolic};
use crate::front::PANEL_COLUMNS;
use crate::kernel::{MAX_TILE_ROWS, STRIP_COLUMNS, TILES_PER_RUN};
use crate::packed_lower::PackedLower;
use std::ops::Range;

/// Subtrees that are wanted: enough to keep some threads busy, few enough to leave work to each.
const MIN_SUBTREES: usize = 32;

/// Multiplications below which nothing is shared: a factorisation of less takes a millisecond.
pub(super) const MIN_SHARED_MULTIPLICATIONS: f64 = 1e7;

/// Σ over the pivots of (entries of their columns)².
pub(super) fn multiplications(pivots: usize, below: usize) -> f64 {
    // Σ_{j = below+1}^{below+pivots} j²
    let squares = |k: f64| k * (k + 1.0) * (2.0 * k + 1.0) / 6.0;
    squares((pivots + below) as f64) - squares(below as f64)
}

pub(super) fn flops(front: &Shape) -> f64 {
    multiplications(front.pivots, front.rows.len())
}

/// Multiplications of each front and all below it.
pub(super) fn work(fronts: &[Shape]) -> Vec<f64> {
    let mut work: Vec<f64> = fronts.iter().map(flops).collect();
    for (k, front) in fronts.iter().enumerate().filter(|(_, front)| front.parent != NO_PARENT) {
        work[front.parent] += work[k];
    }
    work
}

/// Disjoint subtrees, each a run of fronts, ascending; the same whatever the number of threads.
pub(super) fn subtrees(fronts: &[Shape]) -> Vec<Range<usize>> {
    let work = work(fronts);
    let mut first: Vec<usize> = (0..fronts.len()).collect();
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); fronts.len()];
    let mut open: Vec<usize> = Vec::new();
    for (k, front) in fronts.iter().enumerate() {
        if front.parent == NO_PARENT {
            open.push(k);
        } else {
            first[front.parent] = first[front.parent].min(first[k]);
            children[front.parent].push(k);
        }
    }
    let total: f64 = open.iter().map(|&k| work[k]).sum();
    if total < MIN_SHARED_MULTIPLICATIONS {
        return Vec::new();
    }
    // Split the heaviest until none is more than its share.
    while open.len() < MIN_SUBTREES {
        let Some(heaviest) = (0..open.len()).max_by(|&a, &b| work[open[a]].total_cmp(&work[open[b]])) else {
            break;
        };
        if work[open[heaviest]] * (MIN_SUBTREES as f64) < 2.0 * total {
            break;
        }
        let front = open.swap_remove(heaviest);
        open.extend(&children[front]);
    }
    let mut subtrees: Vec<_> = open.into_iter().map(|k| first[k]..k + 1).collect();
    subtrees.sort_by_key(|subtree| subtree.start);
    subtrees
}

/// The most numbers of Schur complements at even and at odd depths while one worker goes through these fronts.
pub(super) fn stacks(symbolic: &Symbolic, fronts: Range<usize>) -> [usize; 2] {
    let (mut live, mut most) = ([0; 2], [0; 2]);
    let schur = |front: usize| PackedLower::new(symbolic.fronts[front].rows.len());
    let whole = |front: usize| schur(front).start::<f64>(schur(front).rows());
    // The columns of the parent's candidates, which are given back at once.
    let moved = |front: usize| schur(front).start::<f64>(symbolic.moved(front));
    for front in fronts.clone() {
        let parity = symbolic.parity(front);
        live[parity] += whole(front);
        most[parity] = most[parity].max(live[parity]);
        let children = symbolic.children_of(front).iter().map(|&child| child as usize);
        let children = children.filter(|child| fronts.contains(child));
        live[1 - parity] -= children.map(|child| whole(child) - moved(child)).sum::<usize>();
        live[parity] -= moved(front);
    }
    most
}

/// The most numbers that live beside the factor while one worker goes through all fronts.
pub(super) fn working_scalars(symbolic: &Symbolic) -> usize {
    symbolic.stacks(1).iter().sum()
}

/// The most numbers, for one real product, of the packed copies that one worker makes of a front's columns.
pub(super) fn packed(symbolic: &Symbolic) -> usize {
    let left = |front: &Shape| (front.order() + MAX_TILE_ROWS) * front.pivots.min(PANEL_COLUMNS);
    symbolic.fronts.iter().map(left).max().unwrap_or(0)
        + STRIP_COLUMNS * (PANEL_COLUMNS + TILES_PER_RUN * MAX_TILE_ROWS)
}
