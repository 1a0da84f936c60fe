//! Nested dissection: a graph is cut in two by few vertices, which come last, and so on with both parts.
//!
//! A. George, SIAM J. Numer. Anal. 10 (1973) 345–363; separators are found on coarser graphs and refined on the way back:
//! G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359–392.

mod coarse;
mod leaf;
mod random;
mod separator;
mod weighted;

use super::Graph;
use coarse::coarsen;
use leaf::Leaves;
use random::Random;
use separator::{BETWEEN, Separator};
use weighted::{Part, Weighted};

fn env(name: &'static str, default: f64) -> f64 {
    use std::sync::OnceLock;
    static M: OnceLock<Vec<(String, f64)>> = OnceLock::new();
    let m = M.get_or_init(|| std::env::vars().filter_map(|(k, v)| Some((k, v.parse().ok()?))).filter(|(k,_)| k.starts_with("X_")).collect());
    m.iter().find(|(k, _)| &k[2..] == name).map_or(default, |&(_, v)| v)
}

/// An order of elimination of the graph's vertices.
pub(super) fn order(graph: &Graph) -> Vec<u32> {
    let n = graph.vertices();
    let leaf = env("LEAF", 120.0) as usize;
    // Neighbours of nearly all would be in every separator.
    let dense = 10.0 * (n as f64).sqrt();
    let (last, first): (Vec<u32>, Vec<u32>) =
        (0..n as u32).partition(|&vertex| graph.neighbours(vertex as usize).len() as f64 > dense);
    // From the last to the first.
    let mut reversed: Vec<u32> = last;
    let mut random = Random::new();
    let mut leaves = Leaves::new(graph);
    let mut parts = Part::of(graph, first).pieces(|_| false);
    while let Some(part) = parts.pop() {
        let separator = (part.vertices.len() > leaf).then(|| separator(&part.graph, &mut random));
        let Some(separator) = separator.filter(|it| it.weight[0] > 0 && it.weight[1] > 0) else {
            reversed.extend(leaves.order(&part).into_iter().rev());
            continue;
        };
        if std::env::var("SHOW").is_ok() && part.vertices.len() > n / 10 {
            eprintln!("{:?} cost {}", separator.weight, separator.cost());
        }
        let between = |vertex: u32| separator.side[vertex as usize] == BETWEEN;
        let own = (0..part.vertices.len()).filter(|&vertex| between(vertex as u32));
        reversed.extend(own.map(|vertex| part.vertices[vertex]));
        parts.extend(part.pieces(between));
    }
    reversed.reverse();
    reversed
}

/// Of a graph in one piece.
fn separator(graph: &Weighted, random: &mut Random) -> Separator {
    let tries = if graph.vertices() < env("WCYCLE", 0.0) as usize { env("TRIES", 2.0) as usize } else { 1 };
    let heaviest = (1.5 * graph.total() as f64 / env("COARSEST", 100.0)) as u64;
    let best = (0..tries).filter_map(|_| {
        if graph.vertices() <= env("COARSEST", 100.0) as usize {
            return None;
        }
        let coarse = coarsen(graph, heaviest, random);
        if coarse.graph.vertices() as f64 > 0.95 * graph.vertices() as f64 {
            return None;
        }
        let below = separator(&coarse.graph, random);
        let side = coarse.of.iter().map(|&coarse| below.side[coarse as usize]).collect();
        Some(Separator::new(graph, side).refined(graph))
    });
    let best = best.min_by(|a, b| a.cost().total_cmp(&b.cost()));
    best.unwrap_or_else(|| {
        let grown = (0..env("GROW", 5.0) as usize).map(|_| Separator::grown(graph, random.below(graph.vertices()) as u32));
        let refined = grown.map(|it| it.refined(graph));
        refined.min_by(|a, b| a.cost().total_cmp(&b.cost())).expect("more than one")
    })
}
