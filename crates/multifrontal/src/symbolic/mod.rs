//! Everything about a pattern that no number changes: ordering, fronts, and what a factorisation will cost.

mod costs;
mod fronts;
mod pattern;

pub(crate) use pattern::Lower;
pub use pattern::PatternError;

use crate::Options;
use crate::branch::Branch;
use crate::factor::Node;
use crate::ordering;
use crate::packed_lower::PackedLower;
use crate::scalar::Scalar;
use std::ops::Range;

/// Marks a front without parent.
pub(crate) const NO_PARENT: usize = usize::MAX;

/// How rows are ordered for elimination.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Ordering {
    /// Minimum degree or nested dissection of the compressed graph, whichever costs fewer operations.
    #[default]
    Automatic,
    /// Approximate minimum degree.
    MinimumDegree,
    /// Nested dissection.
    NestedDissection,
    /// The rows in the order in which they shall be eliminated (subtrees are still put in one piece).
    Given(Vec<usize>),
}

/// One front: columns that are eliminated together, and the rows that this changes.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    /// Position of its first own column.
    pub(crate) first: usize,
    /// How many columns of its own.
    pub(crate) pivots: usize,
    /// Its other rows, in [`Symbolic::rows`].
    pub(crate) rows: Range<usize>,
    pub(crate) parent: usize,
}

impl Shape {
    pub(crate) fn own(&self) -> Range<usize> {
        self.first..self.first + self.pivots
    }

    pub(crate) fn order(&self) -> usize {
        self.pivots + self.rows.len()
    }

    /// Numbers of its own columns, as they are stored.
    fn panel(&self) -> usize {
        PackedLower::new(self.order()).start::<f64>(self.pivots)
    }
}

/// An entry of the matrix: where its value is, and its row in the front.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) value: u32,
    pub(crate) row: u32,
}

/// Symbolic factorisation of a symmetric pattern.
#[derive(Debug, Clone)]
pub struct Symbolic {
    pub(crate) pattern: Lower,
    /// Row of the matrix at each position of the elimination.
    pub(crate) order: Vec<u32>,
    /// Children before parents, subtrees in one piece.
    pub(crate) fronts: Vec<Shape>,
    /// Positions of the rows of all fronts, ascending in each.
    pub(crate) rows: Vec<u32>,
    /// Where these rows are in the parent's front.
    pub(crate) relative: Vec<u32>,
    /// Entries of each position's column.
    pub(crate) entry_start: Vec<usize>,
    pub(crate) entries: Vec<Entry>,
    /// Children of each front, ascending: those of the k-th from `child_start[k]` on.
    child_start: Vec<usize>,
    children: Vec<u32>,
    /// Number of ancestors of each front.
    depth: Vec<u32>,
    /// Subtrees that can be worked on at the same time; fronts in none of them come after all of them.
    pub(crate) subtrees: Vec<Range<usize>>,
}

impl Symbolic {
    /// Analyses the lower triangle of a symmetric n × n matrix, stored by columns: `col_ptr[j]..col_ptr[j + 1]` are the
    /// places of column j in `row_idx`. Rows may come in any order, and each once: [`SymmetricMatrix`](crate::SymmetricMatrix) adds
    /// up what comes several times.
    ///
    /// # Errors
    /// [`PatternError`] where the columns do not make a lower triangle, or are too many, or where
    /// [`Ordering::Given`] is no permutation.
    pub fn new(
        dim: usize,
        col_ptr: &[usize],
        row_idx: &[usize],
        options: &Options,
    ) -> Result<Self, PatternError> {
        let pattern = Lower::new(dim, col_ptr, row_idx)?;
        let ordering = &options.ordering;
        if let Ordering::Given(order) = ordering {
            pattern::check_permutation(dim, order)?;
        }
        let threads = options.threads.if_worth(dim >= ordering::MIN_SHARED_VERTICES);
        let (graph, elimination) = threads.run(|team| ordering::order(&pattern, ordering, team.size));
        Ok(fronts::build(&pattern, &graph, &elimination).unwrap_or_else(|| {
            // Two rows were taken for alike that are not: every row for itself then.
            let order = graph.rows_in(elimination.steps());
            let (graph, elimination) = ordering::order(&pattern, &Ordering::Given(order), 1);
            fronts::build(&pattern, &graph, &elimination).expect("a graph of all entries has them all")
        }))
    }

    /// Number of rows n.
    pub fn dim(&self) -> usize {
        self.pattern.dim
    }

    /// The rows in the order of their elimination: the k-th is row `order()[k]`.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Entries of L on and below its diagonal, zeros that fronts add included.
    pub fn factor_entries(&self) -> usize {
        self.fronts.iter().map(|front| front.pivots * (2 * front.order() - front.pivots + 1) / 2).sum()
    }

    /// Multiplications and additions of the factorisation, complex or real ones as the matrix is: Σ over columns
    /// of (entries below)².
    pub fn flops(&self) -> f64 {
        self.fronts.iter().map(costs::flops).sum()
    }

