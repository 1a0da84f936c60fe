//! Solutions: forward from the subtrees to the roots of the tree, and back.
//!
//! Every branch works on numbers of its own, so that branches can be shared out to threads; the sums are the same
//! whoever makes them. A few right-hand sides are worked on at the same time, side by side.

mod many;
mod one;

use crate::branch::Branch;
use crate::factor::{Factor, Node};
use crate::kernel::STRIP_COLUMNS;
use crate::memory::Memory;
use crate::packed_lower::{PackedLower, top};
use crate::scalar::Scalar;
use crate::threads::{Threads, each, map};
use many::Shaped;
use std::ops::Range;

/// Numbers of a factor below which one thread solves alone: to have another one takes a tenth of a millisecond, and so
/// does half of the solution with a million.
const MIN_SHARED_FACTOR_NUMBERS: usize = 1_000_000;

/// Numbers of a node below which another thread costs more than it brings.
const MIN_SHARED_NODE_NUMBERS: usize = 40_000;

/// Columns of L that are met together: as many streams as a processor follows, complex ones having two.
const COLUMNS_PER_PASS: usize = 8;

// Blocks begin at multiples of their size in spans.
const _: () = assert!(
    STRIP_COLUMNS.is_multiple_of(COLUMNS_PER_PASS) && PIVOTS_PER_MEETING.is_multiple_of(COLUMNS_PER_PASS)
);

/// Pivots of a node after which the threads meet.
const PIVOTS_PER_MEETING: usize = 256;

/// The fewest rows that one thread takes at a time, so that columns are met in runs.
const MIN_ROWS_PER_THREAD: usize = 96;

/// One node, and the numbers of its branch: of each row the parts, of each part the right-hand sides.
struct Step<'a, T: Scalar> {
    node: Columns<'a, T>,
    local: &'a mut [T::Real],
    /// Numbers of the front's rows.
    buffer: &'a mut Memory<T::Real>,
    threads: usize,
    /// Whether it may be shared out to threads, however many there are: sums do not depend on that.
    shared: bool,
}

/// A node with its columns of L.
struct Columns<'a, T: Scalar> {
    node: &'a Node<T>,
    values: &'a [T::Real],
    packed_lower: PackedLower,
}

/// Columns of L in one strip, from one on.
struct InStrip<'a, T: Scalar> {
    first: usize,
    /// From its first row on.
    values: &'a [T::Real],
    top: usize,
    stride: usize,
}

impl<T: Scalar> Clone for Columns<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: Scalar> Copy for Columns<'_, T> {}

impl<T: Scalar> std::ops::Deref for Columns<'_, T> {
    type Target = Node<T>;

    fn deref(&self) -> &Node<T> {
        self.node
    }
}

impl<'a, T: Scalar> InStrip<'a, T> {
    /// Some rows of one part of a column of L.
    #[inline(always)]
    fn part(&self, col: usize, part: usize, rows: Range<usize>) -> &'a [T::Real] {
        &self.values[((col - self.first) * T::PARTS + part) * self.stride..]
            [rows.start - self.top..rows.end - self.top]
    }

    /// Entry of L below its diagonal.
    #[inline(always)]
    fn at(&self, row: usize, col: usize) -> T {
        let at =
            |part: usize| self.values[((col - self.first) * T::PARTS + part) * self.stride + row - self.top];
        T::from_parts([at(0), at(T::PARTS - 1)])
    }
}

impl<'a, T: Scalar> Columns<'a, T> {
    /// The columns of a strip from one on; [`COLUMNS_PER_PASS`]s are in one strip each.
    #[inline(always)]
    fn in_strip(&self, first: usize) -> InStrip<'a, T> {
        let values = &self.values[self.packed_lower.start::<T>(first)..];
        InStrip { first, values, top: top(first), stride: self.packed_lower.stride(first) }
    }

    /// The pivots in spans.
    fn spans(&self) -> impl DoubleEndedIterator<Item = Range<usize>> {
        pieces(0..self.pivots(), PIVOTS_PER_MEETING)
    }

    /// Where the rows end that the columns of a span are met in one after the other.
    fn inner(&self, span: &Range<usize>, shared: bool) -> usize {
        if shared && span.len() * self.order() >= MIN_SHARED_NODE_NUMBERS { span.end } else { self.order() }
    }
}

