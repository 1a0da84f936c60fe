//! The numeric factorisation: front after front, subtrees at the same time.

use crate::front::{
    Child, Contribution, Elimination, Front, Stack, add_children, each_strip, eliminate, schur_len,
    schur_strips, strips,
};
use crate::kernel::Strip;
use crate::memory::Memory;
use crate::part::Part;
use crate::scalar::Scalar;
use crate::symbolic::{ROOT, Symbolic};
use crate::threads::{Idle, awake, map, with};
use crate::{FactorError, scaling};
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

/// How a matrix is factorised.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Threads to work with. The numbers of the factor do not depend on it.
    pub threads: usize,
    /// No entry of L is larger than 1/threshold; between 0 and 1/2. Larger is safer and delays more pivots.
    pub threshold: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { threads: 1, threshold: 0.1 }
    }
}

/// Signs of the eigenvalues, by Sylvester's law of inertia those of D; of a complex matrix only their number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inertia {
    /// Positive eigenvalues of a real matrix, all of a complex one.
    pub positive: usize,
    /// Negative eigenvalues of a real matrix.
    pub negative: usize,
}

/// P S A S Pᵀ = L D Lᵀ.
#[derive(Debug)]
pub struct Factor<T: Scalar> {
    /// Row of the matrix at each position.
    pub(crate) order: Vec<u32>,
    /// S, by position.
    pub(crate) scale: Vec<T::Real>,
    pub(crate) nodes: Vec<Node<T>>,
    /// Columns of L of all nodes that came with no more of them than foreseen.
    values: Memory<T::Real>,
    /// What can be solved with at the same time, parts below before those above.
    pub(crate) parts: Vec<Part>,
    /// Parts that are below no other.
    pub(crate) roots: Vec<usize>,
    inertia: Inertia,
    delayed: usize,
    pairs: usize,
}

/// The columns of L and D that one front gave.
#[derive(Debug)]
pub(crate) struct Node<T: Scalar> {
    /// Place of its first pivot in its part.
    pub(crate) first: usize,
    /// Inverse of D: diagonal, and what is below it in a block of two.
    pub(crate) inverse: Vec<[T; 2]>,
    /// Places of its other rows in its part.
    pub(crate) rows: Vec<u32>,
    /// Where its columns of L are in the factor's.
    columns: Range<usize>,
    /// Its columns of L where delayed candidates made them too many for that place; else empty.
    more: Vec<T::Real>,
    /// From one part of a column to the next.
    pub(crate) stride: usize,
}

impl<T: Scalar> Node<T> {
    pub(crate) fn pivots(&self) -> usize {
        self.inverse.len()
    }

    pub(crate) fn order(&self) -> usize {
        self.pivots() + self.rows.len()
    }

    /// How many numbers its columns of L are.
    pub(crate) fn numbers(&self) -> usize {
        T::PARTS * self.stride * self.pivots()
    }
}

/// What an elimination gives: positions are those of the analysis.
struct Eliminated<T: Scalar> {
    pivots: Vec<u32>,
    d: Vec<[T; 2]>,
    below: Vec<u32>,
    more: Vec<T::Real>,
    stride: usize,
}

impl Symbolic {
    /// Factorises the matrix with these values, in the order of the pattern's entries.
    ///
    /// # Errors
    /// [`FactorError`] where there are more or fewer values than entries, where one is not finite, where the
    /// matrix is exactly singular, or where the factor does not fit into memory.
    ///
    /// # Limits
    /// A matrix that is singular but for roundoff is factorised: its solutions show it.
    pub fn factor<T: Scalar>(&self, values: &[T], options: &Options) -> Result<Factor<T>, FactorError> {
        T::factor(self, values, options)
    }
}

pub(crate) fn factor<T: Scalar>(
    symbolic: &Symbolic,
    values: &[T],
    options: &Options,
) -> Result<Factor<T>, FactorError> {
    let bytes = symbolic.factor_bytes::<T>().saturating_add(symbolic.working_bytes::<T>());
    // Asked for and given back: whether there is as much, before anything is done.
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| FactorError::OutOfMemory)?;
    let threads = symbolic.threads(options);
    with(threads, || {
        let scale = scaling::scaling(&symbolic.pattern, values, threads)?;
        let scale: Vec<T::Real> = symbolic.order.iter().map(|&row| scale[row as usize]).collect();
        let threshold = options.threshold;
        let stacks = symbolic.stacks(threads);
        let places = symbolic.places::<T>();
        let mut columns = Memory::zeros(places.last().map_or(0, |place| place.end));
        let room = room(&mut columns, &places);
        let run =
            Run { symbolic, values, scale: &scale, threshold, threads, stacks, room, idle: Idle::default() };
        let eliminated = run.all();
        finish(symbolic, &scale, eliminated, places, columns)
    })
}

