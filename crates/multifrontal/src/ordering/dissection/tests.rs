use super::coarse::coarsen;
use super::leaf::Leaves;
use super::weighted::{Part, Weighted};
use super::{Begun, Random, separator};
use crate::ordering::Graph;
use crate::symbolic::Lower;
use proptest::prelude::*;
use std::collections::BTreeSet;

/// A graph with these edges, some of them loops or twice.
fn graph(n: usize, edges: &[(usize, usize)]) -> Graph {
    let mut columns: Vec<BTreeSet<usize>> = (0..n).map(|vertex| [vertex].into()).collect();
    for &(a, b) in edges {
        columns[a.min(b)].insert(a.max(b));
    }
    let mut col_ptr = vec![0];
    col_ptr.extend(columns.iter().scan(0, |sum, column| {
        *sum += column.len();
        Some(*sum)
    }));
    let rows: Vec<usize> = columns.into_iter().flatten().collect();
    Graph::of_rows(&Lower::new(n, &col_ptr, &rows).unwrap())
}

/// Sparse to dense, in one piece or in many; with weights 1.
fn graphs() -> impl Strategy<Value = Graph> {
    (1usize..300, 0usize..5).prop_flat_map(|(n, degree)| {
        let edges = proptest::collection::vec((0..n, 0..n), 0..=n * degree);
        edges.prop_map(move |edges| graph(n, &edges))
    })
}

fn all(graph: &Graph) -> Part {
    Part::of(graph, (0..graph.vertices() as u32).collect())
}

/// Weights between 1 and 6, as of beams and solids that meet.
fn weigh(graph: &mut Weighted) {
    graph.weight.iter_mut().zip(0..).for_each(|(weight, k)| *weight = 1 + (7 * k) % 6);
}

fn assert_permutation(graph: &Graph) {
    let mut order = Begun::new(graph, 1).order();
    order.sort_unstable();
    assert_eq!(order, (0..graph.vertices() as u32).collect::<Vec<_>>());
}

