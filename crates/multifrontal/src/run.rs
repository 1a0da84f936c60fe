//! One factorisation: front after front, subtrees at the same time.

use crate::front::{
    Child, Contribution, Elimination, Front, Stack, add_children, each_strip, eliminate, strip_width,
};
use crate::kernel::{STRIP_COLUMNS, Strip};
use crate::packed_lower::PackedLower;
use crate::scalar::{Number, Scalar};
use crate::symbolic::{NO_PARENT, Symbolic};
use crate::threads::{Idle, Team, each};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// What a factorisation works on, and how.
pub(crate) struct Run<'a, T: Scalar> {
    symbolic: &'a Symbolic,
    values: &'a [T],
    scale: &'a [T::Real],
    threshold: f64,
    team: Team,
    /// Numbers that are kept at even and at odd depths in whatever one thread does.
    sizes: [usize; 2],
    /// Stacks of as many, one for each thread that is in a subtree.
    stacks: Idle<Stacks<T>>,
    /// Subtrees that are not finished yet.
    subtrees: AtomicUsize,
    /// The own columns of each front.
    panels: Vec<Mutex<Panel<'a, T::Real>>>,
    idle: Idle<Elimination<T>>,
}

/// Own columns of a front, where no candidates were delayed.
struct Panel<'a, R> {
    values: &'a mut [R],
    /// Whether the entries of the matrix are there.
    begun: bool,
}

impl<R> Default for Panel<'_, R> {
    fn default() -> Self {
        Self { values: &mut [], begun: false }
    }
}

/// What an elimination gives: positions are those of the analysis.
pub(crate) struct Eliminated<T: Scalar> {
    pub(crate) pivots: Vec<u32>,
    pub(crate) d: Vec<[T; 2]>,
    pub(crate) below: Vec<u32>,
    /// Its columns, where delayed candidates made them too many for their place.
    pub(crate) more: Vec<T::Real>,
}

/// What each front gave, as it is done.
type Done<T> = [OnceLock<Eliminated<T>>];

/// What threads that work on the same tree need.
struct Shared<'a, T: Scalar> {
    /// Multiplications of each front and all below it.
    work: Vec<f64>,
    done: &'a Done<T>,
}

/// Branches below the same front.
struct Meeting<T: Scalar> {
    /// What each has left, nothing or one, once it is done.
    arrived: Vec<Option<Vec<Left<T>>>>,
    /// What those have left that the front above has its columns of.
    added: Vec<Left<T>>,
    /// The next to be added, and whether somebody is about one.
    next: usize,
    busy: bool,
}

impl<T: Scalar> Meeting<T> {
    fn next_one(&mut self) -> Option<Vec<Left<T>>> {
        let left = self.arrived.get_mut(self.next)?.take()?;
        self.next += 1;
        Some(left)
    }
}

/// A front with what it left to its parent.
type Left<T> = (usize, Contribution<<T as Number>::Real>);

/// For what fronts leave, at even and at odd depths.
type Stacks<T> = [Stack<<T as Number>::Real>; 2];

