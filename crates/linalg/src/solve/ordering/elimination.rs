//! What an ordering costs, known before any number: elimination tree and counts of the factor.

const NONE: usize = usize::MAX;

/// The elimination of a graph's vertices in some order; a vertex stands for one or several rows.
pub(in crate::solve) struct Elimination {
    steps: Vec<Step>,
}

struct Step {
    vertex: usize,
    /// Rows of the vertex.
    rows: usize,
    /// Rows of the factor below them.
    below: usize,
    /// The first later step that this one changes: its parent in the elimination tree.
    parent: usize,
}

impl Elimination {
    /// Elimination tree and counts from the subtree of each row, in time of the order of the factor's entries.
    ///
    /// J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134–172.
    pub(in crate::solve) fn new<'a>(
        order: Vec<usize>,
        neighbours: impl Fn(usize) -> &'a [usize],
        rows: impl Fn(usize) -> usize,
    ) -> Self {
        let mut position = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &vertex)| position[vertex] = k);
        let mut reached = vec![NONE; order.len()];
        let step = |vertex| Step { vertex, rows: rows(vertex), below: 0, parent: NONE };
        let mut steps: Vec<Step> = order.into_iter().map(step).collect();
        for k in 0..steps.len() {
            reached[k] = k;
            let own = steps[k].rows;
            for &neighbour in neighbours(steps[k].vertex) {
                let mut at = position[neighbour];
                while at < k && reached[at] != k {
                    reached[at] = k;
                    let step = &mut steps[at];
                    step.below += own;
                    if step.parent == NONE {
                        step.parent = k;
                    }
                    at = step.parent;
                }
            }
        }
        Self { steps }
    }

    /// Σ over columns of the factor of (entries)²: multiplications and additions of L Lᵀ.
    pub(in crate::solve) fn flops(&self) -> f64 {
        let of = |step: &Step| (1..=step.rows).map(|own| ((step.below + own) as f64).powi(2)).sum::<f64>();
        self.steps.iter().map(of).sum()
    }

    /// Entries of the factor L, its diagonal included.
    pub(in crate::solve) fn entries(&self) -> usize {
        self.steps.iter().map(|step| step.rows * step.below + step.rows * (step.rows + 1) / 2).sum()
    }

    /// An order of the same cost with every subtree in one piece: only then are supernodes runs of columns.
    ///
    /// The child with most rows comes last, next to its parent, where amalgamation costs the fewest zeros.
    pub(in crate::solve) fn postorder(&self) -> Vec<usize> {
        let n = self.steps.len();
        let mut ascending: Vec<usize> = (0..n).collect();
        ascending.sort_by_key(|&k| self.steps[k].below);
        // Lists of children; the one put in last comes first.
        let (mut first_child, mut sibling) = (vec![NONE; n + 1], vec![NONE; n]);
        let root = n;
        for &k in ascending.iter().rev() {
            let parent = if self.steps[k].parent == NONE { root } else { self.steps[k].parent };
            sibling[k] = first_child[parent];
            first_child[parent] = k;
        }
        let mut order = Vec::with_capacity(n);
        let mut path = vec![root];
        while let Some(&at) = path.last() {
            if first_child[at] == NONE {
                path.pop();
                if at != root {
                    order.push(self.steps[at].vertex);
                }
            } else {
                path.push(first_child[at]);
                first_child[at] = sibling[first_child[at]];
            }
        }
        order
    }
}