/// One factorisation.
struct Run<'a, T: Scalar> {
    symbolic: &'a Symbolic,
    values: &'a [T],
    scale: &'a [T::Real],
    threshold: f64,
    threads: usize,
    /// Numbers that are kept at even and at odd depths in whatever one thread does.
    stacks: [usize; 2],
    /// For the columns of each front.
    room: Vec<Mutex<&'a mut [T::Real]>>,
    idle: Idle<Elimination<T>>,
}

/// What each front gave, as it is done.
type Done<T> = [OnceLock<Eliminated<T>>];

/// What threads that work on the same tree need.
struct Shared<'a, T: Scalar> {
    /// Multiplications of each front and all below it.
    work: Vec<f64>,
    done: &'a Done<T>,
}

/// A front with what it left to its parent.
type Left<T> = (usize, Contribution<<T as Scalar>::Real>);

impl<T: Scalar> Run<'_, T> {
    /// All fronts.
    fn all(&self) -> Vec<Eliminated<T>> {
        let fronts = &self.symbolic.fronts;
        let done: Vec<_> = fronts.iter().map(|_| OnceLock::new()).collect();
        if self.threads == 1 {
            self.run(0..fronts.len(), &done);
        } else {
            let roots = (0..fronts.len()).filter(|&k| fronts[k].parent == ROOT).collect();
            self.branches(roots, &Shared { work: self.symbolic.work(), done: &done });
        }
        done.into_iter().filter_map(OnceLock::into_inner).collect()
    }

    /// Branches at the same time, the one with most work first; what they leave, in their order.
    fn branches(&self, mut roots: Vec<usize>, shared: &Shared<'_, T>) -> Vec<Left<T>> {
        roots.sort_by(|&a, &b| shared.work[b].total_cmp(&shared.work[a]));
        let left = map(self.threads, roots, |root| Some((root, self.tree(root, shared)?)));
        let mut left: Vec<_> = left.into_iter().flatten().collect();
        left.sort_unstable_by_key(|(root, _)| *root);
        left
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
                    break self.branches(several.iter().map(|&child| child as usize).collect(), shared);
                }
            }
        };
        for &k in chain.iter().rev() {
            let mut stacks = [Stack::default(), Stack::default()];
            let front = |with: &mut _| self.front(k, below, &mut stacks, with, done);
            let left = awake(self.threads, || self.with_idle(self.threads, front));
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

    /// The fronts of a subtree one after the other; what its root leaves.
    fn run(&self, range: Range<usize>, done: &Done<T>) -> Option<Contribution<T::Real>> {
        let symbolic = self.symbolic;
        let mut pending: Vec<Option<Contribution<T::Real>>> = range.clone().map(|_| None).collect();
        self.with_idle(1, |with| {
            let mut stacks = std::mem::take(&mut with.stacks);
            for (stack, len) in stacks.iter_mut().zip(self.stacks) {
                stack.clear(T::PARTS * len);
            }
            let root = range.end.checked_sub(1)?;
            let mut front = |k: usize, stacks: &mut _| {
                let children = symbolic.children_of(k).iter().map(|&child| child as usize);
                let children =
                    children.filter_map(|child| Some((child, pending[child - range.start].take()?)));
                let left = self.front(k, children.collect(), stacks, with, done);
                pending[k - range.start] = left;
            };
            (range.start..root).for_each(|k| front(k, &mut stacks));
            // What the root leaves goes elsewhere: it has a stack of its own.
            let parity = symbolic.parity(root);
            let own = std::mem::take(&mut stacks[parity]);
            front(root, &mut stacks);
            let left = pending.pop()?.map(|left| left.taken_from(&mut stacks[parity]));
            stacks[parity] = own;
            with.stacks = stacks;
            left
        })
    }

    /// Assembles one front from the matrix and its children, and eliminates its columns; what it leaves.
    fn front(
        &self,
        k: usize,
        children: Vec<Left<T>>,
        stacks: &mut [Stack<T::Real>; 2],
        with: &mut Elimination<T>,
        done: &Done<T>,
    ) -> Option<Contribution<T::Real>> {
        let symbolic = self.symbolic;
        let shape = &symbolic.fronts[k];
        let mut ids: Vec<u32> = children.iter().flat_map(|(_, child)| &child.delayed).copied().collect();
        let delayed = ids.len();
        ids.extend(shape.own().map(|position| position as u32));
        ids.extend(symbolic.rows_of(k));
        let (candidates, others) = (delayed + shape.pivots, shape.rows.len());
        let stride = padded(ids.len());
        let [even, odd] = stacks;
        let (own, below) = if symbolic.parity(k) == 0 { (even, odd) } else { (odd, even) };
        let mut schur = own.push(schur_len::<T>(others));
        let target = own.values_of_mut(&mut schur);
        let mut base = 0;
        let given = children.iter().map(|(child, left)| {
            let relative = &symbolic.relative[symbolic.fronts[*child].rows.clone()];
            let child = Child::new(left, below.values_of(&left.schur), base, delayed, relative);
            base += left.delayed.len();
            child
        });
        let given: Vec<_> = given.collect();

        let numbers = T::PARTS * stride * candidates;
        let room = std::mem::take(&mut *self.room[k].lock().unwrap_or_else(PoisonError::into_inner));
        let mut more = vec![T::Real::default(); if delayed > 0 { numbers } else { 0 }];
        let values = if delayed > 0 { more.as_mut_slice() } else { room };
        let threads = with.threads;
        each_strip(strips(values, stride, 0, candidates, threads), numbers, threads, |mut strip| {
            self.add_entries(&mut strip, k, &ids, delayed);
            let from = strip.first;
            add_children(&mut strip, from, &given);
        });
        let mut front = Front { ids, candidates, panel: values, stride };
        let d = eliminate(&mut front, target, with);
        let numbers = target.len();
        each_strip(schur_strips::<T>(target, others, false), numbers, threads, |mut strip| {
            let from = candidates + strip.first;
            add_children(&mut strip, from, &given);
        });
        children.iter().for_each(|(_, left)| below.pop(&left.schur));

        let (pivots, rest) = front.ids.split_at(d.len());
        let left = (!rest.is_empty()).then(|| Contribution::new(&front, d.len(), schur));
        let (pivots, below) = (pivots.to_vec(), rest.to_vec());
        if d.len() < candidates {
            more.truncate(T::PARTS * stride * d.len());
            more.shrink_to_fit();
        }
        // Every front comes once.
        let _ = done[k].set(Eliminated { pivots, below, d, more, stride });
        left
    }

    /// The entries of the matrix in a strip of the front's columns, scaled; its rows are at these positions.
    fn add_entries(&self, strip: &mut Strip<'_, T>, k: usize, ids: &[u32], delayed: usize) {
        let symbolic = self.symbolic;
        for col in strip.first.max(delayed)..strip.first + strip.width {
            let position = symbolic.fronts[k].first + col - delayed;
            let start = (col - strip.first) * T::PARTS * strip.stride;
            for entry in &symbolic.entries[symbolic.entry_start[position]..symbolic.entry_start[position + 1]]
            {
                let row = delayed + entry.row as usize;
                let scale = self.scale[position] * self.scale[ids[row] as usize];
                let parts = self.values[entry.value as usize].scale(scale).parts();
                for part in 0..T::PARTS {
                    strip.values[start + part * strip.stride + row - strip.first] += parts[part];
                }
            }
        }
    }
}

