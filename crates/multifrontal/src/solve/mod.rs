//! Solutions: forward through the subtrees, through what is above them and back, and back through the subtrees.
//!
//! Every part works on numbers of its own, so that parts can be shared out to threads; the sums are the same
//! whoever makes them. A few right-hand sides are worked on at the same time, side by side.

mod many;
mod one;

use crate::factor::{Factor, Node};
use crate::part::Part;
use crate::scalar::Scalar;
use crate::threads::{map, with};
use many::Shaped;
use std::ops::Range;

/// Numbers of a factor below which another thread costs more than it brings.
const SHARE_FROM: usize = 40_000;

/// Columns of L that are met together: as many streams as a processor follows, complex ones having two.
const BLOCK: usize = 8;

/// Pivots of a node after which the threads meet.
const SPAN: usize = 256;

/// The fewest rows that one thread takes at a time, so that columns are met in runs.
const FEWEST: usize = 96;

/// One node, and the numbers of its part: of each row the parts, of each part the right-hand sides.
struct Step<'a, T: Scalar> {
    node: &'a Node<T>,
    local: &'a mut [T::Real],
    /// Numbers of the front's rows.
    buffer: &'a mut Vec<T::Real>,
    threads: usize,
    /// Whether it may be shared out to threads, however many there are: sums do not depend on that.
    shared: bool,
}

impl<T: Scalar> Node<T> {
    /// Some rows of one part of a column of L.
    #[inline(always)]
    fn part(&self, col: usize, part: usize, rows: Range<usize>) -> &[T::Real] {
        &self.values[(col * T::PARTS + part) * self.stride..][rows]
    }

    /// Entry of L below its diagonal.
    #[inline(always)]
    fn at(&self, row: usize, col: usize) -> T {
        let at = |part: usize| self.values[(col * T::PARTS + part) * self.stride + row];
        T::from_parts([at(0), at(T::PARTS - 1)])
    }

    /// The pivots in spans.
    fn spans(&self) -> impl DoubleEndedIterator<Item = Range<usize>> {
        pieces(0..self.pivots(), SPAN)
    }

    /// Where the rows end that the columns of a span are met in one after the other.
    fn inner(&self, span: &Range<usize>, shared: bool) -> usize {
        if shared && span.len() * self.order() >= SHARE_FROM { span.end } else { self.order() }
    }
}

/// Rows in pieces for so many threads, a few for each, and none longer than `most`.
fn shares(rows: Range<usize>, threads: usize, most: usize) -> (usize, impl Iterator<Item = Range<usize>>) {
    let len = if threads < 2 { rows.len() } else { rows.len().div_ceil(2 * threads) };
    let len = len.clamp(FEWEST, most);
    (len, pieces(rows, len))
}

/// A range in pieces of some length, the last perhaps shorter.
fn pieces(
    range: Range<usize>,
    len: usize,
) -> impl DoubleEndedIterator<Item = Range<usize>> + ExactSizeIterator {
    let count = range.len().div_ceil(len);
    (0..count).map(move |k| range.start + k * len..range.end.min(range.start + (k + 1) * len))
}

impl<T: Scalar> Factor<T> {
    /// Overwrites k right-hand sides (n × k, column after column) with the solutions of A X = B.
    ///
    /// Parts of the factor that a right-hand side does not touch are skipped on the way forward.
    ///
    /// # Panics
    /// Where there are not whole right-hand sides.
    ///
    /// # Limits
    /// Nothing is checked or refined here.
    pub fn solve_in_place(&self, rhs: &mut [T], threads: usize) {
        T::solve(self, rhs, threads);
    }

    /// Right-hand sides side by side, `lanes` or fewer.
    fn solve_together(&self, rhs: &mut [T], lanes: usize, threads: usize) {
        let Some((top, subtrees)) = self.parts.split_last() else { return };
        let row = T::PARTS * lanes;
        let given: &[T] = rhs;
        let below = map(threads, subtrees.iter().collect(), |part| {
            let mut local = self.gather(part, given, lanes);
            self.forward(part, &mut local, lanes, 1);
            local
        });
        let mut above = self.gather(top, given, lanes);
        for (part, local) in subtrees.iter().zip(&below) {
            let changes = local[part.len() * row..].chunks_exact(row);
            for (&place, changes) in part.outside.iter().zip(changes) {
                let above = &mut above[place as usize * row..][..row];
                above.iter_mut().zip(changes).for_each(|(above, &change)| *above += change);
            }
        }
        self.forward(top, &mut above, lanes, threads);
        self.backward(top, &mut above, lanes, threads);
        let below = map(threads, subtrees.iter().zip(below).collect(), |(part, mut local)| {
            for (&place, local) in part.outside.iter().zip(local[part.len() * row..].chunks_exact_mut(row)) {
                local.copy_from_slice(&above[place as usize * row..][..row]);
            }
            self.backward(part, &mut local, lanes, 1);
            local
        });
        self.scatter(top, &above, rhs, lanes);
        subtrees.iter().zip(&below).for_each(|(part, local)| self.scatter(part, local, rhs, lanes));
    }

