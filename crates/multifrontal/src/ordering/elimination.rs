//! What an ordering costs, known before any number: elimination tree and counts of the factor.

use super::Graph;

const NO_STEP: u32 = u32::MAX;

/// The elimination of a graph's vertices in some order; a vertex stands for one or several rows.
pub(crate) struct Elimination {
    steps: Vec<Step>,
}

/// One vertex of the order.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    pub(crate) vertex: u32,
    /// Rows of the vertex.
    pub(crate) rows: u32,
    /// Rows of the factor below them.
    pub(crate) below: u32,
    /// The first later step that this one changes: its parent in the elimination tree.
    parent: u32,
}

impl Elimination {
    /// Elimination tree and counts from the subtree of each row, in time of the order of the factor's entries.
    ///
    /// J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134–172.
    pub(super) fn new(order: Vec<u32>, graph: &Graph) -> Self {
        let mut position = vec![0u32; order.len()];
        order.iter().enumerate().for_each(|(k, &vertex)| position[vertex as usize] = k as u32);
        let mut reached = vec![NO_STEP; order.len()];
        let step = |vertex| {
            let rows = graph.rows(vertex as usize).len() as u32;
            Step { vertex, rows, below: 0, parent: NO_STEP }
        };
        let mut steps: Vec<Step> = order.into_iter().map(step).collect();
        for k in 0..steps.len() {
            reached[k] = k as u32;
            let own = steps[k].rows;
            for &neighbour in graph.neighbours(steps[k].vertex as usize) {
                let mut at = position[neighbour as usize] as usize;
                while at < k && reached[at] != k as u32 {
                    reached[at] = k as u32;
                    let step = &mut steps[at];
                    step.below += own;
                    if step.parent == NO_STEP {
                        step.parent = k as u32;
                    }
                    at = step.parent as usize;
                }
            }
        }
        Self { steps }
    }

    /// Σ over columns of the factor of (entries)²: multiplications and additions of L Lᵀ.
    pub(super) fn flops(&self) -> f64 {
        let of = |step: &Step| (1..=step.rows).map(|own| f64::from(step.below + own).powi(2)).sum::<f64>();
        self.steps.iter().map(of).sum()
    }

    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The step's parent in the elimination tree.
    pub(crate) fn parent(&self, step: usize) -> Option<usize> {
        Some(self.steps[step].parent).filter(|&parent| parent != NO_STEP).map(|parent| parent as usize)
    }

    /// The same elimination with every subtree in one piece: only then are supernodes runs of columns.
    ///
    /// The child with most rows comes last, next to its parent, where amalgamation costs the fewest zeros.
    pub(super) fn postordered(self) -> Self {
        let n = self.steps.len();
        let mut ascending: Vec<usize> = (0..n).collect();
        ascending.sort_by_key(|&k| self.steps[k].below);
        let mut order = Vec::with_capacity(n);
        postorder(n, |k| self.parent(k), ascending.into_iter(), |k| order.push(k));
        let mut new = vec![NO_STEP; n];
        order.iter().enumerate().for_each(|(to, &from)| new[from] = to as u32);
        let renumber = |&from: &usize| {
            let step = self.steps[from];
            Step { parent: if step.parent == NO_STEP { NO_STEP } else { new[step.parent as usize] }, ..step }
        };
        Self { steps: order.iter().map(renumber).collect() }
    }
}

/// Visits the nodes of a forest, children before parents, siblings in the order in which they are listed.
pub(crate) fn postorder(
    n: usize,
    parent: impl Fn(usize) -> Option<usize>,
    listed: impl DoubleEndedIterator<Item = usize>,
    mut visit: impl FnMut(usize),
) {
    const NO_CHILD: usize = usize::MAX;
    // Lists of children; the one put in last comes first.
    let (mut first_child, mut sibling) = (vec![NO_CHILD; n + 1], vec![NO_CHILD; n]);
    for k in listed.rev() {
        let parent = parent(k).unwrap_or(n);
        sibling[k] = first_child[parent];
        first_child[parent] = k;
    }
    let mut path = vec![n];
    while let Some(&at) = path.last() {
        let child = first_child[at];
        if child == NO_CHILD {
            path.pop();
            if at != n {
                visit(at);
            }
        } else {
            path.push(child);
            first_child[at] = sibling[child];
        }
    }
}