/// For the columns of each front its place.
fn room<'a, R>(columns: &'a mut [R], places: &[Range<usize>]) -> Vec<Mutex<&'a mut [R]>> {
    let mut rest = columns;
    let mut room = Vec::with_capacity(places.len());
    for place in places {
        let (here, behind) = std::mem::take(&mut rest).split_at_mut(place.len());
        rest = behind;
        room.push(Mutex::new(here));
    }
    room
}

/// Numbers the pivots in the order in which they came to be.
fn finish<T: Scalar>(
    symbolic: &Symbolic,
    scale: &[T::Real],
    eliminated: Vec<Eliminated<T>>,
    places: Vec<Range<usize>>,
    values: Memory<T::Real>,
) -> Result<Factor<T>, FactorError> {
    let dim = symbolic.dim();
    let order: Vec<u32> = eliminated.iter().flat_map(|front| &front.pivots).copied().collect();
    if order.len() < dim {
        let mut left = vec![true; dim];
        order.iter().for_each(|&position| left[position as usize] = false);
        let position = left.iter().position(|&left| left).unwrap_or_default();
        let row = symbolic.order[position] as usize;
        return Err(FactorError::Singular { row, deficiency: dim - order.len() });
    }
    let scale = order.iter().map(|&position| scale[position as usize]).collect();
    let mut new = vec![0u32; dim];
    order.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
    let mut inertia = Inertia::default();
    let (mut delayed, mut pairs, mut first) = (0, 0, 0);
    let mut firsts = Vec::with_capacity(eliminated.len());
    let mut nodes = Vec::with_capacity(eliminated.len());
    for ((front, shape), columns) in eliminated.into_iter().zip(&symbolic.fronts).zip(places) {
        delayed += front.below.len() - shape.rows.len();
        let inverse = inverse(&front.d, &mut inertia, &mut pairs);
        let rows = front.below.iter().map(|&position| new[position as usize]).collect();
        firsts.push(first);
        first += front.pivots.len();
        nodes.push(Node { first: 0, inverse, rows, columns, more: front.more, stride: front.stride });
    }
    inertia.positive = dim - inertia.negative;
    let (parts, roots) = Part::of(symbolic, &firsts, &mut nodes);
    let order = order.iter().map(|&position| symbolic.order[position as usize]).collect();
    Ok(Factor { order, scale, nodes, values, parts, roots, inertia, delayed, pairs })
}

