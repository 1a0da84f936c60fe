//! The graph of a symmetric pattern with the dofs of one node as one vertex.

use crate::sparse::Pattern;
use std::collections::HashMap;

/// Vertices are classes of rows with the same neighbours, themselves included: mostly the dofs of a node.
///
/// Orderings work on a third or a sixth of the vertices and a ninth or less of the edges, and see the
/// structure and not its dofs.
pub(super) struct Graph {
    /// First neighbour of each vertex, and the end.
    pub(super) start: Vec<usize>,
    /// Neighbours of each vertex, ascending, without itself.
    pub(super) neighbours: Vec<usize>,
    /// The rows of each vertex, ascending.
    pub(super) rows: Vec<Vec<usize>>,
}

impl Graph {
    pub(super) fn compressed(pattern: &Pattern) -> Self {
        // A row's signature is a sum over its neighbours. Equal sums of different rows are as good as
        // impossible, and would cost fill, not correctness: any permutation is a valid ordering.
        let mut signature = vec![0u64; pattern.dim()];
        for (row, col) in pattern.positions() {
            signature[col] = signature[col].wrapping_add(scramble(row));
            if row != col {
                signature[row] = signature[row].wrapping_add(scramble(col));
            }
        }
        let mut seen = HashMap::new();
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut vertex = Vec::with_capacity(pattern.dim());
        for (row, signature) in signature.into_iter().enumerate() {
            let class = *seen.entry(signature).or_insert(rows.len());
            if class == rows.len() {
                rows.push(Vec::new());
            }
            rows[class].push(row);
            vertex.push(class);
        }
        // Between the first rows of two classes there is an edge where there is one between the classes.
        let first = |row: usize| rows[vertex[row]][0] == row;
        let edges = || {
            (0..pattern.dim()).filter(|&col| first(col)).flat_map(|col| {
                let below = pattern.column(col).iter().filter(move |&&row| row != col && first(row));
                let vertex = &vertex;
                below.map(move |&row| (vertex[row], vertex[col]))
            })
        };
        let mut start = vec![0; rows.len() + 1];
        for (a, b) in edges() {
            start[a + 1] += 1;
            start[b + 1] += 1;
        }
        for v in 0..rows.len() {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut neighbours = vec![0; start[rows.len()]];
        // Classes are numbered by their first rows, so edges come by ascending columns, each with ascending
        // rows: every vertex receives its neighbours in ascending order, those before it first.
        for (a, b) in edges() {
            neighbours[next[a]] = b;
            neighbours[next[b]] = a;
            next[a] += 1;
            next[b] += 1;
        }
        Self { start, neighbours, rows }
    }

    /// How many, each counted from both of its ends.
    pub(super) fn edges(&self) -> f64 {
        self.neighbours.len() as f64
    }

    pub(super) fn neighbours(&self, vertex: usize) -> &[usize] {
        &self.neighbours[self.start[vertex]..self.start[vertex + 1]]
    }
}

/// A bijection of 64-bit numbers without visible order: the finaliser of SplitMix64.
///
/// Steele, Lea & Flood, OOPSLA 2014.
fn scramble(row: usize) -> u64 {
    let mut z = (row as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