impl<'a, T: Scalar> Run<'a, T> {
    /// With room for the columns of all fronts, and the place of each in it.
    pub(crate) fn new(
        symbolic: &'a Symbolic,
        values: &'a [T],
        scale: &'a [T::Real],
        threshold: f64,
        team: Team,
        (mut rest, places): (&'a mut [T::Real], &[Range<usize>]),
    ) -> Self {
        let panel = |place: &Range<usize>| {
            let (values, behind) = std::mem::take(&mut rest).split_at_mut(place.len());
            rest = behind;
            Mutex::new(Panel { values, begun: false })
        };
        let panels = places.iter().map(panel).collect();
        let (sizes, stacks, idle) = (symbolic.stacks(team.size), Idle::default(), Idle::default());
        let subtrees = AtomicUsize::new(symbolic.subtrees.len());
        Self { symbolic, values, scale, threshold, team, sizes, stacks, subtrees, panels, idle }
    }

    /// All fronts.
    pub(crate) fn all(&self) -> Vec<Eliminated<T>> {
        let fronts = &self.symbolic.fronts;
        let done: Vec<_> = fronts.iter().map(|_| OnceLock::new()).collect();
        if self.team.size == 1 {
            self.run(0..fronts.len(), &done);
        } else {
            let roots: Vec<usize> = (0..fronts.len()).filter(|&k| fronts[k].parent == NO_PARENT).collect();
            self.branches(NO_PARENT, &roots, &Shared { work: self.symbolic.work(), done: &done });
        }
        done.into_iter().filter_map(OnceLock::into_inner).collect()
    }

    /// Branches at the same time, the one with most work first; what they leave, in their order, once the front above
    /// them, if there is one, has its columns of that.
    fn branches(&self, above: usize, branches: &[usize], shared: &Shared<'_, T>) -> Vec<Left<T>> {
        let mut order: Vec<usize> = (0..branches.len()).collect();
        order.sort_by(|&a, &b| shared.work[branches[b]].total_cmp(&shared.work[branches[a]]));
        let meeting = Mutex::new(Meeting {
            arrived: branches.iter().map(|_| None).collect(),
            added: Vec::new(),
            next: 0,
            busy: false,
        });
        each(self.team.size, order, |at| {
            let left = self.tree(branches[at], shared).map(|left| (branches[at], left));
            self.arrive(above, at, left, &meeting);
        });
        meeting.into_inner().unwrap_or_else(PoisonError::into_inner).added
    }

    /// Adds to the front above what branches have left so far: in the order of the branches, so that sums do not depend
    /// on who is first.
    fn arrive(&self, above: usize, at: usize, left: Option<Left<T>>, meeting: &Mutex<Meeting<T>>) {
        let lock = || meeting.lock().unwrap_or_else(PoisonError::into_inner);
        let mut now = lock();
        now.arrived[at] = Some(left.into_iter().collect());
        let mut stacks = Stacks::<T>::default();
        while !now.busy
            && let Some(mut left) = now.next_one()
        {
            now.busy = true;
            // Who arrives meanwhile does not wait: this thread goes on with what is there then.
            drop(now);
            if above != NO_PARENT {
                self.add(above, &mut left, &mut stacks, self.team.size);
            }
            now = lock();
            now.busy = false;
            now.added.extend(left);
        }
    }

    /// The fronts under one and itself, branches at the same time; what it leaves.
    fn tree(&self, root: usize, shared: &Shared<'_, T>) -> Option<Contribution<T::Real>> {
        let (symbolic, done) = (self.symbolic, shared.done);
        // Where there is one child only, it goes on in a loop: a chain may be as long as the matrix.
        let mut chain = vec![root];
        let mut below = loop {
            let k = *chain.last().unwrap_or(&root);
            if let Some(range) = symbolic.subtree_of(k) {
                chain.pop();
                break self.run(range, done).map(|left| (k, left)).into_iter().collect();
            }
            match symbolic.children_of(k) {
                [only] => chain.push(*only as usize),
                several => {
                    let several: Vec<usize> = several.iter().map(|&child| child as usize).collect();
                    break self.branches(k, &several, shared);
                }
            }
        };
        for &k in chain.iter().rev() {
            let mut stacks = Stacks::<T>::default();
            let left = self.team.awake(|| {
                self.add(k, &mut below, &mut stacks, self.team.size);
                self.with_idle(self.team.size, |with| self.front(k, below, &mut stacks, with, done))
            });
            let stack = &mut stacks[symbolic.parity(k)];
            below = left.map(|left| (k, left.taken_from(stack))).into_iter().collect();
        }
        below.pop().map(|(_, left)| left)
    }

    /// Works with the buffers of an elimination that no thread has at the moment.
    fn with_idle<O>(&self, threads: usize, work: impl FnOnce(&mut Elimination<T>) -> O) -> O {
        self.idle.lend(
            || Elimination::new(self.threshold),
            |with| {
                with.threads = threads;
                work(with)
            },
        )
    }

    /// The fronts of a subtree one after the other, on free stacks; what its root leaves.
    fn run(&self, range: Range<usize>, done: &Done<T>) -> Option<Contribution<T::Real>> {
        self.stacks.lend(Stacks::<T>::default, |stacks| {
            for (stack, len) in stacks.iter_mut().zip(self.sizes) {
                stack.clear(T::PARTS * len);
            }
            let left = self.with_idle(1, |with| self.subtree(range, stacks, with, done));
            // The last ones are not needed again, and memory is.
            if self.subtrees.fetch_sub(1, Relaxed) <= self.team.size {
                *stacks = Stacks::<T>::default();
            }
            left
        })
    }

    fn subtree(
        &self,
        range: Range<usize>,
        stacks: &mut Stacks<T>,
        with: &mut Elimination<T>,
        done: &Done<T>,
    ) -> Option<Contribution<T::Real>> {
        let symbolic = self.symbolic;
        let mut pending: Vec<Option<Left<T>>> = range.clone().map(|_| None).collect();
        for k in range.clone() {
            let (parity, last) = (symbolic.parity(k), k + 1 == range.end);
            let children = symbolic.children_of(k).iter().map(|&child| child as usize - range.start);
            let children = children.filter_map(|child| pending[child].take()).collect();
            // What the root leaves goes elsewhere: it has a stack of its own.
            let others = last.then(|| std::mem::take(&mut stacks[parity]));
            let mut left = self.front(k, children, stacks, with, done).map(|left| (k, left));
            if let Some(others) = others {
                let left = left.map(|(_, left)| left.taken_from(&mut stacks[parity]));
                stacks[parity] = others;
                return left;
            }
            if range.contains(&symbolic.fronts[k].parent) {
                self.add(symbolic.fronts[k].parent, left.as_mut_slice(), stacks, 1);
            }
            pending[k - range.start] = left;
        }
        None
    }

    /// Adds to a front's own columns the entries of the matrix and what children left of these columns, each once; what
    /// they left of them is given back then.
    fn add(&self, k: usize, children: &mut [Left<T>], stacks: &mut Stacks<T>, threads: usize) {
        let (symbolic, shape) = (self.symbolic, &self.symbolic.fronts[k]);
        // No other thread waits for it: all that it is made of comes from this thread.
        let Panel { values, begun } = std::mem::take(&mut *self.panel(k));
        let stack = &mut stacks[1 - symbolic.parity(k)];
        let given =
            children.iter().map(|(child, left)| Child::new(left, stack, symbolic.relative_of(*child)));
        let given: Vec<_> = given.collect();
        let (numbers, width) = (values.len(), strip_width(shape.pivots, threads));
        let strips = PackedLower::new(shape.order()).strips(values, 0..shape.pivots, width, false);
        each_strip(strips, numbers, threads, |mut strip| {
            if !begun {
                self.add_entries(&mut strip, k);
            }
            let from = strip.first;
            add_children(&mut strip, from, &given);
        });
        for (child, left) in children {
            left.give_back::<T>(stack, symbolic.moved(*child), symbolic.rows_of(*child).len());
        }
        *self.panel(k) = Panel { values, begun: true };
    }

    fn panel(&self, k: usize) -> MutexGuard<'_, Panel<'a, T::Real>> {
        self.panels[k].lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Eliminates the columns of a front that has all that its children leave there; what it leaves.
    fn front(
        &self,
        k: usize,
        children: Vec<Left<T>>,
        stacks: &mut Stacks<T>,
        with: &mut Elimination<T>,
        done: &Done<T>,
    ) -> Option<Contribution<T::Real>> {
        let symbolic = self.symbolic;
        let shape = &symbolic.fronts[k];
        if !self.panel(k).begun {
            self.add(k, &mut [], stacks, with.threads);
        }
        let mut ids: Vec<u32> = children.iter().flat_map(|(_, child)| &child.delayed).copied().collect();
        let delayed = ids.len();
        ids.extend(shape.own().map(|position| position as u32));
        ids.extend(symbolic.rows_of(k));
        let (candidates, others) = (delayed + shape.pivots, shape.rows.len());
        let packed_lower = PackedLower::new(ids.len());
        let own = std::mem::take(&mut *self.panel(k)).values;
        let mut more =
            vec![T::Real::default(); if delayed > 0 { packed_lower.start::<T>(candidates) } else { 0 }];
        let mut front = if delayed > 0 {
            let mut front = Front { ids, candidates, panel: more.as_mut_slice(), packed_lower };
            move_behind(own, shape.order(), &mut front, delayed);
            let mut base = 0;
            for (child, left) in &children {
                left.add_delayed(&mut front, base, delayed, symbolic.relative_of(*child));
                base += left.delayed.len();
            }
            front
        } else {
            Front { ids, candidates, panel: own, packed_lower }
        };

        let [even, odd] = stacks;
        let (stack, below) = if symbolic.parity(k) == 0 { (even, odd) } else { (odd, even) };
        let complement = PackedLower::new(others);
        let mut schur = stack.push(complement.start::<T>(others));
        let target = stack.values_of_mut(&mut schur);
        let d = eliminate(&mut front, target, with);
        let given =
            children.iter().map(|(child, left)| Child::new(left, below, symbolic.relative_of(*child)));
        let (given, numbers): (Vec<_>, _) = (given.collect(), target.len());
        each_strip(
            complement.strips::<T>(target, 0..others, STRIP_COLUMNS, false),
            numbers,
            with.threads,
            |mut strip| {
                let from = shape.pivots + strip.first;
                add_children(&mut strip, from, &given);
            },
        );
        children.iter().for_each(|(_, left)| below.pop(&left.schur));

        let (pivots, rest) = front.ids.split_at(d.len());
        let left = (!rest.is_empty()).then(|| Contribution::new(&front, d.len(), schur));
        let (pivots, below) = (pivots.to_vec(), rest.to_vec());
        if d.len() < candidates {
            more.truncate(packed_lower.start::<T>(d.len()));
            more.shrink_to_fit();
        }
        // Every front comes once.
        let _ = done[k].set(Eliminated { pivots, below, d, more });
        left
    }

    /// The entries of the matrix in a strip of the front's own columns, scaled.
    fn add_entries(&self, strip: &mut Strip<'_, T>, k: usize) {
        let (symbolic, shape) = (self.symbolic, &self.symbolic.fronts[k]);
        let rows = symbolic.rows_of(k);
        for col in strip.first..strip.first + strip.width {
            let position = shape.first + col;
            let start = (col - strip.first) * T::PARTS * strip.stride;
            for entry in &symbolic.entries[symbolic.entry_start[position]..symbolic.entry_start[position + 1]]
            {
                let row = entry.row as usize;
                let other = row.checked_sub(shape.pivots).map_or(shape.first + row, |row| rows[row] as usize);
                let scale = self.scale[position] * self.scale[other];
                let parts = self.values[entry.value as usize].scale(scale).parts();
                for part in 0..T::PARTS {
                    strip.values[start + part * strip.stride + row - strip.first] += parts[part];
                }
            }
        }
    }
}

/// Copies a front's own columns to where they are behind delayed ones.
fn move_behind<T: Scalar>(own: &[T::Real], order: usize, front: &mut Front<'_, T>, delayed: usize) {
    let packed_lower = PackedLower::new(order);
    for (col, part) in (0..front.candidates - delayed).flat_map(|col| (0..T::PARTS).map(move |p| (col, p))) {
        let column = &own[packed_lower.part::<T>(col, part, col)];
        front.part_mut(delayed + col, part, delayed + col).copy_from_slice(column);
    }
}
