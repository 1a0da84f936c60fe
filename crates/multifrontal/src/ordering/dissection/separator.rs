//! Separators: vertices between two sides of a graph that do not touch.

use super::weighted::Weighted;

/// The side of a separator's own vertices.
pub(super) const SEPARATOR_SIDE: u8 = 2;

/// Sides 0 and 1 of a graph without an edge between them, and the vertices [`SEPARATOR_SIDE`].
pub(super) struct Separator {
    pub(super) side: Vec<u8>,
    /// Weights of the sides and of what is between them.
    pub(super) weight: [u64; 3],
}

impl Separator {
    pub(super) fn new(graph: &Weighted, side: Vec<u8>) -> Self {
        let mut weight = [0; 3];
        side.iter().zip(&graph.weight).for_each(|(&side, &w)| weight[usize::from(side)] += u64::from(w));
        Self { side, weight }
    }

    /// s (a + b)² / 4ab: the separator's weight s, the dearer the less even its sides a and b are.
    ///
    /// T. Leighton, S. Rao, J. ACM 46 (1999) 787–832 weigh cuts so.
    pub(super) fn cost(&self) -> f64 {
        let [a, b, s] = self.weight.map(|weight| weight as f64);
        // What has but one side separates nothing.
        if a * b == 0.0 { f64::INFINITY } else { s * (a + b) * (a + b) / (4.0 * a * b) }
    }

    pub(super) fn is_between(&self, vertex: u32) -> bool {
        self.side[vertex as usize] == SEPARATOR_SIDE
    }

    pub(super) fn set(&mut self, graph: &Weighted, vertex: u32, side: u8) {
        let weight = u64::from(graph.weight[vertex as usize]);
        let old = std::mem::replace(&mut self.side[vertex as usize], side);
        self.weight[usize::from(old)] -= weight;
        self.weight[usize::from(side)] += weight;
    }
}
