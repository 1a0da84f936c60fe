//! Vertex separators: grown from a vertex, and refined by moves of single vertices.
//!
//! C. M. Fiduccia, R. M. Mattheyses, DAC 1982, 175–181; C. Ashcraft, J. W. H. Liu, SIAM J. Matrix Anal. Appl. 19 (1998)
//! 325–354 for separators of vertices.

use super::weighted::Weighted;
use std::collections::BinaryHeap;

/// The side of a separator's own vertices.
pub(super) const BETWEEN: u8 = 2;

/// Sides 0 and 1 of a graph without an edge between them, and the vertices [`BETWEEN`].
pub(super) struct Separator {
    pub(super) side: Vec<u8>,
    /// Weights of the sides and of what is between them.
    pub(super) weight: [u64; 3],
}

impl Separator {
    pub(super) fn new(graph: &Weighted, side: Vec<u8>) -> Self {
        let mut weight = [0; 3];
        side.iter().zip(&graph.weight).for_each(|(&side, &w)| weight[side as usize] += u64::from(w));
        Self { side, weight }
    }

    /// s (a + b)² / 4ab: the weight of the separator, the more the less even its sides are.
    pub(super) fn cost(&self) -> f64 {
        let [a, b, s] = self.weight.map(|weight| weight as f64);
        // Without sides there is no separator; one of no weight is the better the more even it is.
        if a * b == 0.0 { f64::INFINITY } else { s * ((a + b).powi(2) / (4.0 * a * b)).powf(super::env("POW", 1.0)) }
    }

    /// From a vertex on, the best next vertex at a time, until the sides are even.
    pub(super) fn grown(graph: &Weighted, seed: u32) -> Self {
        let mut side = vec![1; graph.vertices()];
        side[seed as usize] = BETWEEN;
        let mut moves = Moves::new(graph, Self::new(graph, side), 0);
        while moves.separator.weight[0] < moves.separator.weight[1] && moves.next() {}
        moves.separator
    }

    /// Moved to one side and to the other until neither is better.
    pub(super) fn refined(mut self, graph: &Weighted) -> Self {
        let mut to = u8::from(self.weight[1] < self.weight[0]);
        let mut vain = 0;
        while vain < 2 {
            let before = self.cost();
            self = Moves::new(graph, self, to).pass();
            vain = if self.cost() < before { 0 } else { vain + 1 };
            to = 1 - to;
        }
        self
    }
}

/// The side to which the separator moves is let grow up to this part of the graph.
const LARGER: f64 = 0.6;

/// A separator on its way to one side: vertex by vertex joins it, and what these touch on the far side comes between.
struct Moves<'a> {
    graph: &'a Weighted,
    separator: Separator,
    to: u8,
    /// For vertices between: the weight of their neighbours on the far side.
    far: Vec<u32>,
    /// Vertices between by the weight that the separator loses with them. This only grows: old entries come later
    /// than new ones, when the vertex is between no more.
    queue: BinaryHeap<(i64, u32)>,
    /// What was moved, and how many vertices came between by it: these are in `pulled`.
    log: Vec<(u32, u32)>,
    pulled: Vec<u32>,
}

impl<'a> Moves<'a> {
    fn new(graph: &'a Weighted, separator: Separator, to: u8) -> Self {
        let far = vec![0; graph.vertices()];
        let mut moves =
            Self { graph, separator, to, far, queue: BinaryHeap::new(), log: Vec::new(), pulled: Vec::new() };
        for vertex in 0..graph.vertices() as u32 {
            if moves.separator.side[vertex as usize] == BETWEEN {
                moves.enter(vertex);
            }
        }
        moves
    }

    /// A vertex is between now.
    fn enter(&mut self, vertex: u32) {
        let far = self.graph.neighbours(vertex).iter().filter(|&&other| self.separator.side[other as usize] == 1 - self.to);
        self.far[vertex as usize] = far.map(|&other| self.graph.weight[other as usize]).sum();
        self.offer(vertex);
    }

    fn offer(&mut self, vertex: u32) {
        let gain = i64::from(self.graph.weight[vertex as usize]) - i64::from(self.far[vertex as usize]);
        self.queue.push((gain, vertex));
    }

    fn set(&mut self, vertex: u32, side: u8) {
        let weight = u64::from(self.graph.weight[vertex as usize]);
        let old = std::mem::replace(&mut self.separator.side[vertex as usize], side);
        self.separator.weight[usize::from(old)] -= weight;
        self.separator.weight[usize::from(side)] += weight;
    }

    /// Moves the vertex that gains most, if there is one.
    fn next(&mut self) -> bool {
        let Some((_, vertex)) = self.queue.pop() else { return false };
        if self.separator.side[vertex as usize] != BETWEEN {
            return true;
        }
        let graph = self.graph;
        self.set(vertex, self.to);
        let first = self.pulled.len();
        for &other in graph.neighbours(vertex) {
            if self.separator.side[other as usize] == 1 - self.to {
                self.set(other, BETWEEN);
                self.pulled.push(other);
            }
        }
        for k in first..self.pulled.len() {
            let other = self.pulled[k];
            for &third in graph.neighbours(other) {
                // Of those that come between now the weights are not known yet.
                if self.separator.side[third as usize] == BETWEEN && !self.pulled[first..].contains(&third) {
                    self.far[third as usize] -= graph.weight[other as usize];
                    self.offer(third);
                }
            }
        }
        for k in first..self.pulled.len() {
            self.enter(self.pulled[k]);
        }
        self.log.push((vertex, (self.pulled.len() - first) as u32));
        true
    }

    /// Goes on while it gets worse, up to a point, and back to where it was best.
    fn pass(mut self) -> Separator {
        let largest = (super::env("LARGER", LARGER) * self.graph.total() as f64) as u64;
        let limit = super::env("LIM", 400.0) as usize;
        let (mut best, mut cost) = (0, self.separator.cost());
        while self.log.len() < best + limit && self.separator.weight[usize::from(self.to)] < largest && self.next() {
            let now = self.separator.cost();
            if now < cost {
                (best, cost) = (self.log.len(), now);
            }
        }
        self.undone(best)
    }

    /// The separator as it was after so many moves.
    fn undone(mut self, moves: usize) -> Separator {
        while self.log.len() > moves
            && let Some((vertex, pulled)) = self.log.pop()
        {
            self.set(vertex, BETWEEN);
            for other in self.pulled.split_off(self.pulled.len() - pulled as usize) {
                self.set(other, 1 - self.to);
            }
        }
        self.separator
    }
}
