//! Coarser graphs: vertices joined in pairs along heavy edges.
//!
//! G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359–392.

use super::random::Random;
use super::weighted::Weighted;

const NO_VERTEX: u32 = u32::MAX;

/// A coarser graph and the coarse vertex of each vertex.
pub(super) struct Coarse {
    pub(super) graph: Weighted,
    pub(super) of: Vec<u32>,
}

pub(super) fn coarsen(graph: &Weighted, heaviest: u64, random: &mut Random) -> Coarse {
    let mate = matching(graph, heaviest, random);
    let mut of = vec![NO_VERTEX; graph.vertices()];
    let mut pairs = Vec::with_capacity(graph.vertices());
    for (vertex, &other) in mate.iter().enumerate() {
        if of[vertex] == NO_VERTEX {
            (of[vertex], of[other as usize]) = (pairs.len() as u32, pairs.len() as u32);
            pairs.push((vertex as u32, other));
        }
    }
    Coarse { graph: contracted(graph, &of, &pairs), of }
}

/// The mate of each vertex: the free neighbour along the heaviest edge, or itself.
///
/// What finds no free neighbour is joined with another such vertex next to the same one: stars have no other
/// pairs.
fn matching(graph: &Weighted, heaviest: u64, random: &mut Random) -> Vec<u32> {
    let weight = |vertex: u32| u64::from(graph.weight[vertex as usize]);
    let mut mate = vec![NO_VERTEX; graph.vertices()];
    let mut waiting = vec![NO_VERTEX; graph.vertices()];
    for vertex in random.order(graph.vertices()) {
        if mate[vertex as usize] != NO_VERTEX {
            continue;
        }
        let light = |other: u32| weight(vertex) + weight(other) <= heaviest;
        let free =
            graph.edges(vertex).filter(|&(other, _)| mate[other as usize] == NO_VERTEX && light(other));
        let mut other =
            free.max_by_key(|&(other, edge)| (edge, std::cmp::Reverse(weight(other)))).map(|it| it.0);
        if other.is_none()
            && let Some(&hub) = graph.neighbours(vertex).first()
        {
            let place = &mut waiting[hub as usize];
            if *place != NO_VERTEX && mate[*place as usize] == *place && light(*place) {
                other = Some(std::mem::replace(place, NO_VERTEX));
            } else {
                *place = vertex;
            }
        }
        let other = other.unwrap_or(vertex);
        (mate[vertex as usize], mate[other as usize]) = (other, vertex);
    }
    mate
}

fn contracted(graph: &Weighted, of: &[u32], pairs: &[(u32, u32)]) -> Weighted {
    let (mut start, mut weight) = (Vec::with_capacity(pairs.len() + 1), Vec::with_capacity(pairs.len()));
    let mut neighbours: Vec<u32> = Vec::with_capacity(graph.neighbours.len() / 2);
    let mut edges: Vec<u32> = Vec::with_capacity(graph.neighbours.len() / 2);
    // Where the edge to a coarse vertex is, if it is one of the present row.
    let mut place = vec![0; pairs.len()];
    start.push(0);
    for (k, &(a, b)) in pairs.iter().enumerate() {
        let first = neighbours.len();
        let mut add = |vertex: u32| {
            for (other, edge) in graph.edges(vertex) {
                let other = of[other as usize];
                let at = place[other as usize];
                if at >= first && at < neighbours.len() && neighbours[at] == other {
                    edges[at] = edges[at].saturating_add(edge);
                } else if other != k as u32 {
                    place[other as usize] = neighbours.len();
                    neighbours.push(other);
                    edges.push(edge);
                }
            }
            graph.weight[vertex as usize]
        };
        weight.push(if a == b { add(a) } else { add(a) + add(b) });
        start.push(neighbours.len());
    }
    Weighted { start, neighbours, edges, weight }
}
