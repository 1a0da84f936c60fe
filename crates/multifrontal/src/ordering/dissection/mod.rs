//! Nested dissection: few vertices cut a graph in two and come last, and so on with both parts.
//!
//! A. George, SIAM J. Numer. Anal. 10 (1973) 345–363. The few are found on a coarse graph and refined on the
//! way back: G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359–392.

mod coarse;
mod leaf;
mod moves;
mod random;
mod separator;
#[cfg(test)]
mod tests;
mod weighted;

use super::Graph;
use crate::threads::map;
use coarse::coarsen;
use leaf::Leaves;
use random::Random;
use separator::Separator;
use weighted::{Part, Weighted};

/// Parts of at most so many vertices are not dissected: with 120, as others have it, sandwiches and small
/// blocks cost some per cent more, with 20 hardly less.
const MAX_LEAF_VERTICES: usize = 40;

/// Graphs of at most so many vertices are not made coarser.
const MAX_COARSEST_VERTICES: usize = 50;

/// Separators of the coarsest graph that are grown and refined, for the best of them.
const GROWN_SEPARATORS: usize = 4;

/// Coarser graphs with more than this part of the vertices are no help.
const MAX_COARSER_SHARE: f64 = 0.9;

/// Vertices with more neighbours than this multiple of √n would be in most separators: they come last at
/// once.
const DENSE_ROW_MULTIPLE: f64 = 10.0;

/// How often a graph is cut before one thread goes on with the rest: some parts for each of a few threads.
const SHARED_CUTS: usize = 4;

/// Parts of fewer vertices are not worth another thread.
pub(crate) const MIN_SHARED_VERTICES: usize = 1000;

/// A dissection after its first cuts.
pub(super) struct Begun<'a> {
    pub(super) graph: &'a Graph,
    /// Vertices that come last.
    dense: Vec<u32>,
    level: Level,
    threads: usize,
}

impl<'a> Begun<'a> {
    pub(super) fn new(graph: &'a Graph, threads: usize) -> Self {
        let vertices = 0..graph.vertices() as u32;
        let dense = DENSE_ROW_MULTIPLE * (graph.vertices() as f64).sqrt();
        let is_dense = |&vertex: &u32| graph.neighbours(vertex as usize).len() as f64 > dense;
        let (dense, sparse): (Vec<u32>, Vec<u32>) = vertices.partition(is_dense);
        let level = Level::of(Part::of(graph, sparse).pieces(|_| false), SHARED_CUTS, threads);
        Self { graph, dense, level, threads }
    }

    /// An order of elimination of the graph's vertices, the same with any number of threads.
    pub(super) fn order(self) -> Vec<u32> {
        let mut reversed = self.dense;
        reversed.extend(self.level.dissected(self.graph, self.threads));
        reversed.reverse();
        reversed
    }
}

/// Parts that threads share out as long as they are large.
struct Level {
    /// What one thread goes on with.
    small: Vec<Part>,
    /// Of each large part the vertices that come last, and what they leave.
    large: Vec<(Vec<u32>, Vec<Part>)>,
    /// How often the rest may be shared out.
    cuts: usize,
}

impl Level {
    fn of(parts: Vec<Part>, cuts: usize, threads: usize) -> Self {
        let (large, small): (Vec<Part>, Vec<Part>) =
            parts.into_iter().partition(|part| cuts > 0 && part.vertices.len() >= MIN_SHARED_VERTICES);
        let large = map(threads, large, |part| cut(part, &mut Random::new()));
        Self { small, large, cuts: cuts.saturating_sub(1) }
    }

    /// All vertices from the last to the first.
    fn dissected(self, graph: &Graph, threads: usize) -> Vec<u32> {
        let mut reversed = one_by_one(graph, self.small);
        let below = |(mut between, sides): (Vec<u32>, Vec<Part>)| {
            between.extend(Level::of(sides, self.cuts, threads).dissected(graph, threads));
            between
        };
        map(threads, self.large, below).into_iter().for_each(|part| reversed.extend(part));
        reversed
    }
}

/// The same by one thread.
fn one_by_one(graph: &Graph, mut parts: Vec<Part>) -> Vec<u32> {
    let mut reversed = Vec::new();
    let mut random = Random::new();
    let mut leaves = Leaves::new(graph);
    while let Some(part) = parts.pop() {
        if part.vertices.len() <= MAX_LEAF_VERTICES {
            reversed.extend(leaves.order(&part.vertices).iter().rev());
        } else {
            let (between, sides) = cut(part, &mut random);
            reversed.extend(between);
            parts.extend(sides);
        }
    }
    reversed
}

/// The vertices of a part that come last, and what they leave.
fn cut(part: Part, random: &mut Random) -> (Vec<u32>, Vec<Part>) {
    let separator = separator(&part.graph, random);
    if separator.cost().is_infinite() {
        // As good as complete: one order is like another.
        return (part.vertices, Vec::new());
    }
    let between = (0..).zip(&part.vertices).filter(|&(k, _)| separator.is_between(k));
    (between.map(|(_, &vertex)| vertex).collect(), part.pieces(|k| separator.is_between(k)))
}

/// Of a graph in one piece.
fn separator(graph: &Weighted, random: &mut Random) -> Separator {
    if graph.vertices() > MAX_COARSEST_VERTICES {
        let coarse = coarsen(graph, 3 * graph.total() / (2 * MAX_COARSEST_VERTICES as u64), random);
        if (coarse.graph.vertices() as f64) < MAX_COARSER_SHARE * graph.vertices() as f64 {
            let separator = separator(&coarse.graph, random);
            let side = coarse.of.iter().map(|&coarse| separator.side[coarse as usize]).collect();
            return Separator::new(graph, side).refined(graph);
        }
    }
    let mut grown = || Separator::grown(graph, random.below(graph.vertices()) as u32).refined(graph);
    let first = grown();
    (1..GROWN_SEPARATORS)
        .map(|_| grown())
        .fold(first, |best, it| if it.cost() < best.cost() { it } else { best })
}
