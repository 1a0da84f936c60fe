//! Elimination of a front's candidates: corners one after the other, everything else by products of matrices.
//!
//! A pivot is chosen inside its diagonal_block and judged afterwards by all rows of the front. Where the front would grow, it is
//! chosen again among all candidates: a part of a structure that is near a resonance of its own has no good pivot in a
//! diagonal_block. Where an entry of L would be larger than the threshold allows, the column is put back and tried again at the
//! end; what never succeeds is left to the parent, whose front knows more of its row.
//!
//! I. S. Duff, J. Hogg, F. Lopez, SIAM J. Sci. Comput. 42 (2020) C23–C42.

use super::diagonal_block::{DIAGONAL_BLOCK_COLUMNS, DiagonalBlock, invert_pair};
use super::panel_trsm::{Limits, Tile, solve_rows};
use super::rook::{largest, rook};
use super::{Front, strip_width};
use crate::kernel::{Buffers, Left, Pivots, STRIP_COLUMNS, downdate};
use crate::packed_lower::PackedLower;
use crate::scalar::{Real, Scalar};
use crate::threads::Idle;
use std::ops::Range;

/// Columns whose elimination is carried to the rest of the front in one product.
pub(crate) const PANEL_COLUMNS: usize = 256;

/// Growth |l²d| by one pivot after which it is chosen among all candidates: definite matrices, scaled to entries of 1,
/// stay below it. Of undamped blocks of 3,000 to 51,000 unknowns at eight frequencies, backward errors were twice as
/// large with 8, and up to twenty times without.
const MAX_PIVOT_GROWTH: f64 = 2.0;

/// Searches of all candidates of a front: these, and one for so many columns. Each ends a block before it is full.
const MAX_PIVOT_SEARCHES: (usize, usize) = (4, 64);

/// Buffers of one worker, and how it works.
pub(crate) struct Elimination<T: Scalar> {
    diagonal_block: Box<DiagonalBlock<T>>,
    left: Left<T::Real>,
    idle: Idle<Buffers<T::Real>>,
    tiles: Idle<Box<Tile<T::Real>>>,
    saved: Vec<T::Real>,
    /// No entry of L is larger than 1/threshold.
    pub(crate) threshold: f64,
    pub(crate) threads: usize,
}

impl<T: Scalar> Elimination<T> {
    pub(crate) fn new(threshold: f64) -> Self {
        Self {
            diagonal_block: DiagonalBlock::new(),
            left: Left::default(),
            idle: Idle::default(),
            tiles: Idle::default(),
            saved: Vec::new(),
            threshold,
            threads: 1,
        }
    }
}

/// Eliminates what can be eliminated of a front and carries it to its Schur complement; the pivots' D.
///
/// Where nothing can be eliminated the Schur complement becomes 0: what the children leave in it is added later.
/// Afterwards the first columns of the panel hold L, and the other candidates their updated values.
pub(crate) fn eliminate<T: Scalar>(
    front: &mut Front<'_, T>,
    schur: &mut [T::Real],
    with: &mut Elimination<T>,
) -> Vec<[T; 2]> {
    let mut d = Vec::with_capacity(front.candidates);
    let mut searches = MAX_PIVOT_SEARCHES.0 + front.candidates / MAX_PIVOT_SEARCHES.1;
    loop {
        let before = d.len();
        let mut untried = front.candidates;
        let mut chosen = 0;
        while d.len() < untried {
            let (from, to) = (d.len(), untried.min(d.len() + PANEL_COLUMNS));
            let growth = if searches > 0 { MAX_PIVOT_GROWTH } else { f64::INFINITY };
            let grows = eliminate_block(front, from..to, chosen, growth, &mut d, with);
            carry(front, from, to, schur, &d, with);
            chosen = 0;
            if grows {
                searches -= 1;
                chosen = choose(front, d.len(), untried);
                continue;
            }
            // The columns that failed change places with the last of those that were not tried.
            let (failed, next) = (to - d.len(), untried - (to - d.len()));
            for k in 0..failed.min(next - d.len()) {
                front.exchange(d.len() + k, next.max(to) + k);
            }
            untried = next;
        }
        let stuck = d.len() == before && !eliminate_anywhere(front, schur, &mut d, with);
        if stuck || d.len() == front.candidates {
            break;
        }
    }
    if d.is_empty() {
        schur.fill(T::Real::default());
    }
    d
}

