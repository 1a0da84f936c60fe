//! What children leave is added to the front of their parent.

use super::{Front, Kept, Stack};
use crate::kernel::{STRIP, Strip};
use crate::scalar::{Real, Scalar};
use crate::threads::each;
use pulp::{Simd, WithSimd};

/// Numbers of a front below which another thread costs more than it brings.
const SHARE_FROM: usize = 50_000;

/// What the elimination of a front leaves to its parent: the columns of the candidates that could not be eliminated,
/// then those of its other rows.
#[derive(Debug)]
pub(crate) struct Contribution<R> {
    /// Positions of the candidates that could not be eliminated.
    pub(crate) delayed: Vec<u32>,
    /// The parts of their columns from the diagonal downwards, one after the other.
    columns: Vec<R>,
    /// The Schur complement of the other rows, in strips of columns from their diagonals downwards.
    pub(crate) schur: Kept<R>,
}

impl<R: Real> Contribution<R> {
    pub(crate) fn new<T: Scalar<Real = R>>(front: &Front<'_, T>, eliminated: usize, schur: Kept<R>) -> Self {
        let delayed = eliminated..front.candidates;
        let parts = delayed.clone().flat_map(|col| (0..T::PARTS).map(move |part| (col, part)));
        let columns = parts.flat_map(|(col, part)| front.part(col, part, col).iter().copied()).collect();
        Self { delayed: front.ids[delayed].to_vec(), columns, schur }
    }

    /// The same without its stack.
    pub(crate) fn taken_from(self, stack: &mut Stack<R>) -> Self {
        Self { schur: stack.take(self.schur), ..self }
    }
}

/// What a child left, and where it goes.
pub(crate) struct Child<'a, R> {
    left: &'a Contribution<R>,
    schur: &'a [R],
    /// Where its delayed candidates begin in its parent's front.
    base: usize,
    /// How many of the parent's candidates are delayed ones.
    delayed: usize,
    /// Places of its other rows behind these.
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
    pub(crate) fn new(
        left: &'a Contribution<R>,
        schur: &'a [R],
        base: usize,
        delayed: usize,
        relative: &'a [u32],
    ) -> Self {
        let mut child = Self { left, schur, base, delayed, relative, runs: Vec::new() };
        for from in 0..child.own() + relative.len() {
            let to = child.place(from);
            match child.runs.last_mut() {
                Some(run) if run.to + run.len == to => run.len += 1,
                _ => child.runs.push(Run { from, to, len: 1 }),
            }
        }
        child
    }

    fn own(&self) -> usize {
        self.left.delayed.len()
    }

    /// Where a row is in the parent's front; ascending.
    fn place(&self, row: usize) -> usize {
        match row.checked_sub(self.own()) {
            Some(other) => self.delayed + self.relative[other] as usize,
            None => self.base + row,
        }
    }

    /// The first row that is at a place or behind it.
    fn first_at(&self, place: usize) -> usize {
        let own = place.saturating_sub(self.base).min(self.own());
        let before = |&other: &u32| self.delayed + (other as usize) < place;
        if own < self.own() { own } else { own + self.relative.partition_point(before) }
    }

    /// One part of a column from its diagonal downwards.
    fn column<T: Scalar<Real = R>>(&self, col: usize, part: usize) -> &[R] {
        let (own, others) = (self.own(), self.relative.len());
        match col.checked_sub(own) {
            Some(other) => column_part::<T>(self.schur, others, other, part),
            None => {
                let before = col * (own + others) - col * col.saturating_sub(1) / 2;
                let len = own + others - col;
                &self.left.columns[T::PARTS * before + part * len..][..len]
            }
        }
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
            for col in child.first_at(from)..child.first_at(from + strip.width) {
                let runs = &child.runs[child.runs.partition_point(|run| run.from + run.len <= col)..];
                for part in 0..T::PARTS {
                    let start = ((child.place(col) - from) * T::PARTS + part) * strip.stride;
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
    each(if numbers < SHARE_FROM { 1 } else { threads }, strips.collect(), work);
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

/// Real numbers in the strips of a triangle of this order.
pub(crate) fn schur_len<T: Scalar>(order: usize) -> usize {
    let whole = order / STRIP;
    let last = order - whole * STRIP;
    column_start::<T>(order, whole * STRIP) + T::PARTS * last * last
}

/// Where a column of a triangle begins in its strips: at the row at which its strip begins.
fn column_start<T: Scalar>(order: usize, col: usize) -> usize {
    let strip = col / STRIP;
    let before = strip * STRIP * order - STRIP * STRIP * (strip * strip.saturating_sub(1) / 2);
    T::PARTS * (before + (col - strip * STRIP) * (order - strip * STRIP))
}

/// One part of a column from its diagonal downwards.
fn column_part<T: Scalar>(values: &[T::Real], order: usize, col: usize, part: usize) -> &[T::Real] {
    let strip = col / STRIP * STRIP;
    let start = column_start::<T>(order, col) + part * (order - strip);
    &values[start + col - strip..start + order - strip]
}

/// The strips of a triangle of this order, to be written for the first time or changed.
pub(crate) fn schur_strips<T: Scalar>(
    values: &mut [T::Real],
    order: usize,
    fresh: bool,
) -> impl Iterator<Item = Strip<'_, T>> {
    let mut rest = values;
    (0..order).step_by(STRIP).map(move |first| {
        let (width, stride) = (STRIP.min(order - first), order - first);
        let (values, behind) = std::mem::take(&mut rest).split_at_mut(T::PARTS * width * stride);
        rest = behind;
        Strip { first, width, stride, fresh, values }
    })
}
