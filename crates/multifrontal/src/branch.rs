//! Branches of a factor that can be solved with at the same time.

use crate::factor::Node;
use crate::scalar::Scalar;
use crate::symbolic::{NO_PARENT, Symbolic};
use std::cmp::Reverse;
use std::ops::Range;

/// Neighbouring nodes, and the positions that they see: their own, then those above that they change.
#[derive(Debug)]
pub(crate) struct Branch {
    pub(crate) nodes: Range<usize>,
    /// Positions that are eliminated here.
    pub(crate) own: Range<usize>,
    /// Places in the branch above of the positions that are changed here.
    pub(crate) outside: Vec<u32>,
    /// The branches right below, the one with most numbers first.
    pub(crate) below: Vec<usize>,
    /// Whether it is above subtrees: its nodes are large, and few others stand beside them.
    pub(crate) top: bool,
}

impl Branch {
    /// Subtrees, and what is above them, as long as no two subtrees meet, in one branch each; gives the rows of nodes
    /// (positions so far) their places in their branches. Last the branches below no other.
    pub(crate) fn of<T: Scalar>(
        symbolic: &Symbolic,
        firsts: &[usize],
        nodes: &mut [Node<T>],
    ) -> (Vec<Self>, Vec<usize>) {
        let position = |node: usize| firsts.get(node).copied().unwrap_or(symbolic.dim());
        let runs = runs(symbolic);
        let mut below = vec![Vec::new(); runs.len() + 1];
        let mut numbers = vec![0; runs.len() + 1];
        let mut place = vec![0u32; symbolic.dim()];
        let mut branches: Vec<Self> = Vec::with_capacity(runs.len());
        for (k, (nodes_here, top)) in runs.iter().enumerate() {
            let own = position(nodes_here.start)..position(nodes_here.end);
            let outside = nodes[nodes_here.end - 1].rows.clone();
            let seen = own.clone().chain(outside.iter().map(|&row| row as usize));
            seen.enumerate().for_each(|(to, position)| place[position] = to as u32);
            let to_place = |row: &mut u32| *row = place[*row as usize];
            for node in nodes_here.clone() {
                nodes[node].first = position(node) - own.start;
                nodes[node].rows.iter_mut().for_each(to_place);
                numbers[k] += nodes[node].numbers();
            }
            let mut below_here: Vec<usize> = std::mem::take(&mut below[k]);
            below_here.iter().for_each(|&branch| branches[branch].outside.iter_mut().for_each(to_place));
            below_here.sort_by_key(|&branch| Reverse(numbers[branch]));
            // Behind the last branch where it is below none.
            let above = match symbolic.fronts[nodes_here.end - 1].parent {
                NO_PARENT => runs.len(),
                parent => runs.partition_point(|(nodes, _)| nodes.end <= parent),
            };
            below[above].push(k);
            numbers[above] += numbers[k];
            branches.push(Self { nodes: nodes_here.clone(), own, outside, below: below_here, top: *top });
        }
        (branches, below.pop().unwrap_or_default())
    }

    /// Positions that are seen here.
    pub(crate) fn size(&self) -> usize {
        self.own.len() + self.outside.len()
    }
}

/// The nodes of each branch, and whether it is above subtrees.
fn runs(symbolic: &Symbolic) -> Vec<(Range<usize>, bool)> {
    let count = symbolic.fronts.len();
    if symbolic.subtrees.is_empty() {
        return if count == 0 { Vec::new() } else { vec![(0..count, true)] };
    }
    let mut runs: Vec<(Range<usize>, bool)> = Vec::new();
    let mut subtrees = symbolic.subtrees.iter().peekable();
    let mut k = 0;
    while k < count {
        if let Some(subtree) = subtrees.next_if(|subtree| subtree.start == k) {
            runs.push((subtree.clone(), false));
            k = subtree.end;
            continue;
        }
        match runs.last_mut() {
            // An only child comes right before its parent.
            Some((above, true)) if symbolic.children_of(k).len() == 1 => above.end = k + 1,
            _ => runs.push((k..k + 1, true)),
        }
        k += 1;
    }
    runs
}