/// Eliminates a block of candidates, the first of which may be chosen as a pivot already; those that fail end up last
/// among them. Whether it has stopped before one that makes the front grow.
fn eliminate_block<T: Scalar>(
    front: &mut Front<'_, T>,
    block: Range<usize>,
    mut chosen: usize,
    growth: f64,
    d: &mut Vec<[T; 2]>,
    with: &mut Elimination<T>,
) -> bool {
    let (to, mut at, mut end) = (block.end, block.start, block.end);
    while at < end {
        // It is chosen once: behind columns that failed, no better one is looked for.
        let search = chosen == 0 && end == to && growth.is_finite();
        let limits = Limits { l: 1.0 / with.threshold, growth: if search { growth } else { f64::INFINITY } };
        let width = match std::mem::take(&mut chosen) {
            0 => {
                let width = DIAGONAL_BLOCK_COLUMNS.min(end - at);
                with.diagonal_block.factor(front, at, width);
                width
            }
            width => {
                with.diagonal_block.force(front, at, width);
                width
            }
        };
        for &(i, j) in &with.diagonal_block.exchanges {
            front.exchange(at + i, at + j);
        }
        let tried = with.diagonal_block.d.len();
        with.saved.clear();
        for (col, part) in columns::<T>(at..at + tried) {
            with.saved.extend_from_slice(front.part(col, part, col));
        }
        let accepted = solve_rows(front, at, &with.diagonal_block, limits, &with.tiles, with.threads);
        // Put back what was not accepted.
        let mut saved = with.saved.as_slice();
        for (col, part) in columns::<T>(at..at + tried) {
            let (column, rest) = saved.split_at(front.rows() - col);
            saved = rest;
            if col >= at + accepted {
                front.part_mut(col, part, col).copy_from_slice(column);
            }
        }
        d.extend_from_slice(&with.diagonal_block.d[..accepted]);
        // A refused pivot, or all that is zero in its diagonal_block, moves behind the untried columns of the block.
        let refused = match with.diagonal_block.d.get(accepted) {
            Some([_, below]) => 1 + usize::from(*below != T::default()),
            None => width - tried,
        };
        update(front, at, at + accepted, to, &d[at..], with);
        at += accepted;
        if search && accepted < tried {
            return true;
        }
        let next = end - refused;
        for k in 0..refused.min(next - at) {
            front.exchange(at + k, next.max(at + refused) + k);
        }
        end = next;
    }
    false
}

/// Brings to the front a pivot that keeps it from growing; its columns.
fn choose<T: Scalar>(front: &mut Front<'_, T>, at: usize, end: usize) -> usize {
    let size = |i: usize, j: usize| front.at(i, j).size();
    let pivot = rook(at..end, largest(at, at..end, size), size);
    front.bring(at, pivot)
}

/// The parts of some columns.
fn columns<T: Scalar>(range: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    range.flat_map(|col| (0..T::PARTS).map(move |part| (col, part)))
}

/// Carries pivots `at..done` to the candidates `done..to`.
fn update<T: Scalar>(
    front: &mut Front<'_, T>,
    at: usize,
    done: usize,
    to: usize,
    d: &[[T; 2]],
    with: &mut Elimination<T>,
) {
    if at == done || done == to {
        return;
    }
    let packed_lower = front.packed_lower;
    let (values, rest) = front.panel.split_at_mut(packed_lower.start::<T>(done));
    let pivots = Pivots { values, packed_lower, col: at, row: done, d };
    with.left.pack(&pivots, with.threads);
    let strips = packed_lower.strips(rest, done..to, strip_width(to - done, with.threads), false);
    downdate(strips.collect(), &pivots, &with.left, &with.idle, with.threads);
}

/// Carries the pivots from `from` on to all that is right of candidate `to`.
fn carry<T: Scalar>(
    front: &mut Front<'_, T>,
    from: usize,
    to: usize,
    schur: &mut [T::Real],
    d: &[[T; 2]],
    with: &mut Elimination<T>,
) {
    if from == d.len() || to == front.rows() {
        return;
    }
    let (packed_lower, candidates) = (front.packed_lower, front.candidates);
    let others = front.rows() - candidates;
    let (values, rest) = front.panel.split_at_mut(packed_lower.start::<T>(to));
    let pivots = Pivots { values, packed_lower, col: from, row: to, d: &d[from..] };
    with.left.pack(&pivots, with.threads);
    let width = strip_width(candidates - to, with.threads);
    let mut all: Vec<_> = packed_lower.strips(rest, to..candidates, width, false).collect();
    // The first pivots of all find nothing there.
    let fresh = from == 0;
    all.extend(PackedLower::new(others).strips(schur, 0..others, STRIP_COLUMNS, fresh).map(|mut strip| {
        strip.first += candidates - to;
        strip
    }));
    downdate(all, &pivots, &with.left, &with.idle, with.threads);
}

