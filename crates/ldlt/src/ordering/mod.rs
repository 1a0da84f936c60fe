//! Fill-reducing orderings of symmetric patterns.

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
        Ordering::NestedDissection => nested_dissection(&graph).unwrap_or_else(|| minimum_degree(&graph)),
        _ => {
            let best = minimum_degree(&graph);
            if best.flops() > DISSECT_FROM * graph.edges() {
                nested_dissection(&graph).filter(|it| it.flops() < best.flops()).unwrap_or(best)
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

fn nested_dissection(graph: &Graph) -> Option<Elimination> {
    // Compressed already, and the seed is part of the defaults.
    let options = ScotchOptions { compress: false, ..ScotchOptions::default() };
    let order = with_csc(graph, |csc| narrow(scotch_order_full(csc, &options).ok()?.0))?;
    Some(Elimination::new(order, graph))
}

fn narrow(order: Vec<i32>) -> Option<Vec<u32>> {
    order.into_iter().map(|vertex| u32::try_from(vertex).ok()).collect()
}
