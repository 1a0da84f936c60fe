//! What children leave is added to the front of their parent.

use super::{Front, Kept, Stack};
use crate::kernel::{STRIP, Strip};
use crate::scalar::{Real, Scalar};
use crate::threads::each;

/// Numbers of a Schur complement below which another thread costs more than it brings.
const SHARE_FROM: usize = 50_000;

/// What the elimination of a front leaves to its parent.
#[derive(Debug)]
pub(crate) struct Contribution<R> {
    /// Positions of the candidates that could not be eliminated.
    pub(crate) delayed: Vec<u32>,
    /// The parts of their columns from the diagonal downwards, one after the other.
    columns: Vec<R>,
    /// The Schur complement of the other rows, in strips of columns from their diagonals downwards.
    pub(crate) schur: Kept<R>,
}

/// Rows of a child in its parent's front.
pub(crate) struct Places<'a> {
    /// Where its delayed candidates begin.
    pub(crate) base: usize,
    /// How many of the parent's candidates are delayed ones.
    pub(crate) delayed: usize,
    /// Places of its other rows behind these.
    pub(crate) relative: &'a [u32],
}

/// What a child left, and where it goes.
pub(crate) struct Child<'a, R> {
    pub(crate) left: &'a Contribution<R>,
    pub(crate) schur: &'a [R],
    pub(crate) places: Places<'a>,
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

    /// Adds what is the parent's candidates' to its panel.
    pub(crate) fn add_to_panel<T: Scalar<Real = R>>(
        &self,
        front: &mut Front<'_, T>,
        schur: &[R],
        places: &Places<'_>,
    ) {
        let (own, others, step) = (self.delayed.len(), places.relative.len(), front.step());
        let runs = runs(places);
        let mut columns = self.columns.as_slice();
        for k in 0..own {
            let col = places.base + k;
            for part in 0..T::PARTS {
                let (head, rest) = columns.split_at(own - k);
                let (tail, rest) = rest.split_at(others);
                columns = rest;
                let column = &mut front.panel[col * step + part * front.stride..][..front.stride];
                add(&mut column[col..], head);
                add_runs(column, 0, tail, 0, &runs);
            }
        }
        for (j, place) in places.columns().take_while(|&(_, place)| place < front.candidates) {
            let runs = &runs[runs.partition_point(|run| run.from + run.len <= j)..];
            for part in 0..T::PARTS {
                let column = &mut front.panel[place * step + part * front.stride..][..front.stride];
                add_runs(column, 0, column_part::<T>(schur, others, j, part), j, runs);
            }
        }
    }
}

/// Adds what is not the parent's candidates' to its Schur complement, strip after strip.
pub(crate) fn add_to_schur<T: Scalar>(
    target: &mut [T::Real],
    order: usize,
    candidates: usize,
    children: &[Child<'_, T::Real>],
    threads: usize,
) {
    let runs: Vec<_> = children.iter().map(|child| runs(&child.places)).collect();
    let threads = if target.len() < SHARE_FROM { 1 } else { threads };
    each(threads, schur_strips::<T>(target, order, false).collect(), |strip| {
        let from = candidates + strip.first;
        for (Child { schur, places, .. }, runs) in children.iter().zip(&runs) {
            let others = places.relative.len();
            let first = places.relative.partition_point(|&place| places.delayed + (place as usize) < from);
            let columns = places.columns().skip(first);
            for (j, place) in columns.take_while(|&(_, place)| place < from + strip.width) {
                let runs = &runs[runs.partition_point(|run| run.from + run.len <= j)..];
                for part in 0..T::PARTS {
                    let start = ((place - from) * T::PARTS + part) * strip.stride;
                    let column = &mut strip.values[start..start + strip.stride];
                    add_runs(column, from, column_part::<T>(schur, others, j, part), j, runs);
                }
            }
        }
    });
}

impl Places<'_> {
    /// The columns of the child's Schur complement, and where they are in the parent's front.
    fn columns(&self) -> impl Iterator<Item = (usize, usize)> {
        self.relative.iter().map(|&place| self.delayed + place as usize).enumerate()
    }
}

/// Neighbouring rows of a child that are neighbours in its parent too.
#[derive(Clone, Copy)]
struct Run {
    from: usize,
    to: usize,
    len: usize,
}

fn runs(places: &Places<'_>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (from, to) in places.columns() {
        match runs.last_mut() {
            Some(run) if run.to + run.len == to => run.len += 1,
            _ => runs.push(Run { from, to, len: 1 }),
        }
    }
    runs
}

/// Adds the rows from `first` on of a child's column to a column that begins at row `start` of the front.
fn add_runs<R: Real>(column: &mut [R], start: usize, source: &[R], first: usize, runs: &[Run]) {
    for run in runs {
        let skip = first.saturating_sub(run.from);
        let (from, to) = (run.from + skip - first, run.to + skip - start);
        add(&mut column[to..], &source[from..from + run.len - skip]);
    }
}

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
pub(super) fn schur_strips<T: Scalar>(
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
