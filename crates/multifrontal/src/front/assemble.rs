//! What children leave is added to the front of their parent.

use super::{Front, Kept, Stack};
use crate::kernel::Strip;
use crate::packed_lower::PackedLower;
use crate::scalar::{Real, Scalar};
use crate::threads::each;
use pulp::{Simd, WithSimd};

/// Numbers of a front below which another thread costs more than it brings.
const MIN_SHARED_FRONT_NUMBERS: usize = 50_000;

/// What the elimination of a front leaves to its parent: the columns of the candidates that could not be eliminated,
/// and those of its other rows.
#[derive(Debug)]
pub(crate) struct Contribution<R> {
    /// Positions of the candidates that could not be eliminated.
    pub(crate) delayed: Vec<u32>,
    /// The parts of their columns from the diagonal downwards, one after the other.
    columns: Vec<R>,
    /// The Schur complement of the other rows, but for the columns that the parent has already.
    pub(crate) schur: Kept<R>,
    /// How many these are.
    moved: usize,
}

impl<R: Real> Contribution<R> {
    pub(crate) fn new<T: Scalar<Real = R>>(front: &Front<'_, T>, eliminated: usize, schur: Kept<R>) -> Self {
        let delayed = eliminated..front.candidates;
        let parts = delayed.clone().flat_map(|col| (0..T::PARTS).map(move |part| (col, part)));
        let columns = parts.flat_map(|(col, part)| front.part(col, part, col).iter().copied()).collect();
        Self { delayed: front.ids[delayed].to_vec(), columns, schur, moved: 0 }
    }

    /// The same without its stack.
    pub(crate) fn taken_from(self, stack: &mut Stack<R>) -> Self {
        Self { schur: stack.take(self.schur), ..self }
    }

    /// Forgets the columns of the parent's candidates, so many of so many rows, which have been added there.
    pub(crate) fn give_back<T: Scalar<Real = R>>(&mut self, stack: &mut Stack<R>, moved: usize, rows: usize) {
        let start = |col| PackedLower::new(rows).start::<T>(col);
        stack.give_back(&mut self.schur, start(moved) - start(self.moved));
        self.moved = moved;
    }

    /// Adds the delayed columns to the panel of the parent, where they are from `base` on and `delayed` with all others
    /// before its own.
    pub(crate) fn add_delayed<T: Scalar<Real = R>>(
        &self,
        front: &mut Front<'_, T>,
        base: usize,
        delayed: usize,
        relative: &[u32],
    ) {
        let own = self.delayed.len();
        let mut columns = self.columns.iter();
        for (col, part) in (0..own).flat_map(|col| (0..T::PARTS).map(move |part| (col, part))) {
            let column = front.part_mut(base + col, part, base + col);
            let rows =
                (0..own - col).chain(relative.iter().map(|&place| delayed + place as usize - base - col));
            rows.zip(&mut columns).for_each(|(row, &value)| column[row] += value);
        }
    }
}

/// What a child left of its other rows, and where it goes.
pub(crate) struct Child<'a, R> {
    schur: &'a [R],
    moved: usize,
    /// Places of its rows in its parent's front, were none of its candidates delayed ones.
    relative: &'a [u32],
    runs: Vec<Run>,
}

/// Neighbouring rows of a child that are neighbours in its parent too.
#[derive(Clone, Copy)]
struct Run {
    from: usize,
    to: usize,
    len: usize,
}

impl<'a, R: Real> Child<'a, R> {
    pub(crate) fn new(left: &'a Contribution<R>, stack: &'a Stack<R>, relative: &'a [u32]) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        for (from, &to) in relative.iter().enumerate() {
            let to = to as usize;
            match runs.last_mut() {
                Some(run) if run.to + run.len == to => run.len += 1,
                _ => runs.push(Run { from, to, len: 1 }),
            }
        }
        Self { schur: stack.values_of(&left.schur), moved: left.moved, relative, runs }
    }

    /// The first row that is at a place or behind it.
    fn first_at(&self, place: usize) -> usize {
        self.relative.partition_point(|&other| (other as usize) < place)
    }

    /// One part of a column from its diagonal downwards.
    fn column<T: Scalar<Real = R>>(&self, col: usize, part: usize) -> &[R] {
        let packed_lower = PackedLower::new(self.relative.len());
        let (gone, place) = (packed_lower.start::<T>(self.moved), packed_lower.part::<T>(col, part, col));
        &self.schur[place.start - gone..place.end - gone]
    }
}

/// Adds what children left to a strip of their parent's front, whose first column and row is `from`.
pub(crate) fn add_children<T: Scalar>(
    strip: &mut Strip<'_, T>,
    from: usize,
    children: &[Child<'_, T::Real>],
) {
    crate::arch().dispatch(AddChildren { strip, from, children });
}

struct AddChildren<'a, 'b, T: Scalar> {
    strip: &'a mut Strip<'b, T>,
    from: usize,
    children: &'a [Child<'a, T::Real>],
}

impl<T: Scalar> WithSimd for AddChildren<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { strip, from, children } = self;
        for child in children {
            for col in child.first_at(from).max(child.moved)..child.first_at(from + strip.width) {
                let runs = &child.runs[child.runs.partition_point(|run| run.from + run.len <= col)..];
                for part in 0..T::PARTS {
                    let start = ((child.relative[col] as usize - from) * T::PARTS + part) * strip.stride;
                    add_runs(&mut strip.values[start..], from, child.column::<T>(col, part), col, runs);
                }
            }
        }
    }
}

/// Works on the strips of a front, by as many threads as so many numbers are worth.
pub(crate) fn each_strip<'a, T: Scalar>(
    strips: impl Iterator<Item = Strip<'a, T>>,
    numbers: usize,
    threads: usize,
    work: impl Fn(Strip<'a, T>) + Sync + Send,
) {
    each(if numbers < MIN_SHARED_FRONT_NUMBERS { 1 } else { threads }, strips.collect(), work);
}

/// Adds the rows from `first` on of a child's column to a column that begins at row `start` of the front.
#[inline(always)]
fn add_runs<R: Real>(column: &mut [R], start: usize, source: &[R], first: usize, runs: &[Run]) {
    for run in runs {
        let skip = first.saturating_sub(run.from);
        let (from, to) = (run.from + skip - first, run.to + skip - start);
        add(&mut column[to..], &source[from..from + run.len - skip]);
    }
}

#[inline(always)]
fn add<R: Real>(to: &mut [R], from: &[R]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += *from);
}
