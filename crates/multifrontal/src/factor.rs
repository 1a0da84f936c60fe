//! The numeric factorisation from values to a factor; what is between is [`crate::run`]'s.

use crate::branch::Branch;
use crate::memory::Memory;
use crate::packed_lower::PackedLower;
use crate::run::{Eliminated, Run};
use crate::scalar::Scalar;
use crate::symbolic::Symbolic;
use crate::{FactorError, Options, scaling};
use std::ops::Range;

/// With this threshold there is still a pivot, or a block of two, in every matrix that is not singular.
const MAX_THRESHOLD: f64 = 0.5;

/// Signs of the eigenvalues, by Sylvester's law of inertia those of D; of a complex matrix only their number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
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
    /// What can be solved with at the same time, branches below before those above.
    pub(crate) branches: Vec<Branch>,
    /// Parts that are below no other.
    pub(crate) roots: Vec<usize>,
    inertia: Inertia,
    delayed: usize,
    pairs: usize,
}

/// The columns of L and D that one front gave.
#[derive(Debug)]
pub(crate) struct Node<T: Scalar> {
    /// Place of its first pivot in its branch.
    pub(crate) first: usize,
    /// Inverse of D: diagonal, and what is below it in a block of two.
    pub(crate) inverse: Vec<[T; 2]>,
    /// Places of its other rows in its branch.
    pub(crate) rows: Vec<u32>,
    /// Where its columns of L are in the factor's.
    columns: Range<usize>,
    /// Its columns of L where delayed candidates made them too many for that place; else empty.
    more: Vec<T::Real>,
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
        PackedLower::new(self.order()).start::<T>(self.pivots())
    }
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
    let given = options.threshold;
    let threshold = if given.is_nan() { MAX_THRESHOLD } else { given.clamp(0.0, MAX_THRESHOLD) };
    options.threads.if_worth(symbolic.is_worth_sharing()).run(|team| {
        let scale = scaling::scaling(&symbolic.pattern, values, team.size)?;
        let scale: Vec<T::Real> = symbolic.order.iter().map(|&row| scale[row as usize]).collect();
        let places = symbolic.places::<T>();
        let mut columns = Memory::zeros(places.last().map_or(0, |place| place.end));
        let run = Run::new(symbolic, values, &scale, threshold, team, (&mut columns, &places));
        let eliminated = run.all();
        finish(symbolic, &scale, eliminated, places, columns)
    })
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
        nodes.push(Node { first: 0, inverse, rows, columns, more: front.more });
    }
    inertia.positive = dim - inertia.negative;
    let (branches, roots) = Branch::of(symbolic, &firsts, &mut nodes);
    let order = order.iter().map(|&position| symbolic.order[position as usize]).collect();
    Ok(Factor { order, scale, nodes, values, branches, roots, inertia, delayed, pairs })
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
