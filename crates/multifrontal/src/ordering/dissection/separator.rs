//! Vertex separators: grown from a vertex, and refined by moves of single vertices.
//!
//! C. M. Fiduccia, R. M. Mattheyses, DAC 1982, 175–181; C. Ashcraft, J. W. H. Liu, SIAM J. Matrix Anal. Appl. 19 (1998)
//! 325–354 for separators of vertices.

use super::weighted::Weighted;
use std::collections::BinaryHeap;

/// The side of a separator's own vertices.
pub(super) const BETWEEN: u8 = 2;

/// Sides 0 and 1 of a graph without an edge between them, and the vertices [`BETWEEN`].
#[derive(Clone)]
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
        if a * b == 0.0 { f64::INFINITY } else { (s + 1e-3) * (a + b).powi(2) / (4.0 * a * b) }
    }

    /// From a vertex on, the best next vertex at a time, until the sides are even.
    pub(super) fn grown(graph: &Weighted, seed: u32) -> Self {
        let mut side = vec![1; graph.vertices()];
        side[seed as usize] = BETWEEN;
        let mut moves = Moves::new(graph, Self::new(graph, side));
        while moves.separator.weight[0] < moves.separator.weight[1] {
            let Some((_, vertex)) = moves.best(0) else { break };
            moves.shift(vertex, 0);
        }
        moves.separator
    }

    /// Moves vertices to a side, and what they touch on the other between, until this gains nothing any more.
    pub(super) fn refined(self, graph: &Weighted) -> Self {
        let mut best = self;
        for _ in 0..e("PASSES", 10.0) as usize {
            let before = best.cost();
            let one = Moves::new(graph, best).pass(if e("ONE", 1.0) == 0.0 { [true; 2] } else { [true, false] });
            best = if e("ONE", 1.0) == 0.0 { one } else { Moves::new(graph, one).pass([false, true]) };
            if best.cost() >= before {
                break;
            }
        }
        best
    }
}

/// The larger side is let grow up to this part of the graph.
fn e(name: &'static str, default: f64) -> f64 {
    use std::collections::HashMap;
    thread_local!(static M: std::cell::RefCell<HashMap<&'static str, f64>> = Default::default());
    M.with(|m| *m.borrow_mut().entry(name).or_insert_with(|| super::env(name, default)))
}

const LARGER: f64 = 0.6;

/// A separator in motion.
struct Moves<'a> {
    graph: &'a Weighted,
    separator: Separator,
    /// For vertices between: weights of their neighbours on each side.
    near: Vec<[u32; 2]>,
    /// Vertices between by what it gains to move them to each side; some are out of date.
    queues: [BinaryHeap<(i64, u32, u32)>; 2],
    tick: u32,
    moved: Vec<bool>,
    /// What was moved, where to, and how many vertices came between by it: these are in `pulled`.
    log: Vec<(u32, u8, u32)>,
    pulled: Vec<u32>,
}

impl<'a> Moves<'a> {
    fn new(graph: &'a Weighted, separator: Separator) -> Self {
        let n = graph.vertices();
        let mut moves = Self {
            graph,
            separator,
            near: vec![[0; 2]; n],
            queues: Default::default(),
            tick: 0,
            moved: vec![false; n],
            log: Vec::new(),
            pulled: Vec::new(),
        };
        for vertex in 0..n as u32 {
            if moves.separator.side[vertex as usize] == BETWEEN {
                moves.enter(vertex);
            }
        }
        moves
    }

    /// A vertex is between now.
    fn enter(&mut self, vertex: u32) {
        let mut near = [0; 2];
        for &other in self.graph.neighbours(vertex) {
            if let Some(near) = near.get_mut(self.separator.side[other as usize] as usize) {
                *near += self.graph.weight[other as usize];
            }
        }
        self.near[vertex as usize] = near;
        self.offer(vertex, 0);
        self.offer(vertex, 1);
    }

    fn gain(&self, vertex: u32, side: u8) -> i64 {
        let lost = self.near[vertex as usize][usize::from(1 - side)];
        i64::from(self.graph.weight[vertex as usize]) - i64::from(lost)
    }

