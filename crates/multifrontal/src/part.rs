//! Parts of a factor that can be solved with at the same time.

use crate::factor::Node;
use crate::scalar::Scalar;
use std::ops::Range;

/// Some nodes, and the positions that they see: their own, then those above that they change.
#[derive(Debug)]
pub(crate) struct Part {
    pub(crate) nodes: Vec<Range<usize>>,
    /// Positions that are eliminated here: runs that ascend, as the nodes do.
    pub(crate) own: Vec<Range<usize>>,
    /// Places in the last part of the positions that are eliminated there and changed here.
    pub(crate) outside: Vec<u32>,
}

impl Part {
    /// The subtrees, and last what is above all of them; gives the nodes' positions their places in their parts.
    pub(crate) fn of<T: Scalar>(
        subtrees: &[Range<usize>],
        firsts: &[usize],
        nodes: &mut [Node<T>],
        dim: usize,
    ) -> Vec<Self> {
        let position = |node: usize| firsts.get(node).copied().unwrap_or(dim);
        let mut parts: Vec<Self> = subtrees
            .iter()
            .map(|subtree| {
                let outside = nodes[subtree.end - 1].rows.clone();
                let own = position(subtree.start)..position(subtree.end);
                Self { nodes: vec![subtree.clone()], own: vec![own], outside }
            })
            .collect();
        let mut place = vec![0u32; dim];
        for part in &parts {
            part.give_places(firsts, nodes, &mut place);
        }
        parts.push(Self::between(subtrees, nodes.len(), position));
        if let Some((top, subtrees)) = parts.split_last_mut() {
            top.give_places(firsts, nodes, &mut place);
            for part in subtrees {
                part.outside.iter_mut().for_each(|row| *row = place[*row as usize]);
            }
        }
        parts
    }

    fn between(subtrees: &[Range<usize>], nodes: usize, position: impl Fn(usize) -> usize) -> Self {
        let starts = std::iter::once(0).chain(subtrees.iter().map(|subtree| subtree.end));
        let ends = subtrees.iter().map(|subtree| subtree.start).chain(std::iter::once(nodes));
        let nodes: Vec<_> =
            starts.zip(ends).map(|(start, end)| start..end).filter(|run| !run.is_empty()).collect();
        let own = nodes.iter().map(|run| position(run.start)..position(run.end)).collect();
        Self { nodes, own, outside: Vec::new() }
    }

    fn give_places<T: Scalar>(&self, firsts: &[usize], nodes: &mut [Node<T>], place: &mut [u32]) {
        let seen = self.own.iter().cloned().flatten().chain(self.outside.iter().map(|&row| row as usize));
        seen.enumerate().for_each(|(to, position)| place[position] = to as u32);
        for k in self.nodes.iter().cloned().flatten() {
            // A node without pivots has no place, and needs none.
            nodes[k].first = place.get(firsts[k]).map_or(0, |&first| first as usize);
            nodes[k].rows.iter_mut().for_each(|row| *row = place[*row as usize]);
        }
    }

    /// Positions that are seen here.
    pub(crate) fn size(&self) -> usize {
        self.len() + self.outside.len()
    }

    /// Positions that are eliminated here.
    pub(crate) fn len(&self) -> usize {
        self.own.iter().map(ExactSizeIterator::len).sum()
    }
}
