//! stub
use crate::c64;
/// A solution at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The factor p̄ + c.
    pub factor: c64,
    /// misfit
    pub misfit: f64,
    /// std
    pub std: f64,
}
/// What is chosen at one frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Choice {
    /// Index of the node; `None` where none belongs to the path.
    pub chosen: Option<usize>,
    /// Other nodes that the data cannot exclude.
    pub alternatives: Vec<usize>,
    /// By how much the best path through anything else costs more, in nats.
    pub margin: f64,
}
/// Options.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelectOptions {
    /// Whether σ is known.
    pub sigma_known: bool,
}
impl Default for SelectOptions {
    fn default() -> Self {
        Self { sigma_known: true }
    }
}
/// Choose.
pub fn choose(_: &[f64], nodes: &[Vec<Node>], _: &SelectOptions) -> Vec<Choice> {
    nodes
        .iter()
        .map(|n| Choice {
            chosen: (0..n.len()).min_by(|&a, &b| n[a].misfit.total_cmp(&n[b].misfit)),
            alternatives: vec![],
            margin: 0.0,
        })
        .collect()
}
