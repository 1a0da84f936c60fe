//! The numeric factorisation: front after front, subtrees at the same time.

use crate::front::{Contribution, Elimination, Front, Places, Stack, eliminate, schur_len};
use crate::part::Part;
use crate::scalar::Scalar;
use crate::symbolic::Symbolic;
use crate::threads::{map, with};
use crate::{FactorError, scaling};
use std::ops::Range;

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
        Self { threads: 1, threshold: 0.01 }
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
    /// Subtrees, and last what is above all of them.
    pub(crate) parts: Vec<Part>,
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
    /// L as its front left it: columns of real parts with those of the imaginary parts behind; what is on the
    /// diagonal and above it means nothing.
    pub(crate) values: Vec<T::Real>,
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
}

/// What an elimination gives: positions are those of the analysis.
struct Eliminated<T: Scalar> {
    pivots: Vec<u32>,
    d: Vec<[T; 2]>,
    below: Vec<u32>,
    values: Vec<T::Real>,
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
        let scale = scaling::scaling(&self.pattern, values)?;
        let bytes = self.factor_bytes::<T>().saturating_add(self.working_bytes::<T>());
        // Asked for and given back: whether there is as much, before anything is done.
        Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| FactorError::OutOfMemory)?;
        let scale: Vec<T::Real> = self.order.iter().map(|&row| scale[row as usize]).collect();
        let run = Run { symbolic: self, values, scale: &scale, options };
        let eliminated = with(options.threads, || run.all());
        run.finish(eliminated)
    }
}

/// Fronts of a subtree, what they gave, and what its root leaves.
type Subtree<T> = (Range<usize>, Vec<Eliminated<T>>, Option<Contribution<<T as Scalar>::Real>>);

/// One factorisation.
struct Run<'a, T: Scalar> {
    symbolic: &'a Symbolic,
    values: &'a [T],
    scale: &'a [T::Real],
    options: &'a Options,
}

/// Buffers of one thread.
struct Worker<T: Scalar> {
    /// Schur complements of fronts at even and at odd depths.
    stacks: [Stack<T::Real>; 2],
    elimination: Elimination<T>,
}

type Pending<T> = Vec<Option<Contribution<<T as Scalar>::Real>>>;

