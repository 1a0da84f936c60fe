//! The graph of a symmetric pattern with the dofs of one node as one vertex.

use super::elimination::Step;
use crate::symbolic::Lower;
use std::collections::HashMap;

/// Vertices are classes of rows with the same neighbours, themselves included: mostly the dofs of a node.
///
/// Orderings work on a third or a sixth of the vertices and a ninth or less of the edges, and see the
/// structure and not its dofs.
#[derive(Debug)]
pub(crate) struct Graph {
    /// First neighbour of each vertex, and the end.
    pub(super) start: Vec<usize>,
    /// Neighbours of each vertex, ascending, without itself.
    pub(super) neighbours: Vec<u32>,
    /// First row of each vertex in `rows`, and the end.
    row_start: Vec<usize>,
    rows: Vec<u32>,
}

impl Graph {
    /// Every row a vertex.
    pub(super) fn of_rows(pattern: &Lower) -> Self {
        let each: Vec<u32> = (0..pattern.dim as u32).collect();
        Self::of_classes(pattern, &each, pattern.dim)
    }

    pub(super) fn compressed(pattern: &Lower) -> Self {
        // A row's signature is a sum over its neighbours. Equal sums of different rows are as good as
        // impossible; `Symbolic::new` sees it and does without classes.
        let own: Vec<u64> = (0..pattern.dim).map(scramble).collect();
        let mut signature = own.clone();
        for col in 0..pattern.dim {
            let mut sum = 0u64;
            for row in pattern.column(col).iter().map(|&row| row as usize).filter(|&row| row != col) {
                sum = sum.wrapping_add(own[row]);
                signature[row] = signature[row].wrapping_add(own[col]);
            }
            signature[col] = signature[col].wrapping_add(sum);
        }
        let mut seen = HashMap::with_capacity(pattern.dim / 2);
        let mut classes = 0;
        let class = signature.into_iter().map(|signature| {
            *seen.entry(signature).or_insert_with(|| {
                classes += 1;
                classes - 1
            })
        });
        let class: Vec<u32> = class.collect();
        Self::of_classes(pattern, &class, classes as usize)
    }

    /// Classes are numbered by their first rows.
    fn of_classes(pattern: &Lower, class: &[u32], classes: usize) -> Self {
        let mut row_start = vec![0; classes + 1];
        class.iter().for_each(|&class| row_start[class as usize + 1] += 1);
        (0..classes).for_each(|k| row_start[k + 1] += row_start[k]);
        let mut next = row_start.clone();
        let mut rows = vec![0; pattern.dim];
        for (row, &class) in class.iter().enumerate() {
            rows[next[class as usize]] = row as u32;
            next[class as usize] += 1;
        }
        // Between the first rows of two classes there is an edge where there is one between the classes.
        let mut first = vec![false; pattern.dim];
        (0..classes).for_each(|k| first[rows[row_start[k]] as usize] = true);
        let first = &first;
        let edges = || {
            (0..pattern.dim).filter(|&col| first[col]).flat_map(move |col| {
                let rows = pattern.column(col).iter().map(|&row| row as usize);
                rows.filter(move |&row| row != col && first[row]).map(move |row| (row, col))
            })
        };
        let mut start = vec![0; classes + 1];
        for (row, col) in edges() {
            start[class[row] as usize + 1] += 1;
            start[class[col] as usize + 1] += 1;
        }
        (0..classes).for_each(|k| start[k + 1] += start[k]);
        let mut next = start.clone();
        let mut neighbours = vec![0; start[classes]];
        for (row, col) in edges() {
            for (a, b) in [(class[row], class[col]), (class[col], class[row])] {
                neighbours[next[a as usize]] = b;
                next[a as usize] += 1;
            }
        }
        for vertex in 0..classes {
            neighbours[start[vertex]..start[vertex + 1]].sort_unstable();
        }
        Self { start, neighbours, row_start, rows }
    }

    pub(crate) fn vertices(&self) -> usize {
        self.start.len() - 1
    }

    /// How many, each counted from both of its ends.
    pub(super) fn edges(&self) -> f64 {
        self.neighbours.len() as f64
    }

    pub(crate) fn neighbours(&self, vertex: usize) -> &[u32] {
        &self.neighbours[self.start[vertex]..self.start[vertex + 1]]
    }

    /// The rows in the order of an elimination.
    pub(crate) fn rows_in(&self, steps: &[Step]) -> Vec<usize> {
        steps.iter().flat_map(|step| self.rows(step.vertex as usize)).map(|&row| row as usize).collect()
    }

    /// The rows of a vertex, ascending.
    pub(crate) fn rows(&self, vertex: usize) -> &[u32] {
        &self.rows[self.row_start[vertex]..self.row_start[vertex + 1]]
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
