//! Fill-reducing orderings of symmetric patterns.

mod dissection;
mod elimination;
mod graph;

pub(crate) use elimination::{Elimination, postorder};
pub(crate) use graph::Graph;

use crate::symbolic::{Lower, Ordering};
use crate::threads::both;
use dissection::Begun;
pub(crate) use dissection::MIN_SHARED_VERTICES;
use feral_amd::{CscPattern, amd_order};

/// From this many operations an edge on an order is compared with the other one. Both take about as long as
/// so many operations: where a factorisation takes less, as in small and thin structures, little can be
/// gained.
const MIN_COMPARED_OPERATIONS_PER_EDGE: f64 = 1e4;

/// A graph of this many vertices and neighbours of each may be a solid, whose dissection comes first: of a
/// solid, minimum degree costs two to four times the operations.
const SOLID_VERTICES_AND_NEIGHBOURS: (usize, f64) = (8000, 16.0);

/// The graph that is ordered, and its elimination with every subtree in one piece.
///
/// Minimum degree or nested dissection of the graph of nodes, whichever costs fewer operations. The same
/// pattern always has the same order, with any number of threads.
///
/// # Source
/// P. R. Amestoy, T. A. Davis, I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905; of dissection in its module.
pub(crate) fn order(pattern: &Lower, ordering: &Ordering, threads: usize) -> (Graph, Elimination) {
    if let Ordering::Given(order) = ordering {
        let graph = Graph::of_rows(pattern);
        // Checked to be rows of the pattern, which are fewer than 2³².
        let elimination = Elimination::new(order.iter().map(|&row| row as u32).collect(), &graph);
        return (graph, elimination.postordered());
    }
    let graph = Graph::compressed(pattern);
    let best = match ordering {
        Ordering::MinimumDegree => minimum_degree(&graph, threads),
        Ordering::NestedDissection => dissected(Begun::new(&graph, threads)),
        _ if graph.vertices() >= SOLID_VERTICES_AND_NEIGHBOURS.0
            && graph.edges() >= SOLID_VERTICES_AND_NEIGHBOURS.1 * graph.vertices() as f64 =>
        {
            // Few operations for a solid: it is a beam or a shell, for which minimum degree may do with less.
            let first = dissected(Begun::new(&graph, threads));
            if first.flops() > MIN_COMPARED_OPERATIONS_PER_EDGE * graph.edges() {
                first
            } else {
                better(minimum_degree(&graph, threads), first)
            }
        }
        _ => {
            // Another thread may find the first cut in the meantime.
            let begin = || Begun::new(&graph, threads);
            let share = threads > 1 && graph.vertices() >= MIN_SHARED_VERTICES;
            let (first, begun) = both(threads, || minimum_degree(&graph, threads), || share.then(begin));
            if first.flops() > MIN_COMPARED_OPERATIONS_PER_EDGE * graph.edges() {
                better(first, dissected(begun.unwrap_or_else(begin)))
            } else {
                first
            }
        }
    };
    (graph, best.postordered())
}

fn better(a: Elimination, b: Elimination) -> Elimination {
    if b.flops() < a.flops() { b } else { a }
}

fn dissected(begun: Begun<'_>) -> Elimination {
    let graph = begun.graph;
    Elimination::new(begun.order(), graph)
}

fn minimum_degree(graph: &Graph, threads: usize) -> Elimination {
    match approximate_minimum_degree(graph) {
        Some(order) => Elimination::new(order, graph),
        None => dissected(Begun::new(graph, threads)),
    }
}

/// `None` where there are too many edges for 32-bit indices.
fn approximate_minimum_degree(graph: &Graph) -> Option<Vec<u32>> {
    let start: Option<Vec<i32>> = graph.start.iter().map(|&k| i32::try_from(k).ok()).collect();
    let neighbours: Option<Vec<i32>> = graph.neighbours.iter().map(|&k| i32::try_from(k).ok()).collect();
    let order = amd_order(&CscPattern::new(graph.vertices(), &start?, &neighbours?)?).ok()?;
    order.into_iter().map(|vertex| u32::try_from(vertex).ok()).collect()
}