/// Rows in pieces for so many threads, a few for each, and none longer than `most`.
fn shares(rows: Range<usize>, threads: usize, most: usize) -> (usize, impl Iterator<Item = Range<usize>>) {
    let len = if threads < 2 { rows.len() } else { rows.len().div_ceil(2 * threads) };
    let len = len.clamp(MIN_ROWS_PER_THREAD, most);
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
    pub fn solve_in_place(&self, rhs: &mut [T], threads: Threads) {
        T::solve(self, rhs, threads);
    }

    /// Right-hand sides side by side, `lanes` or fewer.
    fn solve_together(&self, rhs: &mut [T], lanes: usize, threads: usize) {
        let run = Together { factor: self, lanes, threads };
        let given: &[T] = rhs;
        let solved = map(threads, self.roots.clone(), |root| run.down(root, run.up(root, given), &[]));
        let some = self.dim() * lanes.div_ceil(threads);
        each(threads, rhs.chunks_mut(some).enumerate().collect(), |(k, x)| {
            let roots = self.roots.iter().zip(&solved);
            roots.for_each(|(&root, local)| run.scatter(root, local, x, k * lanes.div_ceil(threads)));
        });
    }
}

/// The numbers of a branch, of each position the parts, of each part the right-hand sides; and those of the branches below.
struct Local<R> {
    values: Memory<R>,
    below: Vec<Local<R>>,
}

/// Right-hand sides that are solved for at the same time.
struct Together<'a, T: Scalar> {
    factor: &'a Factor<T>,
    lanes: usize,
    threads: usize,
}

