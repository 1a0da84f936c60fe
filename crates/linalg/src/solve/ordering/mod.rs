//! Fill-reducing orderings of symmetric patterns.

mod elimination;
mod graph;

pub(super) use elimination::Elimination;

use crate::sparse::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use feral_scotch::{CscPattern, ScotchOptions, scotch_order_full};
use graph::Graph;

/// From this many operations an edge on nested dissection is tried: it takes as long as 2e4 operations an edge
/// (measured on plates, sandwiches and blocks of 10k to 50k dofs), and where a factorisation takes less than
/// that, as in small and thin structures, nothing can be gained.
const DISSECT_FROM: f64 = 2e4;

/// Rows in the order of their elimination, subtrees in one piece; `None` where memory is short.
///
/// Minimum degree or nested dissection of the graph of nodes, whichever costs fewer operations. The same
/// pattern always has the same order.
///
/// # Source
/// P. R. Amestoy, T. A. Davis, I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905;
/// F. Pellegrini, J. Roman, HPCN Europe 1996, LNCS 1067, 493–498.
pub(super) fn fill_reducing(pattern: &Pattern) -> Option<Vec<usize>> {
    let graph = Graph::compressed(pattern);
    let eliminate = |order| Elimination::new(order, |v| graph.neighbours(v), |v| graph.rows[v].len());
    let mut best = eliminate(minimum_degree(&graph)?);
    if best.flops() > DISSECT_FROM * graph.edges() {
        // No dissection (a graph of more than 2³¹ edges) is no failure: minimum degree remains.
        best =
            nested_dissection(&graph).map(eliminate).filter(|it| it.flops() < best.flops()).unwrap_or(best);
    }
    Some(best.postorder().into_iter().flat_map(|vertex| graph.rows[vertex].iter().copied()).collect())
}

fn minimum_degree(graph: &Graph) -> Option<Vec<usize>> {
    let n = graph.rows.len();
    let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
    let scratch = amd::order_scratch::<usize>(n, graph.neighbours.len());
    let mut buffer = MemBuffer::try_new(scratch).ok()?;
    let adjacency = SymbolicSparseColMatRef::new_checked(n, n, &graph.start, None, &graph.neighbours);
    amd::order(&mut order, &mut inverse, adjacency, Default::default(), MemStack::new(&mut buffer)).ok()?;
    Some(order)
}

fn nested_dissection(graph: &Graph) -> Option<Vec<usize>> {
    let narrow = |of: &[usize]| of.iter().map(|&k| i32::try_from(k).ok()).collect::<Option<Vec<_>>>();
    let (start, neighbours) = (narrow(&graph.start)?, narrow(&graph.neighbours)?);
    let pattern = CscPattern::new(graph.rows.len(), &start, &neighbours)?;
    // Compressed already, and the seed is part of the defaults.
    let options = ScotchOptions { compress: false, ..ScotchOptions::default() };
    let (order, ..) = scotch_order_full(&pattern, &options).ok()?;
    order.into_iter().map(|vertex| usize::try_from(vertex).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// n³ nodes, each coupled to its neighbours along the axes and diagonals, with 3 dofs.
    fn cube(n: usize) -> Pattern {
        let node = move |p: usize| [p / n / n, p / n % n, p % n];
        let near = move |p: usize, q: usize| node(p).iter().zip(node(q)).all(|(&a, b)| a.abs_diff(b) <= 1);
        let pairs =
            (0..n * n * n).flat_map(move |p| (0..=p).filter(move |&q| near(p, q)).map(move |q| (p, q)));
        let dofs = pairs.flat_map(|(p, q)| (0..9).map(move |k| (3 * p + k / 3, 3 * q + k % 3)));
        Pattern::new(3 * n * n * n, dofs)
    }

    fn is_permutation(order: &[usize], n: usize) -> bool {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        sorted.into_iter().eq(0..n)
    }

    #[test]
    fn dofs_of_a_node_are_one_vertex_and_stay_together() {
        let pattern = cube(12);
        assert_eq!(Graph::compressed(&pattern).rows.len(), 12 * 12 * 12);
        let order = fill_reducing(&pattern).unwrap();
        assert!(is_permutation(&order, pattern.dim()));
        assert!(order.chunks(3).all(|dofs| dofs[0] % 3 == 0 && dofs[2] == dofs[0] + 2));
    }

    #[test]
    fn a_solid_is_dissected_the_same_way_every_time() {
        let pattern = cube(12);
        let graph = Graph::compressed(&pattern);
        let flops = |order| Elimination::new(order, |v| graph.neighbours(v), |v| graph.rows[v].len()).flops();
        let by_degree = flops(minimum_degree(&graph).unwrap());
        let by_dissection = flops(nested_dissection(&graph).unwrap());
        assert!(
            by_degree > DISSECT_FROM * graph.edges() && by_dissection < by_degree,
            "{by_degree:e} {by_dissection:e}"
        );
        let order = fill_reducing(&pattern).unwrap();
        assert_eq!(order, fill_reducing(&pattern).unwrap());
        // Postordering changes no count: the order that is returned costs what the better one does.
        let vertex = |rows: &[usize]| rows[0] / 3;
        assert_eq!(flops(order.chunks(3).map(vertex).collect()), by_dissection);
    }

    proptest! {
        /// Any pattern at all: a permutation, and counts as a dense elimination of the pattern has them.
        #[test]
        fn counts_are_those_of_elimination(
            n in 1usize..40,
            positions in prop::collection::vec((0usize..40, 0usize..40), 0..120),
        ) {
            let pattern = Pattern::new(n, positions.into_iter().map(|(i, j)| (i % n, j % n)));
            let order = fill_reducing(&pattern).unwrap();
            prop_assert!(is_permutation(&order, n));
            let graph = Graph::compressed(&pattern);
            let vertices = minimum_degree(&graph).unwrap();
            let rows: Vec<usize> = vertices.iter().flat_map(|&v| graph.rows[v].iter().copied()).collect();
            let elimination = Elimination::new(vertices, |v| graph.neighbours(v), |v| graph.rows[v].len());
            let mut filled: Vec<Vec<bool>> =
                rows.iter().map(|&i| rows.iter().map(|&j| pattern.find(i, j).is_some()).collect()).collect();
            let (mut entries, mut flops) = (0, 0.0);
            for k in 0..n {
                let below: Vec<usize> = (k + 1..n).filter(|&i| filled[i][k]).collect();
                below.iter().for_each(|&i| below.iter().for_each(|&j| filled[i][j] = true));
                entries += below.len() + 1;
                flops += ((below.len() + 1) as f64).powi(2);
            }
            prop_assert_eq!((elimination.entries(), elimination.flops()), (entries, flops));
        }
    }
}
