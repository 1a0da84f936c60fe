//! From the elimination of a graph to fronts: supernodes, amalgamation, rows, and the places of all entries.

use super::{Entry, Lower, NO_PARENT, Shape, Symbolic, costs};
use crate::ordering::{Elimination, Graph, postorder};

/// Vertices that are eliminated together.
struct Group {
    vertices: Vec<u32>,
    pivots: usize,
    below: usize,
    parent: usize,
}

/// `None` where the graph does not have all of the pattern's edges.
pub(super) fn build(pattern: &Lower, graph: &Graph, elimination: &Elimination) -> Option<Symbolic> {
    let groups = in_postorder(amalgamate(supernodes(elimination)));
    let numbering = Numbering::new(graph, &groups);
    let (fronts, rows) = shapes(graph, &groups, &numbering);
    let relative = relative(&fronts, &rows);
    let (entry_start, entries) = entries(pattern, &fronts, &rows, &numbering.position)?;
    let subtrees = costs::subtrees(&fronts);
    let (child_start, children) = children(&fronts);
    let mut depth = vec![0; fronts.len()];
    for k in (0..fronts.len()).rev().filter(|&k| fronts[k].parent != NO_PARENT) {
        depth[k] = depth[fronts[k].parent] + 1;
    }
    let (pattern, order) = (pattern.clone(), numbering.order);
    Some(Symbolic {
        pattern,
        order,
        fronts,
        rows,
        relative,
        entry_start,
        entries,
        child_start,
        children,
        depth,
        subtrees,
    })
}

fn children(fronts: &[Shape]) -> (Vec<usize>, Vec<u32>) {
    let with_parent = || fronts.iter().enumerate().filter(|(_, front)| front.parent != NO_PARENT);
    let mut start = vec![0; fronts.len() + 1];
    with_parent().for_each(|(_, front)| start[front.parent + 1] += 1);
    (0..fronts.len()).for_each(|k| start[k + 1] += start[k]);
    let mut next = start.clone();
    let mut children = vec![0; start[fronts.len()]];
    for (k, front) in with_parent() {
        children[next[front.parent]] = k as u32;
        next[front.parent] += 1;
    }
    (start, children)
}

/// Runs of vertices of which each has the rows of the one before it, but for itself.
fn supernodes(elimination: &Elimination) -> Vec<Group> {
    let steps = elimination.steps();
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of = vec![0; steps.len()];
    for (k, step) in steps.iter().enumerate() {
        let joins =
            k > 0 && elimination.parent(k - 1) == Some(k) && steps[k - 1].below == step.rows + step.below;
        if !joins {
            groups.push(Group { vertices: Vec::new(), pivots: 0, below: 0, parent: NO_PARENT });
        }
        group_of[k] = groups.len() - 1;
        if let Some(group) = groups.last_mut() {
            group.vertices.push(step.vertex);
            group.pivots += step.rows as usize;
            group.below = step.below as usize;
            // The step's parent for now: the group of it is not known yet.
            group.parent = elimination.parent(k).unwrap_or(NO_PARENT);
        }
    }
    for group in &mut groups {
        group.parent = renumbered(group.parent, &group_of);
    }
    groups
}

/// What a front costs, in multiplications: those of the elimination, and for the rest as measured on solids and
/// plates: an entry of a front is assembled and passed on for the price of some twenty, an entry of the factor
/// is read twice by every solution, and a front has an overhead of its own.
fn cost(pivots: usize, below: usize) -> f64 {
    let order = (pivots + below) as f64;
    costs::multiplications(pivots, below) + 20.0 * order * order + 2e4
}

