//! Elimination of a front's candidates: corners one after the other, everything else by products of matrices.
//!
//! A pivot is chosen inside its corner and judged afterwards by all rows of the front. Where an entry of L
//! would be larger than the threshold allows, the column is put back and tried again at the end; what never
//! succeeds is left to the parent, whose front knows more of its row.
//!
//! I. S. Duff, J. Hogg, F. Lopez, SIAM J. Sci. Comput. 42 (2020) C23–C42.

use super::assemble::schur_strips;
use super::corner::{CORNER, Corner, invert_pair};
use super::rows::{Tile, solve_rows};
use super::{Front, Stack, strips};
use crate::kernel::{Buffers, Left, Pivots, downdate};
use crate::scalar::{Real, Scalar};
use crate::threads::Idle;

/// Columns whose elimination is carried to the rest of the front in one product.
pub(crate) const BLOCK: usize = 256;

/// Buffers of one worker, and how it works.
pub(crate) struct Elimination<T: Scalar> {
    corner: Box<Corner<T>>,
    left: Left<T::Real>,
    idle: Idle<Buffers<T::Real>>,
    tiles: Idle<Box<Tile<T::Real>>>,
    saved: Vec<T::Real>,
    /// For what fronts of a subtree leave, at even and at odd depths.
    pub(crate) stacks: [Stack<T::Real>; 2],
    /// No entry of L is larger than 1/threshold.
    pub(crate) threshold: f64,
    pub(crate) threads: usize,
}

impl<T: Scalar> Elimination<T> {
    pub(crate) fn new(threshold: f64) -> Self {
        Self {
            corner: Corner::new(),
            left: Left::default(),
            idle: Idle::default(),
            tiles: Idle::default(),
            saved: Vec::new(),
            stacks: [Stack::default(), Stack::default()],
            threshold,
            threads: 1,
        }
    }
}

/// Eliminates what can be eliminated of a front and carries it to its Schur complement; the pivots' D.
///
/// Where nothing can be eliminated the Schur complement becomes 0: what the children leave in it is added later.
/// Afterwards the first columns of the panel hold L, and the other candidates what is left of them.
pub(crate) fn eliminate<T: Scalar>(
    front: &mut Front<'_, T>,
    schur: &mut [T::Real],
    with: &mut Elimination<T>,
) -> Vec<[T; 2]> {
    let mut d = Vec::with_capacity(front.candidates);
    loop {
        let before = d.len();
        let mut untried = front.candidates;
        while d.len() < untried {
            let (from, to) = (d.len(), untried.min(d.len() + BLOCK));
            eliminate_block(front, from, to, &mut d, with);
            carry(front, from, to, schur, &d, with);
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

/// Eliminates candidates `from..to`; those that fail end up last among them.
fn eliminate_block<T: Scalar>(
    front: &mut Front<'_, T>,
    from: usize,
    to: usize,
    d: &mut Vec<[T; 2]>,
    with: &mut Elimination<T>,
) {
    let (mut at, mut end) = (from, to);
    while at < end {
        let width = CORNER.min(end - at);
        with.corner.factor(front, at, width);
        for &(i, j) in &with.corner.exchanges {
            front.exchange(at + i, at + j);
        }
        let tried = with.corner.d.len();
        with.saved.clear();
        for (col, part) in columns::<T>(at..at + tried) {
            with.saved.extend_from_slice(front.part(col, part, col));
        }
        let accepted = solve_rows(front, at, &with.corner, 1.0 / with.threshold, &with.tiles, with.threads);
        // Put back what was not accepted.
        let mut saved = with.saved.as_slice();
        for (col, part) in columns::<T>(at..at + tried) {
            let (column, rest) = saved.split_at(front.rows() - col);
            saved = rest;
            if col >= at + accepted {
                front.part_mut(col, part, col).copy_from_slice(column);
            }
        }
        d.extend_from_slice(&with.corner.d[..accepted]);
        // A refused pivot, or all that is zero in its corner, moves behind the untried columns of the block.
        let refused = match with.corner.d.get(accepted) {
            Some([_, below]) => 1 + usize::from(*below != T::default()),
            None => width - tried,
        };
        update(front, at, at + accepted, to, &d[at..], with);
        at += accepted;
        let next = end - refused;
        for k in 0..refused.min(next - at) {
            front.exchange(at + k, next.max(at + refused) + k);
        }
        end = next;
    }
}

/// The parts of some columns.
fn columns<T: Scalar>(range: std::ops::Range<usize>) -> impl Iterator<Item = (usize, usize)> {
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
    let (rows, stride, step) = (front.rows() - done, front.stride, front.step());
    let (eliminated, rest) = front.panel.split_at_mut(done * step);
    let pivots = Pivots { columns: &eliminated[at * step + done..], stride, rows, d };
    with.left.pack(&pivots, with.threads);
    let strips = strips(rest, stride, done, to, with.threads).collect();
    downdate(strips, &pivots, &with.left, &with.idle, with.threads);
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
    let (rows, stride, step) = (front.rows() - to, front.stride, front.step());
    if from == d.len() || rows == 0 {
        return;
    }
    let candidates = front.candidates;
    let (eliminated, rest) = front.panel.split_at_mut(to * step);
    let pivots = Pivots { columns: &eliminated[from * step + to..], stride, rows, d: &d[from..] };
    with.left.pack(&pivots, with.threads);
    let mut all: Vec<_> = strips(rest, stride, to, candidates, with.threads).collect();
    // The first pivots of all find nothing there.
    all.extend(schur_strips(schur, front.ids.len() - candidates, from == 0).map(|mut strip| {
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
    let (first, second) = match one {
        Some(col) => (col, None),
        None => match two() {
            Some((i, j)) => (i, Some(j)),
            None => return false,
        },
    };
    let mut move_to = |to: usize, from: usize| {
        if from != to {
            front.exchange(to, from)
        }
    };
    move_to(at, first);
    if let Some(second) = second {
        move_to(at + 1, second);
    }
    let width = 1 + usize::from(second.is_some());
    with.corner.force(front, at, width);
    // Already judged; roundoff may take an entry a little over the limit.
    let accepted = solve_rows(front, at, &with.corner, 2.0 * limit, &with.tiles, with.threads);
    debug_assert_eq!(accepted, width);
    d.extend_from_slice(&with.corner.d);
    update(front, at, at + width, candidates, &d[at..], with);
    carry(front, at, candidates, schur, d, with);
    true
}