impl<T: Scalar> Together<'_, T> {
    /// Numbers of a position.
    fn row(&self) -> usize {
        T::PARTS * self.lanes
    }

    /// y = L⁻¹ S b of a branch and of those below it; numbers outside are what it adds there.
    fn up(&self, branch: usize, rhs: &[T]) -> Local<T::Real> {
        let (branch, row) = (&self.factor.branches[branch], self.row());
        let below = map(self.threads, branch.below.clone(), |below| self.up(below, rhs));
        let mut values = self.gather(branch, rhs);
        for (&from, local) in branch.below.iter().zip(&below) {
            let from = &self.factor.branches[from];
            let changes = local.values[from.own.len() * row..].chunks_exact(row);
            for (&place, changes) in from.outside.iter().zip(changes) {
                let values = &mut values[place as usize * row..][..row];
                values.iter_mut().zip(changes).for_each(|(value, &change)| *value += change);
            }
        }
        self.forward(branch, &mut values);
        Local { values, below }
    }

    /// x = L⁻ᵀ D⁻¹ y likewise, once what is above is known.
    fn down(&self, branch: usize, mut local: Local<T::Real>, above: &[T::Real]) -> Local<T::Real> {
        let (branch, row) = (&self.factor.branches[branch], self.row());
        let outside = local.values[branch.own.len() * row..].chunks_exact_mut(row);
        for (&place, values) in branch.outside.iter().zip(outside) {
            values.copy_from_slice(&above[place as usize * row..][..row]);
        }
        self.backward(branch, &mut local.values);
        let below = branch.below.iter().zip(local.below).collect();
        let below = map(self.threads, below, |(&branch, below)| self.down(branch, below, &local.values));
        Local { values: local.values, below }
    }

    /// S b in the order of a branch's positions, zeros for those outside of it.
    fn gather(&self, branch: &Branch, rhs: &[T]) -> Memory<T::Real> {
        let (row, lanes) = (self.row(), self.lanes);
        let mut local = Memory::zeros(branch.size() * row);
        for (lane, b) in rhs.chunks_exact(self.factor.dim()).enumerate() {
            for (local, (from, scale)) in local.chunks_exact_mut(row).zip(self.rows_of(branch)) {
                let parts = b[from].scale(scale).parts();
                for p in 0..T::PARTS {
                    local[p * lanes + lane] = parts[p];
                }
            }
        }
        local
    }

    /// The solutions S x from one on, of a branch and of those below it.
    fn scatter(&self, branch: usize, local: &Local<T::Real>, into: &mut [T], first: usize) {
        let branch = &self.factor.branches[branch];
        for (lane, x) in (first..).zip(into.chunks_exact_mut(self.factor.dim())) {
            for (local, (to, scale)) in local.values.chunks_exact(self.row()).zip(self.rows_of(branch)) {
                let parts = [local[lane], local[(T::PARTS - 1) * self.lanes + lane]];
                x[to] = T::from_parts(parts).scale(scale);
            }
        }
        branch
            .below
            .iter()
            .zip(&local.below)
            .for_each(|(&branch, local)| self.scatter(branch, local, into, first));
    }

    /// Rows of the matrix, and their scales, of what is eliminated in a branch.
    fn rows_of(&self, branch: &Branch) -> impl Iterator<Item = (usize, T::Real)> {
        let (rows, scales) = (&self.factor.order[branch.own.clone()], &self.factor.scale[branch.own.clone()]);
        rows.iter().zip(scales).map(|(&row, &scale)| (row as usize, scale))
    }

    /// y = L⁻¹ b over the nodes of a branch; places outside receive what they have to add.
    fn forward(&self, branch: &Branch, local: &mut [T::Real]) {
        let (buffer, row) = (&mut Memory::default(), self.row());
        for node in &self.factor.nodes[branch.nodes.clone()] {
            let own = &local[node.first * row..][..node.pivots() * row];
            if own.iter().all(|&x| x == T::Real::default()) {
                continue;
            }
            let step = self.step(node, branch, local, buffer);
            if self.lanes == 1 {
                crate::arch().dispatch(one::Forward(step));
            } else {
                many::Forward(step).dispatch();
            }
        }
    }

    /// x = L⁻ᵀ D⁻¹ y over the nodes of a branch.
    fn backward(&self, branch: &Branch, local: &mut [T::Real]) {
        let buffer = &mut Memory::default();
        for node in self.factor.nodes[branch.nodes.clone()].iter().rev() {
            let step = self.step(node, branch, local, buffer);
            if self.lanes == 1 {
                crate::arch().dispatch(one::Backward(step));
            } else {
                many::Backward(step).dispatch();
            }
        }
    }

    fn step<'a>(
        &'a self,
        node: &'a Node<T>,
        branch: &Branch,
        local: &'a mut [T::Real],
        buffer: &'a mut Memory<T::Real>,
    ) -> Step<'a, T> {
        let threads = if branch.top { self.threads } else { 1 };
        let (values, packed_lower) = (self.factor.columns_of(node), PackedLower::new(node.order()));
        let node = Columns { node, values, packed_lower };
        Step { node, local, buffer, threads, shared: branch.top }
    }
}

pub(crate) fn solve<T: Scalar>(factor: &Factor<T>, rhs: &mut [T], threads: Threads) {
    let dim = factor.dim();
    if dim == 0 || rhs.is_empty() {
        return;
    }
    assert_eq!(rhs.len() % dim, 0, "whole right-hand sides");
    let numbers: usize = factor.nodes.iter().map(Node::numbers).sum();
    let together = many::lanes::<T::Real>();
    threads.if_worth(numbers >= MIN_SHARED_FACTOR_NUMBERS).run(|team| {
        for some in rhs.chunks_mut(dim * together) {
            let lanes = if some.len() == dim { 1 } else { together };
            factor.solve_together(some, lanes, team.size);
        }
    });
}