/// Merges groups into their parents where the zeros that it adds cost less than what it saves.
fn amalgamate(mut groups: Vec<Group>) -> Vec<Group> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); groups.len()];
    let mut merged = vec![false; groups.len()];
    for k in 0..groups.len() {
        // The largest child first: next to its parent it adds the fewest zeros.
        let mut candidates = std::mem::take(&mut children[k]);
        let mut kept = Vec::new();
        candidates.sort_by_key(|&child| groups[child].below);
        while let Some(child) = candidates.pop() {
            let (own, other) = (&groups[k], &groups[child]);
            let apart = cost(own.pivots, own.below) + cost(other.pivots, other.below);
            if cost(own.pivots + other.pivots, own.below) > apart {
                kept.push(child);
                continue;
            }
            merged[child] = true;
            let vertices = std::mem::take(&mut groups[child].vertices);
            groups[k].pivots += groups[child].pivots;
            // A child's vertices before its parent's, whatever was merged before.
            let own = std::mem::replace(&mut groups[k].vertices, vertices);
            groups[k].vertices.extend(own);
            for grandchild in std::mem::take(&mut children[child]) {
                groups[grandchild].parent = k;
                kept.push(grandchild);
            }
        }
        children[k] = kept;
        if groups[k].parent != NO_PARENT {
            children[groups[k].parent].push(k);
        }
    }
    let mut new = vec![NO_PARENT; groups.len()];
    let kept = (0..groups.len()).filter(|&k| !merged[k]);
    kept.enumerate().for_each(|(to, from)| new[from] = to);
    let mut groups: Vec<Group> =
        groups.into_iter().zip(merged).filter(|(_, merged)| !merged).map(|(group, _)| group).collect();
    for group in &mut groups {
        group.parent = renumbered(group.parent, &new);
    }
    groups
}

/// Every subtree in one piece again, siblings so that the least waits in memory: first those that need much more
/// while they are worked on than they leave.
///
/// J. W. H. Liu, ACM Trans. Math. Softw. 12 (1986) 249–264.
fn in_postorder(groups: Vec<Group>) -> Vec<Group> {
    let parent = |k: usize| Some(groups[k].parent).filter(|&parent| parent != NO_PARENT);
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); groups.len()];
    let leaves = |k: usize| groups[k].below * groups[k].below / 2;
    // What a group needs beyond what it leaves.
    let mut excess = vec![0; groups.len()];
    for (k, group) in groups.iter().enumerate() {
        children[k].sort_by_key(|&child| std::cmp::Reverse(excess[child]));
        let (mut waiting, mut need) = (0, 0);
        for child in std::mem::take(&mut children[k]) {
            need = need.max(waiting + leaves(child) + excess[child]);
            waiting += leaves(child);
        }
        need = need.max(waiting + leaves(k) + group.pivots * (group.pivots + group.below));
        excess[k] = need - leaves(k);
        if let Some(parent) = parent(k) {
            children[parent].push(k);
        }
    }
    let mut listed: Vec<usize> = (0..groups.len()).collect();
    listed.sort_by_key(|&k| std::cmp::Reverse(excess[k]));
    let mut order = Vec::with_capacity(groups.len());
    postorder(groups.len(), parent, listed.into_iter(), |k| order.push(k));
    let mut new = vec![NO_PARENT; groups.len()];
    order.iter().enumerate().for_each(|(to, &from)| new[from] = to);
    let mut groups: Vec<Option<Group>> = groups.into_iter().map(Some).collect();
    let ordered = order.iter().filter_map(|&k| groups[k].take());
    ordered.map(|group| Group { parent: renumbered(group.parent, &new), ..group }).collect()
}

/// The new number of a parent, if there is one.
fn renumbered(parent: usize, new: &[usize]) -> usize {
    if parent == NO_PARENT { NO_PARENT } else { new[parent] }
}

/// Where vertices and rows come in the elimination.
struct Numbering {
    /// First position of each vertex.
    vertex: Vec<u32>,
    /// Position of each row.
    position: Vec<u32>,
    /// Row at each position.
    order: Vec<u32>,
}

impl Numbering {
    fn new(graph: &Graph, groups: &[Group]) -> Self {
        let mut vertex = vec![0; graph.vertices()];
        let mut order: Vec<u32> = Vec::new();
        for &v in groups.iter().flat_map(|group| &group.vertices) {
            vertex[v as usize] = order.len() as u32;
            order.extend(graph.rows(v as usize));
        }
        let mut position = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &row)| position[row as usize] = k as u32);
        Self { vertex, position, order }
    }
}