impl<T: Scalar> Factor<T> {
    /// L of a node as its front left it: columns of real parts with those of the imaginary parts behind; what is on
    /// the diagonal and above it means nothing.
    pub(crate) fn columns_of<'a>(&'a self, node: &'a Node<T>) -> &'a [T::Real] {
        if node.more.is_empty() { &self.values[node.columns.clone()] } else { &node.more }
    }

    /// Number of rows n.
    pub fn dim(&self) -> usize {
        self.order.len()
    }

    /// How many eigenvalues of a real matrix are positive and negative.
    pub fn inertia(&self) -> Inertia {
        self.inertia
    }

    /// How often a column was left to the parent of its front.
    pub fn delayed(&self) -> usize {
        self.delayed
    }

    /// Pivots that are blocks of two.
    pub fn pairs(&self) -> usize {
        self.pairs
    }

    /// Bytes that this factor keeps.
    pub fn bytes(&self) -> usize {
        let node = |node: &Node<T>| {
            node.more.len() * size_of::<T::Real>()
                + node.inverse.len() * size_of::<[T; 2]>()
                + node.rows.len() * size_of::<u32>()
        };
        self.nodes.iter().map(node).sum::<usize>()
            + self.values.len() * size_of::<T::Real>()
            + self.dim() * (size_of::<u32>() + size_of::<T::Real>())
    }
}

/// A stride at which the columns of a tile do not fall onto the same lines of a cache.
pub(crate) fn padded(rows: usize) -> usize {
    if rows > 64 && rows.is_multiple_of(32) { rows + 4 } else { rows }
}

/// D⁻¹, counting on the way.
fn inverse<T: Scalar>(d: &[[T; 2]], inertia: &mut Inertia, pairs: &mut usize) -> Vec<[T; 2]> {
    let mut inverse = Vec::with_capacity(d.len());
    let mut k = 0;
    while k < d.len() {
        let [pivot, below] = d[k];
        if below == T::default() {
            inverse.push([T::ONE / pivot, T::default()]);
            inertia.negative += usize::from(pivot.is_negative());
            k += 1;
        } else {
            let [first, between, second] = crate::front::invert_pair([d[k], d[k + 1]]);
            inverse.extend([[first, between], [second, T::default()]]);
            // Of one sign where the determinant is positive.
            let both = ((first * second - between * between).is_negative(), first.is_negative());
            inertia.negative += match both {
                (true, _) => 1,
                (false, true) => 2,
                (false, false) => 0,
            };
            *pairs += 1;
            k += 2;
        }
    }
    inverse
}