impl<T: Scalar> Run<'_, T> {
    fn worker(&self, threads: usize, fronts: Range<usize>) -> Worker<T> {
        let stacks = self.symbolic.stacks(fronts).map(|len| Stack::new(T::PARTS * len));
        Worker { stacks, elimination: Elimination::new(self.options.threshold, threads) }
    }

    /// All fronts in their order.
    fn all(&self) -> Vec<Eliminated<T>> {
        let fronts = self.symbolic.fronts.len();
        let mut eliminated: Vec<Option<Eliminated<T>>> = (0..fronts).map(|_| None).collect();
        let mut pending: Pending<T> = (0..fronts).map(|_| None).collect();
        let threads = self.options.threads.max(1);
        if threads > 1 {
            let subtrees = self.symbolic.subtrees.clone();
            for (range, done, contribution) in map(threads, subtrees, |range| self.subtree(range)) {
                pending[range.end - 1] = contribution;
                eliminated[range].iter_mut().zip(done).for_each(|(slot, done)| *slot = Some(done));
            }
        }
        let left = eliminated.iter().position(Option::is_none).unwrap_or(fronts);
        let mut worker = self.worker(threads, left..fronts);
        for front in left..fronts {
            if eliminated[front].is_none() {
                let (done, contribution) = self.front(front, &mut pending, 0, &mut worker);
                eliminated[front] = Some(done);
                pending[front] = contribution;
            }
        }
        eliminated.into_iter().flatten().collect()
    }

    fn subtree(&self, range: Range<usize>) -> Subtree<T> {
        let mut worker = self.worker(1, range.clone());
        let mut pending: Pending<T> = range.clone().map(|_| None).collect();
        let done = range.clone().map(|front| {
            let (eliminated, contribution) = self.front(front, &mut pending, range.start, &mut worker);
            pending[front - range.start] = contribution;
            eliminated
        });
        let done = done.collect();
        // The others have been taken by their parents.
        let stack = &mut worker.stacks[self.symbolic.parity(range.end - 1)];
        let left = pending.pop().flatten().map(|root| root.taken_from(stack));
        (range, done, left)
    }

    /// Assembles one front from the matrix and its children, and eliminates its columns.
    fn front(
        &self,
        k: usize,
        pending: &mut Pending<T>,
        offset: usize,
        worker: &mut Worker<T>,
    ) -> (Eliminated<T>, Option<Contribution<T::Real>>) {
        let symbolic = self.symbolic;
        let shape = &symbolic.fronts[k];
        let children = symbolic.children_of(k).iter().map(|&child| child as usize);
        let children: Vec<_> =
            children.filter_map(|child| Some((child, pending[child - offset].take()?))).collect();
        let mut ids: Vec<u32> = children.iter().flat_map(|(_, child)| &child.delayed).copied().collect();
        let delayed = ids.len();
        ids.extend(shape.own().map(|position| position as u32));
        ids.extend(symbolic.rows_of(k));
        let (candidates, others) = (delayed + shape.pivots, shape.rows.len());
        let stride = padded(ids.len());
        let mut values = vec![T::Real::default(); T::PARTS * stride * candidates];
        let parity = symbolic.parity(k);
        let [even, odd] = &mut worker.stacks;
        let (own, below) = if parity == 0 { (even, odd) } else { (odd, even) };
        let mut schur = own.push(schur_len::<T>(others));
        let target = own.values_of_mut(&mut schur);

        let mut front = Front { ids, candidates, panel: &mut values, stride };
        self.add_entries(&mut front, k, delayed);
        let mut base = 0;
        let places: Vec<_> = children
            .iter()
            .map(|(child, contribution)| {
                let relative = &symbolic.relative[symbolic.fronts[*child].rows.clone()];
                let places = Places { base, delayed, relative };
                base += contribution.delayed.len();
                places
            })
            .collect();
        for ((_, child), places) in children.iter().zip(&places) {
            child.add_to_panel(&mut front, below.values_of(&child.schur), places);
        }
        let d = eliminate(&mut front, target, &mut worker.elimination);
        for ((_, child), places) in children.iter().zip(&places) {
            child.add_to_schur::<T>(target, others, candidates, below.values_of(&child.schur), places);
        }
        children.iter().for_each(|(_, child)| below.pop(&child.schur));

        let (pivots, rest) = front.ids.split_at(d.len());
        let contribution = (!rest.is_empty()).then(|| Contribution::new(&front, d.len(), schur));
        let (pivots, below) = (pivots.to_vec(), rest.to_vec());
        if d.len() < candidates {
            values.truncate(T::PARTS * stride * d.len());
            values.shrink_to_fit();
        }
        (Eliminated { pivots, below, d, values, stride }, contribution)
    }

    /// The entries of the matrix in the front's own columns, scaled.
    fn add_entries(&self, front: &mut Front<'_, T>, k: usize, delayed: usize) {
        let symbolic = self.symbolic;
        for (j, position) in symbolic.fronts[k].own().enumerate() {
            let entries = symbolic.entry_start[position]..symbolic.entry_start[position + 1];
            for entry in &symbolic.entries[entries] {
                let row = delayed + entry.row as usize;
                let scale = self.scale[position] * self.scale[front.ids[row] as usize];
                let parts = self.values[entry.value as usize].scale(scale).parts();
                for part in 0..T::PARTS {
                    front.part_mut(delayed + j, part, 0)[row] += parts[part];
                }
            }
        }
    }

    /// Numbers the pivots in the order in which they came to be.
    fn finish(&self, eliminated: Vec<Eliminated<T>>) -> Result<Factor<T>, FactorError> {
        let symbolic = self.symbolic;
        let dim = symbolic.dim();
        let order: Vec<u32> = eliminated.iter().flat_map(|front| &front.pivots).copied().collect();
        if order.len() < dim {
            let mut left = vec![true; dim];
            order.iter().for_each(|&position| left[position as usize] = false);
            let position = left.iter().position(|&left| left).unwrap_or_default();
            let row = symbolic.order[position] as usize;
            return Err(FactorError::Singular { row, deficiency: dim - order.len() });
        }
        let scale = order.iter().map(|&position| self.scale[position as usize]).collect();
        let mut new = vec![0u32; dim];
        order.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
        let mut inertia = Inertia::default();
        let (mut delayed, mut pairs, mut first) = (0, 0, 0);
        let mut firsts = Vec::with_capacity(eliminated.len());
        let mut nodes = Vec::with_capacity(eliminated.len());
        for (front, shape) in eliminated.into_iter().zip(&symbolic.fronts) {
            delayed += front.below.len() - shape.rows.len();
            let inverse = inverse(&front.d, &mut inertia, &mut pairs);
            let rows = front.below.iter().map(|&position| new[position as usize]).collect();
            firsts.push(first);
            first += front.pivots.len();
            nodes.push(Node { first: 0, inverse, rows, values: front.values, stride: front.stride });
        }
        inertia.positive = dim - inertia.negative;
        let parts = Part::of(&symbolic.subtrees, &firsts, &mut nodes, dim);
        let order = order.iter().map(|&position| symbolic.order[position as usize]).collect();
        Ok(Factor { order, scale, nodes, parts, inertia, delayed, pairs })
    }
}

impl<T: Scalar> Factor<T> {
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
            node.values.len() * size_of::<T::Real>()
                + node.inverse.len() * size_of::<[T; 2]>()
                + node.rows.len() * size_of::<u32>()
        };
        self.nodes.iter().map(node).sum::<usize>() + self.dim() * (size_of::<u32>() + size_of::<T::Real>())
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