/// Looks through all candidates that are left for one pivot, or a block of two, that the threshold allows,
/// and eliminates it.
///
/// I. S. Duff, J. K. Reid, ACM Trans. Math. Softw. 9 (1983) 302–325.
fn eliminate_anywhere<T: Scalar>(
    front: &mut Front<'_, T>,
    schur: &mut [T::Real],
    d: &mut Vec<[T; 2]>,
    with: &mut Elimination<T>,
) -> bool {
    let (at, candidates) = (d.len(), front.candidates);
    let entry = |i: usize, j: usize| front.at(i.max(j), i.min(j));
    // The largest entry of each column off the diagonal, over all rows that are left.
    let largest = |col: usize| {
        (at..front.rows())
            .filter(|&row| row != col)
            .map(|row| if row < col { front.at(col, row) } else { front.at(row, col) }.size())
            .fold(0.0, |most: f64, size| if size > most || size.is_nan() { size } else { most })
    };
    let largest: Vec<f64> = (at..candidates).map(largest).collect();
    let nothing = T::Real::ROUNDOFF * T::Real::ROUNDOFF;
    let limit = 1.0 / with.threshold;
    let one = (at..candidates).find(|&col| {
        let size = entry(col, col).size();
        size > nothing && size.is_finite() && largest[col - at] <= limit * size
    });
    let two = || {
        let pairs = (at..candidates).flat_map(|j| (at..j).map(move |i| (i, j)));
        pairs.into_iter().find(|&(i, j)| {
            let below = entry(i, j);
            let inverse = invert_pair([[entry(i, i), below], [entry(j, j), T::default()]]).map(T::size);
            let (p, q) = (largest[i - at], largest[j - at]);
            below.size() > nothing
                && below.is_finite()
                && inverse[0] * p + inverse[1] * q <= limit
                && inverse[1] * p + inverse[2] * q <= limit
        })
    };
    let pivot = match one {
        Some(col) => (col, None),
        None => match two() {
            Some((i, j)) => (i, Some(j)),
            None => return false,
        },
    };
    let width = front.bring(at, pivot);
    with.diagonal_block.force(front, at, width);
    // Already judged; roundoff may take an entry a little over the limit.
    let limits = Limits { l: 2.0 * limit, growth: f64::INFINITY };
    let accepted = solve_rows(front, at, &with.diagonal_block, limits, &with.tiles, with.threads);
    debug_assert_eq!(accepted, width);
    d.extend_from_slice(&with.diagonal_block.d);
    update(front, at, at + width, candidates, &d[at..], with);
    carry(front, at, candidates, schur, d, with);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// I − (1 − δ)uuᵀ with the first rows, so that they are near a resonance of their own, and others that hold them.
    fn held(n: usize, part: usize, delta: f64, packed_lower: PackedLower) -> Vec<f64> {
        let u = (1.0 / part as f64).sqrt();
        let entry = |i: usize, j: usize| match (i < part, j < part) {
            (true, true) => f64::from(i == j) - (1.0 - delta) * u * u,
            (false, false) => f64::from(i == j),
            _ => 0.5 * u * ((i * j) as f64).cos(),
        };
        let mut panel = vec![0.0; packed_lower.start::<f64>(n)];
        for (row, col) in (0..n).flat_map(|col| (col..n).map(move |row| (row, col))) {
            panel[packed_lower.place::<f64>(row, col, 0)] = entry(row, col);
        }
        panel
    }

    /// The largest of |L||D||Lᵀ|, which is on its diagonal.
    fn growth(front: &Front<'_, f64>, d: &[[f64; 2]]) -> f64 {
        let mut sizes = vec![0.0; front.rows()];
        for (j, &[pivot, below]) in d.iter().enumerate() {
            sizes[j] += pivot.abs();
            for (i, size) in sizes.iter_mut().enumerate().skip(j + 1) {
                let l = front.at(i, j).abs();
                *size += l * l * pivot.abs();
                if below != 0.0 && i > j + 1 {
                    *size += 2.0 * l * front.at(i, j + 1).abs() * below.abs();
                }
            }
        }
        sizes.into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn a_part_near_its_own_resonance_does_not_make_the_front_grow() {
        let (n, part) = (400, 170);
        for delta in [1e-2, 1e-3, 1e-4, 1e-6] {
            let packed_lower = PackedLower::new(n);
            let mut panel = held(n, part, delta, packed_lower);
            let mut front =
                Front { ids: (0..n as u32).collect(), candidates: n, panel: &mut panel, packed_lower };
            // A threshold that refuses none of these pivots.
            let d = eliminate(&mut front, &mut [], &mut Elimination::new(0.01));
            assert_eq!(d.len(), n);
            // 15 to 18 are met, and 370 to 7500 where pivots are chosen in corners alone.
            assert!(growth(&front, &d) < 50.0, "{delta}: {}", growth(&front, &d));
        }
    }
}