    /// Where the columns of L of each front are among those of all, if no pivot is delayed.
    pub(crate) fn places<T: Scalar>(&self) -> Vec<Range<usize>> {
        let mut end = 0;
        let place = |front: &Shape| {
            let start = end;
            end += T::PARTS * front.panel();
            start..end
        };
        self.fronts.iter().map(place).collect()
    }

    /// Bytes that the factor keeps, if no pivot is delayed.
    pub fn factor_bytes<T: Scalar>(&self) -> usize {
        let scalars: usize = self.fronts.iter().map(Shape::panel).sum();
        let row = size_of::<[T; 2]>() + size_of::<T::Real>() + size_of::<u32>();
        // At most one for each subtree and for each front above them: what it is above, and what it changes there.
        let branch = |root: usize| size_of::<Branch>() + size_of::<usize>() + size_of_val(self.rows_of(root));
        let in_subtrees = |front: usize| {
            let at = self.subtrees.partition_point(|subtree| subtree.end <= front);
            self.subtrees.get(at).is_some_and(|subtree| subtree.contains(&front))
        };
        let roots = self.subtrees.iter().map(|subtree| subtree.end - 1);
        let above = (0..self.fronts.len()).filter(|&front| !in_subtrees(front));
        scalars * size_of::<T>()
            + self.rows.len() * size_of::<u32>()
            + self.fronts.len() * size_of::<Node<T>>()
            + self.dim() * row
            + roots.chain(above).map(branch).sum::<usize>()
    }

    /// Bytes that a factorisation by one worker needs beyond the factor, at most, if no pivot is delayed.
    pub fn working_bytes<T: Scalar>(&self) -> usize {
        // The pivots, their blocks and rows a second time, and the scaling by rows.
        let row = size_of::<[T; 2]>() + 2 * size_of::<f64>() + 4 * size_of::<u32>();
        costs::working_scalars(self) * size_of::<T>()
            + costs::packed(self) * T::PRODUCTS * size_of::<T::Real>()
            + self.rows.len() * size_of::<u32>()
            // What a front gave, what it left, and the node that comes of it.
            + self.fronts.len() * 4 * size_of::<Node<T>>()
            + self.dim() * row
    }

    /// Bytes that this analysis keeps.
    pub fn bytes(&self) -> usize {
        let pattern = size_of_val(&*self.pattern.col_ptr) + size_of_val(&*self.pattern.row_idx);
        let entries = size_of_val(&*self.entry_start) + size_of_val(&*self.entries);
        let tree = size_of_val(&*self.child_start) + size_of_val(&*self.children) + size_of_val(&*self.depth);
        let rows = size_of_val(&*self.order) + size_of_val(&*self.rows) + size_of_val(&*self.relative);
        pattern + entries + tree + rows + size_of_val(&*self.fronts) + size_of_val(&*self.subtrees)
    }

    /// Whether another thread brings more than it costs to a factorisation.
    pub(crate) fn is_worth_sharing(&self) -> bool {
        self.flops() >= costs::MIN_SHARED_MULTIPLICATIONS
    }

    /// Multiplications of each front and all below it.
    pub(crate) fn work(&self) -> Vec<f64> {
        costs::work(&self.fronts)
    }

    pub(crate) fn children_of(&self, front: usize) -> &[u32] {
        &self.children[self.child_start[front]..self.child_start[front + 1]]
    }

    /// The subtree that is worked on in one piece and has this front as its root.
    pub(crate) fn subtree_of(&self, root: usize) -> Option<Range<usize>> {
        let at = self.subtrees.binary_search_by_key(&(root + 1), |subtree| subtree.end).ok()?;
        Some(self.subtrees[at].clone())
    }

    /// Whether a front is at an even or an odd depth.
    pub(crate) fn parity(&self, front: usize) -> usize {
        self.depth[front] as usize % 2
    }

    /// The most numbers of Schur complements that are kept at even and at odd depths while one thread goes through
    /// all fronts, or one of several through any subtree.
    pub(crate) fn stacks(&self, threads: usize) -> [usize; 2] {
        if threads == 1 {
            return costs::stacks(self, 0..self.fronts.len());
        }
        let each = self.subtrees.iter().map(|subtree| costs::stacks(self, subtree.clone()));
        each.fold([0; 2], |most, it| [most[0].max(it[0]), most[1].max(it[1])])
    }

    pub(crate) fn rows_of(&self, front: usize) -> &[u32] {
        &self.rows[self.fronts[front].rows.clone()]
    }

    /// How many of a front's rows are candidates of its parent.
    pub(crate) fn moved(&self, front: usize) -> usize {
        let own = self.fronts.get(self.fronts[front].parent).map_or(0, |parent| parent.pivots);
        self.relative_of(front).partition_point(|&place| (place as usize) < own)
    }

    /// Where a front's rows are in its parent's.
    pub(crate) fn relative_of(&self, front: usize) -> &[u32] {
        &self.relative[self.fronts[front].rows.clone()]
    }
}
