//! Fill-reducing orderings of symmetric patterns.

mod dissection;
mod elimination;
mod graph;

pub(crate) use elimination::{Elimination, postorder};
pub(crate) use graph::Graph;

use crate::symbolic::{Lower, Ordering};
use feral_amd::amd_order;
use feral_scotch::{CscPattern, ScotchOptions, scotch_order_full};

/// From this many operations an edge on nested dissection is tried: it takes about as long as that, and where a
/// factorisation takes less, as in small and thin structures, nothing can be gained.
const DISSECT_FROM: f64 = 2e4;

/// From this many operations an edge on a second dissection is worth its time: on blocks two of them differ by
/// up to 15 %.
const AGAIN_FROM: f64 = 3e5;

/// A graph of this many vertices and neighbours of each is a solid, whose minimum degree order need not be
/// looked at: it costs two to four times the operations.
const SOLID: (usize, f64) = (8000, 16.0);

/// The graph that is ordered, and its elimination with every subtree in one piece.
///
/// Minimum degree or nested dissection of the graph of nodes, whichever costs fewer operations. The same
/// pattern always has the same order.
///
/// # Source
/// P. R. Amestoy, T. A. Davis, I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905;
/// F. Pellegrini, J. Roman, HPCN Europe 1996, LNCS 1067, 493–498.
pub(crate) fn order(pattern: &Lower, ordering: &Ordering) -> (Graph, Elimination) {
    if let Ordering::Given(order) = ordering {
        let graph = Graph::of_rows(pattern);
        // Checked to be rows of the pattern, which are fewer than 2³².
        let elimination = Elimination::new(order.iter().map(|&row| row as u32).collect(), &graph);
        return (graph, elimination.postordered());
    }
    let graph = Graph::compressed(pattern);
    let best = match ordering {
        Ordering::MinimumDegree => minimum_degree(&graph),
        Ordering::NestedDissection => dissected(&graph).unwrap_or_else(|| minimum_degree(&graph)),
        _ if graph.vertices() >= SOLID.0 && graph.edges() >= SOLID.1 * graph.vertices() as f64 => {
            dissected(&graph).unwrap_or_else(|| minimum_degree(&graph))
        }
        _ => {
            let best = minimum_degree(&graph);
            if best.flops() > DISSECT_FROM * graph.edges() {
                dissected(&graph).filter(|it| it.flops() < best.flops()).unwrap_or(best)
            } else {
                best
            }
        }
    };
    (graph, best.postordered())
}

/// The adjacency in 32-bit indices; `None` where there are too many edges for them.
fn with_csc<T>(graph: &Graph, order: impl FnOnce(&CscPattern<'_>) -> Option<T>) -> Option<T> {
    let start: Option<Vec<i32>> = graph.start.iter().map(|&k| i32::try_from(k).ok()).collect();
    let neighbours: Option<Vec<i32>> = graph.neighbours.iter().map(|&k| i32::try_from(k).ok()).collect();
    order(&CscPattern::new(graph.vertices(), &start?, &neighbours?)?)
}

fn minimum_degree(graph: &Graph) -> Elimination {
    let order = with_csc(graph, |csc| narrow(amd_order(csc).ok()?));
    // Too many edges for 32-bit indices: any order is an order.
    Elimination::new(order.unwrap_or_else(|| (0..graph.vertices() as u32).collect()), graph)
}

/// The better of two dissections, the second only where it is worth it; `None` where there are too many edges.
///
/// Parts may differ by a fifth, as METIS has it, or by a twentieth: neither is better on all structures.
fn dissected(graph: &Graph) -> Option<Elimination> {
    if std::env::var("SCOTCH").is_err() {
        return Some(Elimination::new(dissection::order(graph), graph));
    }
    let best = nested_dissection(graph, 0.2)?;
    if best.flops() < AGAIN_FROM * graph.edges() {
        return Some(best);
    }
    nested_dissection(graph, 0.05).filter(|it| it.flops() < best.flops()).or(Some(best))
}

fn nested_dissection(graph: &Graph, max_imbalance: f64) -> Option<Elimination> {
    // Compressed already, and the seed is part of the defaults.
    let options = ScotchOptions { compress: false, max_imbalance, ..ScotchOptions::default() };
    let order = with_csc(graph, |csc| narrow(scotch_order_full(csc, &options).ok()?.0))?;
    Some(Elimination::new(order, graph))
}

fn narrow(order: Vec<i32>) -> Option<Vec<u32>> {
    order.into_iter().map(|vertex| u32::try_from(vertex).ok()).collect()
}