    fn offer(&mut self, vertex: u32, side: u8) {
        if !self.moved[vertex as usize] {
            let gain = self.gain(vertex, side);
            self.tick += 1;
            let tie = match e("TIE", 0.0) as u32 { 0 => 0, 1 => self.tick, 2 => !self.tick, _ => (vertex).wrapping_mul(0x9e3779b9) };
            self.queues[usize::from(side)].push((gain, tie, vertex));
        }
    }

    /// The vertex that gains most by a move to a side.
    fn best(&mut self, side: u8) -> Option<(i64, u32)> {
        while let Some(&(gain, _, vertex)) = self.queues[usize::from(side)].peek() {
            let between = self.separator.side[vertex as usize] == BETWEEN && !self.moved[vertex as usize];
            if between && gain == self.gain(vertex, side) {
                return Some((gain, vertex));
            }
            self.queues[usize::from(side)].pop();
        }
        None
    }

    fn set(&mut self, vertex: u32, side: u8) {
        let weight = u64::from(self.graph.weight[vertex as usize]);
        let old = std::mem::replace(&mut self.separator.side[vertex as usize], side);
        self.separator.weight[usize::from(old)] -= weight;
        self.separator.weight[usize::from(side)] += weight;
    }

    /// Moves a vertex to a side.
    fn shift(&mut self, vertex: u32, side: u8) {
        let graph = self.graph;
        let far = 1 - side;
        self.set(vertex, side);
        self.moved[vertex as usize] = true;
        let first = self.pulled.len();
        for &other in graph.neighbours(vertex) {
            match self.separator.side[other as usize] {
                BETWEEN => {
                    self.near[other as usize][usize::from(side)] += graph.weight[vertex as usize];
                    self.offer(other, far);
                }
                at if at == far => {
                    self.set(other, BETWEEN);
                    self.pulled.push(other);
                    for &third in graph.neighbours(other) {
                        if self.separator.side[third as usize] == BETWEEN {
                            let near = &mut self.near[third as usize][usize::from(far)];
                            *near = near.saturating_sub(graph.weight[other as usize]);
                            self.offer(third, side);
                        }
                    }
                }
                _ => {}
            }
        }
        for k in first..self.pulled.len() {
            self.enter(self.pulled[k]);
        }
        self.log.push((vertex, side, (self.pulled.len() - first) as u32));
    }

    /// Goes on while it gets worse, up to a point, and back to where it was best.
    fn pass(mut self, sides: [bool; 2]) -> Separator {
        let limit = (e("LIMS", 5.0) as usize * self.separator_len()).clamp(e("LIMLO", 50.0) as usize, e("LIM", 400.0) as usize);
        let largest = (LARGER * self.graph.total() as f64) as u64;
        let (mut best, mut cost) = (0, self.separator.cost());
        while self.log.len() < best + limit {
            let offers = [self.best(0), self.best(1)];
            let fits = |side: u8, vertex: u32| {
                let new = self.separator.weight[usize::from(side)] + u64::from(self.graph.weight[vertex as usize]);
                new <= largest.max(self.separator.weight[usize::from(1 - side)])
            };
            let light = u8::from(self.separator.weight[1] < self.separator.weight[0]);
            let key = |side: u8| {
                let (gain, vertex) = offers[usize::from(side)].filter(|_| sides[side as usize])?;
                fits(side, vertex).then_some((gain, side == light, side, vertex))
            };
            let Some((_, _, side, vertex)) = key(0).max(key(1)) else { break };
            self.shift(vertex, side);
            let now = self.separator.cost();
            if now < cost {
                (best, cost) = (self.log.len(), now);
            }
        }
        self.undone(best)
    }

    fn separator_len(&self) -> usize {
        self.separator.side.iter().filter(|&&side| side == BETWEEN).count()
    }

    /// The separator as it was after so many moves.
    fn undone(mut self, moves: usize) -> Separator {
        while self.log.len() > moves
            && let Some((vertex, side, pulled)) = self.log.pop()
        {
            self.set(vertex, BETWEEN);
            for other in self.pulled.split_off(self.pulled.len() - pulled as usize) {
                self.set(other, 1 - side);
            }
        }
        self.separator
    }
}
