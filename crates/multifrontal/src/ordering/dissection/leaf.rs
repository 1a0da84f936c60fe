//! What is not dissected any more: minimum degree with the neighbours outside, which come later.

use crate::ordering::Graph;

const NO_COLUMN: u32 = u32::MAX;

/// Orders small parts of a graph.
pub(super) struct Leaves<'a> {
    graph: &'a Graph,
    /// Column of each vertex in the present part's rows of bits.
    column: Vec<u32>,
}

impl<'a> Leaves<'a> {
    pub(super) fn new(graph: &'a Graph) -> Self {
        Self { graph, column: vec![NO_COLUMN; graph.vertices()] }
    }

    /// The vertices of a part in the order of least degree, counted in rows of the factor with those outside.
    pub(super) fn order(&mut self, vertices: &[u32]) -> Vec<u32> {
        let own = vertices.len();
        // The part's own vertices and then those around it.
        let mut members = vertices.to_vec();
        members.iter().enumerate().for_each(|(k, &vertex)| self.column[vertex as usize] = k as u32);
        for &vertex in vertices {
            for &other in self.graph.neighbours(vertex as usize) {
                if self.column[other as usize] == NO_COLUMN {
                    self.column[other as usize] = members.len() as u32;
                    members.push(other);
                }
            }
        }
        let weight: Vec<u32> = members.iter().map(|&v| self.graph.rows(v as usize).len() as u32).collect();
        let words = members.len().div_ceil(64);
        let mut rows = vec![0u64; own * words];
        let mut degree = vec![0u32; own];
        for (k, &vertex) in vertices.iter().enumerate() {
            for &other in self.graph.neighbours(vertex as usize) {
                let column = self.column[other as usize] as usize;
                rows[k * words + column / 64] |= 1 << (column % 64);
                degree[k] += weight[column];
            }
        }
        members.iter().for_each(|&vertex| self.column[vertex as usize] = NO_COLUMN);

        let mut left: Vec<usize> = (0..own).collect();
        let mut order = Vec::with_capacity(own);
        while let Some(at) = (0..left.len()).min_by_key(|&at| degree[left[at]]) {
            let pivot = left.remove(at);
            order.push(vertices[pivot]);
            let row = rows[pivot * words..(pivot + 1) * words].to_vec();
            for &k in left.iter().filter(|&&k| row[k / 64] >> (k % 64) & 1 == 1) {
                for (word, (mine, &its)) in rows[k * words..(k + 1) * words].iter_mut().zip(&row).enumerate()
                {
                    let mut new = its & !*mine;
                    *mine |= its;
                    while new != 0 {
                        degree[k] += weight[64 * word + new.trailing_zeros() as usize];
                        new &= new - 1;
                    }
                }
                // Itself, which the pivot's row has, and the pivot.
                degree[k] -= weight[k] + weight[pivot];
                rows[k * words + k / 64] &= !(1 << (k % 64));
                rows[k * words + pivot / 64] &= !(1 << (pivot % 64));
            }
        }
        order
    }
}