    /// S b in the order of a part's positions, zeros for those outside of it.
    fn gather(&self, part: &Part, rhs: &[T], lanes: usize) -> Vec<T::Real> {
        let row = T::PARTS * lanes;
        let mut local = vec![T::Real::default(); part.size() * row];
        for (lane, b) in rhs.chunks_exact(self.dim()).enumerate() {
            for (local, (from, scale)) in local.chunks_exact_mut(row).zip(self.rows_of(part)) {
                let parts = b[from].scale(scale).parts();
                for p in 0..T::PARTS {
                    local[p * lanes + lane] = parts[p];
                }
            }
        }
        local
    }

    /// x = S y.
    fn scatter(&self, part: &Part, local: &[T::Real], rhs: &mut [T], lanes: usize) {
        for (lane, x) in rhs.chunks_exact_mut(self.dim()).enumerate() {
            for (local, (to, scale)) in local.chunks_exact(T::PARTS * lanes).zip(self.rows_of(part)) {
                x[to] = T::from_parts([local[lane], local[(T::PARTS - 1) * lanes + lane]]).scale(scale);
            }
        }
    }

    /// Rows of the matrix, and their scales, of what is eliminated in a part.
    fn rows_of<'a>(&'a self, part: &'a Part) -> impl Iterator<Item = (usize, T::Real)> {
        let of = |run: &Range<usize>| self.order[run.clone()].iter().zip(&self.scale[run.clone()]);
        part.own.iter().flat_map(of).map(|(&row, &scale)| (row as usize, scale))
    }

    fn nodes_of<'a>(&'a self, part: &'a Part) -> impl DoubleEndedIterator<Item = &'a Node<T>> {
        part.nodes.iter().flat_map(|run| &self.nodes[run.clone()])
    }

    /// Whether a part is what is above all subtrees.
    fn is_top(&self, part: &Part) -> bool {
        self.parts.last().is_some_and(|top| std::ptr::eq(top, part))
    }

    /// y = L⁻¹ b over the nodes of a part; places outside receive what they have to add.
    fn forward(&self, part: &Part, local: &mut [T::Real], lanes: usize, threads: usize) {
        let shared = self.is_top(part);
        let buffer = &mut Vec::new();
        let row = T::PARTS * lanes;
        for node in self.nodes_of(part) {
            let own = &local[node.first * row..][..node.pivots() * row];
            if own.iter().all(|&x| x == T::Real::default()) {
                continue;
            }
            let step = Step { node, local, buffer, threads, shared };
            if lanes == 1 {
                crate::arch().dispatch(one::Forward(step));
            } else {
                many::Forward(step).dispatch();
            }
        }
    }

    /// x = L⁻ᵀ D⁻¹ y over the nodes of a part.
    fn backward(&self, part: &Part, local: &mut [T::Real], lanes: usize, threads: usize) {
        let shared = self.is_top(part);
        let buffer = &mut Vec::new();
        for node in self.nodes_of(part).rev() {
            let step = Step { node, local, buffer, threads, shared };
            if lanes == 1 {
                crate::arch().dispatch(one::Backward(step));
            } else {
                many::Backward(step).dispatch();
            }
        }
    }
}

pub(crate) fn solve<T: Scalar>(factor: &Factor<T>, rhs: &mut [T], threads: usize) {
    let dim = factor.dim();
    if dim == 0 || rhs.is_empty() {
        return;
    }
    assert_eq!(rhs.len() % dim, 0, "whole right-hand sides");
    let numbers: usize = factor.nodes.iter().map(|node| node.values.len()).sum();
    let threads = if numbers < SHARE_FROM { 1 } else { threads.max(1) };
    let together = many::lanes::<T::Real>();
    with(threads, || {
        for some in rhs.chunks_mut(dim * together) {
            let lanes = if some.len() == dim { 1 } else { together };
            factor.solve_together(some, lanes, threads);
        }
    });
}