/// Fronts and the positions of their rows.
fn shapes(graph: &Graph, groups: &[Group], numbering: &Numbering) -> (Vec<Shape>, Vec<u32>) {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); groups.len()];
    let mut reached = vec![NO_PARENT; graph.vertices()];
    // Vertices below each group, ascending in position.
    let mut below: Vec<Vec<u32>> = Vec::with_capacity(groups.len());
    let (mut fronts, mut rows, mut first) = (Vec::with_capacity(groups.len()), Vec::new(), 0);
    for (k, group) in groups.iter().enumerate() {
        let end = first + group.pivots;
        let mut own: Vec<u32> = Vec::new();
        let mut reach = |v: u32| {
            let later = numbering.vertex[v as usize] as usize >= end;
            if later && std::mem::replace(&mut reached[v as usize], k) != k {
                own.push(v);
            }
        };
        group.vertices.iter().flat_map(|&v| graph.neighbours(v as usize)).for_each(|&v| reach(v));
        children[k].iter().flat_map(|&child| &below[child]).for_each(|&v| reach(v));
        own.sort_unstable_by_key(|&v| numbering.vertex[v as usize]);
        let from = rows.len();
        for &v in &own {
            let start = numbering.vertex[v as usize];
            rows.extend(start..start + graph.rows(v as usize).len() as u32);
        }
        fronts.push(Shape { first, pivots: group.pivots, rows: from..rows.len(), parent: group.parent });
        children[k].drain(..).for_each(|child| below[child] = Vec::new());
        below.push(own);
        if group.parent != NO_PARENT {
            children[group.parent].push(k);
        }
        first = end;
    }
    (fronts, rows)
}

/// Places of each front's rows among the own columns and rows of its parent.
fn relative(fronts: &[Shape], rows: &[u32]) -> Vec<u32> {
    let mut relative = Vec::with_capacity(rows.len());
    for front in fronts.iter().filter(|front| !front.rows.is_empty()) {
        let parent = &fronts[front.parent];
        let others = &rows[parent.rows.clone()];
        let mut at = 0;
        for &row in &rows[front.rows.clone()] {
            if parent.own().contains(&(row as usize)) {
                relative.push(row - parent.first as u32);
            } else {
                at += others[at..].iter().position(|&other| other == row).unwrap_or(0);
                relative.push((parent.pivots + at) as u32);
            }
        }
    }
    relative
}

/// The entries of each position's column, and their rows in its front.
fn entries(
    pattern: &Lower,
    fronts: &[Shape],
    rows: &[u32],
    position: &[u32],
) -> Option<(Vec<usize>, Vec<Entry>)> {
    let places = || {
        pattern.positions().map(|(row, col)| {
            let (p, q) = (position[row], position[col]);
            (p.max(q), p.min(q) as usize)
        })
    };
    let mut start = vec![0; pattern.dim + 1];
    places().for_each(|(_, col)| start[col + 1] += 1);
    (0..pattern.dim).for_each(|col| start[col + 1] += start[col]);
    let mut next = start.clone();
    let mut entries = vec![Entry { value: 0, row: 0 }; pattern.row_idx.len()];
    for (value, (row, col)) in places().enumerate() {
        entries[next[col]] = Entry { value: value as u32, row };
        next[col] += 1;
    }
    let mut local = vec![(NO_PARENT, 0u32); pattern.dim];
    for (k, front) in fronts.iter().enumerate() {
        for (place, row) in
            front.own().chain(rows[front.rows.clone()].iter().map(|&row| row as usize)).enumerate()
        {
            local[row] = (k, place as u32);
        }
        for entry in &mut entries[start[front.first]..start[front.own().end]] {
            let (owner, place) = local[entry.row as usize];
            if owner != k {
                return None;
            }
            entry.row = place;
        }
    }
    Some((start, entries))
}