proptest! {
    #[test]
    fn an_order_has_every_vertex_once_and_is_always_the_same(graph in graphs()) {
        assert_permutation(&graph);
        prop_assert_eq!(Begun::new(&graph, 1).order(), Begun::new(&graph, 3).order());
    }

    #[test]
    fn pieces_are_the_graph_without_what_is_left_out(graph in graphs(), nth in 2u32..9) {
        let out = |vertex: u32| vertex.is_multiple_of(nth);
        let pieces = all(&graph).pieces(out);
        let mut piece_of = vec![None; graph.vertices()];
        for (k, piece) in pieces.iter().enumerate() {
            piece.vertices.iter().for_each(|&vertex| assert_eq!(piece_of[vertex as usize].replace(k), None));
            for (k, &vertex) in (0..).zip(&piece.vertices) {
                let mut inside: Vec<u32> = graph.neighbours(vertex as usize).to_vec();
                inside.retain(|&other| !out(other));
                let found = piece.graph.neighbours(k).iter().map(|&k| piece.vertices[k as usize]);
                prop_assert_eq!(inside, found.collect::<Vec<_>>());
            }
        }
        (0..).zip(piece_of).for_each(|(vertex, piece)| assert_eq!(piece.is_none(), out(vertex)));
    }

    #[test]
    fn a_separator_separates(graph in graphs()) {
        for mut part in all(&graph).pieces(|_| false) {
            weigh(&mut part.graph);
            let graph = part.graph;
            let separator = separator(&graph, &mut Random::new());
            let mut weight = [0; 3];
            for vertex in 0..graph.vertices() {
                let side = separator.side[vertex];
                weight[usize::from(side)] += u64::from(graph.weight[vertex]);
                for &other in graph.neighbours(vertex as u32) {
                    prop_assert!(side + separator.side[other as usize] != 1, "{} touches {}", vertex, other);
                }
            }
            prop_assert_eq!(weight, separator.weight);
            // To refine once more changes nothing for the worse.
            let cost = separator.cost();
            prop_assert!(separator.refined(&graph).cost() <= cost);
        }
    }

    #[test]
    fn a_coarse_graph_has_all_weights_and_edges(graph in graphs(), heaviest in 2u64..20) {
        let mut fine = all(&graph).graph;
        weigh(&mut fine);
        let coarse = coarsen(&fine, heaviest, &mut Random::new());
        let (mut weight, mut edges) = (vec![0; coarse.graph.vertices()], std::collections::BTreeMap::new());
        for vertex in 0..fine.vertices() as u32 {
            let own = coarse.of[vertex as usize];
            weight[own as usize] += fine.weight[vertex as usize];
            for (other, edge) in fine.edges(vertex).map(|(other, edge)| (coarse.of[other as usize], edge)) {
                *edges.entry((own, other)).or_insert(0) += if own == other { 0 } else { edge };
            }
        }
        edges.retain(|_, edge| *edge > 0);
        let found = (0..coarse.graph.vertices() as u32)
            .flat_map(|a| coarse.graph.edges(a).map(move |(b, edge)| ((a, b), edge)));
        prop_assert_eq!(found.collect::<std::collections::BTreeMap<_, _>>(), edges);
        prop_assert_eq!(&weight, &coarse.graph.weight);
        prop_assert!(weight.iter().all(|&weight| u64::from(weight) <= heaviest.max(6)));
    }

    #[test]
    fn a_leaf_is_eliminated_by_least_degree(graph in graphs(), nth in 2usize..6) {
        let own: Vec<u32> = (0..graph.vertices() as u32).step_by(nth).collect();
        let mut neighbours: Vec<BTreeSet<u32>> =
            (0..graph.vertices()).map(|vertex| graph.neighbours(vertex).iter().copied().collect()).collect();
        let mut left: BTreeSet<u32> = own.iter().copied().collect();
        for pivot in Leaves::new(&graph).order(&own) {
            let least = left.iter().map(|&vertex| neighbours[vertex as usize].len()).min();
            prop_assert_eq!(Some(neighbours[pivot as usize].len()), least);
            prop_assert!(left.remove(&pivot));
            let around = std::mem::take(&mut neighbours[pivot as usize]);
            for &vertex in &around {
                let mut others = around.clone();
                others.remove(&vertex);
                neighbours[vertex as usize].remove(&pivot);
                neighbours[vertex as usize].extend(others);
            }
        }
        prop_assert!(left.is_empty());
    }
}

#[test]
fn graphs_that_no_structure_has_are_ordered() {
    let pairs = |n: usize| (0..n).flat_map(move |a| (0..a).map(move |b| (a, b)));
    assert!(
        Begun::new(&graph(1, &[]), 1).order().len() == 1
            && Begun::new(&graph(5000, &[]), 2).order().len() == 5000
    );
    let complete: Vec<_> = pairs(150).collect();
    assert_permutation(&graph(150, &complete));
    // Two of them with one vertex in common, and one with a long tail.
    let two: Vec<_> = pairs(150).chain(pairs(150).map(|(a, b)| (a + 149, b + 149))).collect();
    assert_permutation(&graph(299, &two));
    let tail: Vec<_> = pairs(80).chain((80..5000).map(|k| (k - 1, k))).collect();
    assert_permutation(&graph(5000, &tail));
    let star: Vec<_> = (1..5000).map(|k| (0, k)).collect();
    assert_permutation(&graph(5000, &star));
    // Stars of stars: hardly a pair of neighbours, and no vertex that is next to all.
    let tree: Vec<_> = (1..5000).map(|k| ((k - 1) / 17, k)).collect();
    assert_permutation(&graph(5000, &tree));
    // No two vertices of a part are neighbours.
    let bipartite: Vec<_> = (0..100).flat_map(|a| (100..200).map(move |b| (a, b))).collect();
    assert_permutation(&graph(200, &bipartite));
}
