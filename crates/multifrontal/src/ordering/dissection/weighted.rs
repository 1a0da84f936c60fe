//! A graph whose vertices and edges have weights, and its parts.

use crate::ordering::Graph;

/// Vertices may stand for many of a finer graph: their weight is rows, that of an edge the finer edges in it.
pub(super) struct Weighted {
    /// First neighbour of each vertex, and the end.
    pub(super) start: Vec<usize>,
    pub(super) neighbours: Vec<u32>,
    /// Weight of the edge to each neighbour.
    pub(super) edges: Vec<u32>,
    /// Weight of each vertex; all of them together are rows of a matrix and fit in 32 bits.
    pub(super) weight: Vec<u32>,
}

/// A part of a graph, and which vertices of the whole it has.
pub(super) struct Part {
    pub(super) graph: Weighted,
    pub(super) vertices: Vec<u32>,
}

impl Weighted {
    pub(super) fn vertices(&self) -> usize {
        self.weight.len()
    }

    pub(super) fn neighbours(&self, vertex: u32) -> &[u32] {
        &self.neighbours[self.start[vertex as usize]..self.start[vertex as usize + 1]]
    }

    /// Neighbours with the weights of the edges to them.
    pub(super) fn edges(&self, vertex: u32) -> impl Iterator<Item = (u32, u32)> {
        let range = self.start[vertex as usize]..self.start[vertex as usize + 1];
        self.neighbours[range.clone()].iter().copied().zip(self.edges[range].iter().copied())
    }

    pub(super) fn total(&self) -> u64 {
        self.weight.iter().map(|&weight| u64::from(weight)).sum()
    }
}

impl Part {
    /// The vertices of a graph that are to be dissected.
    pub(super) fn of(graph: &Graph, vertices: Vec<u32>) -> Self {
        let mut new = vec![u32::MAX; graph.vertices()];
        vertices.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
        let (mut start, mut neighbours) = (vec![0], Vec::with_capacity(graph.neighbours.len()));
        for &vertex in &vertices {
            let kept = graph.neighbours(vertex as usize).iter().map(|&other| new[other as usize]);
            neighbours.extend(kept.filter(|&other| other != u32::MAX));
            start.push(neighbours.len());
        }
        let weight = vertices.iter().map(|&vertex| graph.rows(vertex as usize).len() as u32).collect();
        let edges = vec![1; neighbours.len()];
        Self { graph: Weighted { start, neighbours, edges, weight }, vertices }
    }

    /// The connected pieces of the graph without some vertices.
    pub(super) fn pieces(&self, without: impl Fn(u32) -> bool) -> Vec<Self> {
        let mut new = vec![u32::MAX; self.vertices.len()];
        let mut pieces = Vec::new();
        let mut piece: Vec<u32> = Vec::new();
        for first in 0..self.vertices.len() as u32 {
            if new[first as usize] != u32::MAX || without(first) {
                continue;
            }
            piece.clear();
            piece.push(first);
            new[first as usize] = 0;
            let mut next = 0;
            while next < piece.len() {
                for &other in self.graph.neighbours(piece[next]) {
                    if new[other as usize] == u32::MAX && !without(other) {
                        new[other as usize] = 0;
                        piece.push(other);
                    }
                }
                next += 1;
            }
            // In the order of the whole: regular meshes stay so.
            piece.sort_unstable();
            piece.iter().enumerate().for_each(|(to, &from)| new[from as usize] = to as u32);
            pieces.push(self.piece(&piece, &new, &without));
        }
        pieces
    }

    fn piece(&self, piece: &[u32], new: &[u32], without: impl Fn(u32) -> bool) -> Self {
        let entries = piece.iter().map(|&vertex| self.graph.neighbours(vertex).len()).sum();
        let (mut start, mut neighbours) = (Vec::with_capacity(piece.len() + 1), Vec::with_capacity(entries));
        start.push(0);
        for &vertex in piece {
            let kept = self.graph.neighbours(vertex).iter().filter(|&&other| !without(other));
            neighbours.extend(kept.map(|&other| new[other as usize]));
            start.push(neighbours.len());
        }
        let weight = piece.iter().map(|&vertex| self.graph.weight[vertex as usize]).collect();
        let edges = vec![1; neighbours.len()];
        let vertices = piece.iter().map(|&vertex| self.vertices[vertex as usize]).collect();
        Self { graph: Weighted { start, neighbours, edges, weight }, vertices }
    }
}
