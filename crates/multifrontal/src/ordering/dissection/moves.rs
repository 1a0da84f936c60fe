//! A separator moves through a graph, vertex by vertex to one side, and stays where it was best.
//!
//! C. M. Fiduccia, R. M. Mattheyses, DAC 1982, 175–181; C. Ashcraft, J. W. H. Liu, SIAM J. Matrix Anal. Appl.
//! 19 (1998) 325–354 for separators of vertices. To one side at a time a separator of a mesh gets rid of its
//! steps: it is swept over many layers, and each costs as much as it has vertices. With moves to both sides
//! steps stay, and a cube costs 1.5 to 1.8 times as much.

use super::separator::{SEPARATOR_SIDE, Separator};
use super::weighted::Weighted;
use std::collections::BinaryHeap;

/// A pass ends where the separator costs this many times what it did at best: with 1.15 structures cost some
/// per mille more, with any the analysis takes a fifth longer.
const MAX_COST_RATIO: f64 = 1.2;

/// A pass ends where this number times the separator's vertices were moved in vain: with one layer structures
/// cost a per cent more, with five no less.
const MAX_VAIN_LAYERS: usize = 2;

/// The side that grows is let grow up to this part of the whole, so that parts of parts soon are small.
const MAX_SIDE_SHARE: f64 = 0.8;

/// A separator on its way to one side: its vertices join that side, and what these touch on the far side
/// comes between.
pub(super) struct Moves<'a> {
    graph: &'a Weighted,
    pub(super) separator: Separator,
    to: u8,
    /// For vertices between: the weight of their neighbours on the far side.
    far: Vec<u32>,
    /// Vertices between by the weight that the separator loses with them. This only grows, so that old
    /// entries of a vertex come after its newest, when it is between no more. The vertex is in the lower half.
    queue: BinaryHeap<i64>,
    /// What was moved, and how many vertices came between by it: these are in `pulled`.
    log: Vec<(u32, usize)>,
    pulled: Vec<u32>,
}

impl<'a> Moves<'a> {
    pub(super) fn new(graph: &'a Weighted, separator: Separator, to: u8) -> Self {
        let far = vec![0; graph.vertices()];
        let (queue, log, pulled) = (BinaryHeap::new(), Vec::new(), Vec::new());
        let mut moves = Self { graph, separator, to, far, queue, log, pulled };
        for vertex in 0..graph.vertices() as u32 {
            if moves.separator.is_between(vertex) {
                let far = graph.neighbours(vertex).iter().filter(|&&other| moves.is_far(other));
                moves.far[vertex as usize] = far.map(|&other| graph.weight[other as usize]).sum();
                moves.offer(vertex);
            }
        }
        moves
    }

    /// Goes on while it gets worse, up to a point, and back to where it was best.
    pub(super) fn pass(mut self) -> Separator {
        let largest = (MAX_SIDE_SHARE * self.graph.total() as f64) as u64;
        let vain = MAX_VAIN_LAYERS * self.queue.len();
        let (mut best, mut cost) = (0, self.separator.cost());
        while self.log.len() <= best + vain
            && self.separator.weight[usize::from(self.to)] < largest
            && self.next()
        {
            let now = self.separator.cost();
            if now < cost {
                (best, cost) = (self.log.len(), now);
            } else if now > MAX_COST_RATIO * cost {
                break;
            }
        }
        self.undone(best)
    }

    /// Moves the vertex that gains most, if there is one.
    pub(super) fn next(&mut self) -> bool {
        let Some(offer) = self.queue.pop() else { return false };
        let vertex = offer as u32;
        if !self.separator.is_between(vertex) {
            return true;
        }
        self.separator.set(self.graph, vertex, self.to);
        let before = self.pulled.len();
        for &other in self.graph.neighbours(vertex) {
            if self.is_far(other) {
                self.pull(other);
            }
        }
        self.log.push((vertex, self.pulled.len() - before));
        true
    }

    /// A vertex of the far side comes between.
    fn pull(&mut self, vertex: u32) {
        self.separator.set(self.graph, vertex, SEPARATOR_SIDE);
        self.pulled.push(vertex);
        let weight = self.graph.weight[vertex as usize];
        let mut far = 0;
        for &other in self.graph.neighbours(vertex) {
            if self.separator.is_between(other) {
                self.far[other as usize] -= weight;
                self.offer(other);
            } else if self.is_far(other) {
                far += self.graph.weight[other as usize];
            }
        }
        self.far[vertex as usize] = far;
        self.offer(vertex);
    }

    fn offer(&mut self, vertex: u32) {
        let gain = i64::from(self.graph.weight[vertex as usize]) - i64::from(self.far[vertex as usize]);
        let gain = gain.clamp(i32::MIN.into(), i32::MAX.into());
        self.queue.push(gain << 32 | i64::from(vertex));
    }

    fn is_far(&self, vertex: u32) -> bool {
        self.separator.side[vertex as usize] == 1 - self.to
    }

    /// The separator as it was after so many moves.
    fn undone(mut self, moves: usize) -> Separator {
        for (vertex, pulled) in self.log.drain(moves..).rev() {
            self.separator.set(self.graph, vertex, SEPARATOR_SIDE);
            for other in self.pulled.drain(self.pulled.len() - pulled..) {
                self.separator.set(self.graph, other, 1 - self.to);
            }
        }
        self.separator
    }
}

impl Separator {
    /// From a vertex on, the best next vertex at a time, until the sides are even.
    pub(super) fn grown(graph: &Weighted, seed: u32) -> Self {
        let mut side = vec![1; graph.vertices()];
        side[seed as usize] = SEPARATOR_SIDE;
        let mut moves = Moves::new(graph, Self::new(graph, side), 0);
        while moves.separator.weight[0] < moves.separator.weight[1] && moves.next() {}
        moves.separator
    }

    /// Moved to one side and to the other, the lighter first, as long as that is better. To try the other side too
    /// before that is believed takes 6 % of an analysis, and structures cost the same to a few per mille.
    pub(super) fn refined(mut self, graph: &Weighted) -> Self {
        let mut to = u8::from(self.weight[1] < self.weight[0]);
        loop {
            let before = self.cost();
            self = Moves::new(graph, self, to).pass();
            if self.cost() >= before {
                return self;
            }
            to = 1 - to;
        }
    }
}
