//! What orderings cost: operations of L D Lᵀ and seconds of the analysis, for structures and for graphs that
//! are none.
//!
//! An argument is a part of the names that are shown, a second one scatters the numbers of the nodes.

#![allow(clippy::print_stdout, reason = "an example shows what it finds")]

use multifrontal::{Options, Ordering, Symbolic};
use std::time::Instant;

/// Nodes with some dofs each, and what they are coupled to.
struct Mesh {
    name: &'static str,
    nodes: usize,
    dofs: usize,
    edges: Vec<(usize, usize)>,
    /// Nodes along the axes, where it is a grid.
    sides: Option<[usize; 3]>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let only = arguments.next().unwrap_or_default();
    let scattered = arguments.next().is_some();
    println!(
        "{:14} {:>9} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8}",
        "Gflop", "nodes", "degree", "dissection", "automatic", "planes", "diss. s", "auto. s"
    );
    for mut mesh in meshes().into_iter().filter(|mesh| mesh.name.contains(&only)) {
        if scattered {
            mesh.shuffle();
        }
        let (col_ptr, row_idx) = mesh.lower();
        let dim = mesh.nodes * mesh.dofs;
        let analyse = |ordering: &Ordering| {
            let options = Options::default().with_ordering(ordering.clone());
            Symbolic::new(dim, &col_ptr, &row_idx, &options)
        };
        let best_of = |ordering: &Ordering| -> Result<(f64, f64), multifrontal::PatternError> {
            let (mut least, mut flops) = (f64::INFINITY, 0.0);
            for _ in 0..3 {
                let start = Instant::now();
                flops = analyse(ordering)?.flops();
                least = least.min(start.elapsed().as_secs_f64());
            }
            Ok((flops * 1e-9, least))
        };
        let degree = analyse(&Ordering::MinimumDegree)?.flops() * 1e-9;
        let (dissection, dissection_seconds) = best_of(&Ordering::NestedDissection)?;
        let (automatic, automatic_seconds) = best_of(&Ordering::Automatic)?;
        let planes = match mesh.planes() {
            Some(order) => format!("{:10.4}", analyse(&Ordering::Given(order))?.flops() * 1e-9),
            None => String::new(),
        };
        println!(
            "{:14} {:9} {degree:10.4} {dissection:10.4} {automatic:10.4} {planes:>10} {dissection_seconds:8.3} {automatic_seconds:8.3}",
            mesh.name, mesh.nodes
        );
    }
    Ok(())
}

/// Structures as in the comparison of solvers, and others that break orderings.
fn meshes() -> Vec<Mesh> {
    vec![
        // Cubes of bricks and a sandwich that are clamped at a face, a plate that is at all of its edges.
        grid("block-3k", [10, 10, 10], 3),
        grid("block-12k", [16, 16, 16], 3),
        grid("block-50k", [25, 26, 26], 3),
        grid("block-150k", [36, 37, 37], 3),
        grid("sandwich-50k", [160, 21, 5], 3),
        grid("plate-50k", [130, 130, 1], 3),
        grid("beam", [400, 6, 6], 3),
        grid("shell", [40, 300, 1], 6),
        frame(),
        springs(25),
        random(3000, 4),
        pieces(),
        star(20_000),
        constrained(),
    ]
}

impl Mesh {
    /// Numbers the nodes without order.
    fn shuffle(&mut self) {
        let mut state = 7u64;
        let mut number: Vec<usize> = (0..self.nodes).collect();
        for k in (1..self.nodes).rev() {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            number.swap(k, (state >> 33) as usize % (k + 1));
        }
        self.edges.iter_mut().for_each(|(a, b)| (*a, *b) = (number[*a], number[*b]));
        self.sides = None;
    }

    /// The lower triangle by columns.
    fn lower(&self) -> (Vec<usize>, Vec<usize>) {
        let mut columns: Vec<Vec<usize>> = (0..self.nodes).map(|node| vec![node]).collect();
        for &(a, b) in &self.edges {
            columns[a.min(b)].push(a.max(b));
        }
        let (mut col_ptr, mut row_idx) = (vec![0], Vec::new());
        for (node, column) in columns.iter_mut().enumerate() {
            column.sort_unstable();
            column.dedup();
            for col in (0..self.dofs).map(|dof| self.dofs * node + dof) {
                let rows =
                    column.iter().flat_map(|other| (0..self.dofs).map(move |dof| self.dofs * other + dof));
                row_idx.extend(rows.filter(|&row| row >= col));
                col_ptr.push(row_idx.len());
            }
        }
        (col_ptr, row_idx)
    }

    /// Nested dissection of a grid by planes across its longest side.
    fn planes(&self) -> Option<Vec<usize>> {
        let sides = self.sides?;
        let mut nodes = Vec::new();
        dissect([0; 3], sides, &mut |node| nodes.push((node[0] * sides[1] + node[1]) * sides[2] + node[2]));
        Some(
            nodes
                .into_iter()
                .flat_map(|node| (0..self.dofs).map(move |dof| self.dofs * node + dof))
                .collect(),
        )
    }
}

fn dissect(from: [usize; 3], to: [usize; 3], visit: &mut impl FnMut([usize; 3])) {
    let longest = (0..3).max_by_key(|&axis| to[axis] - from[axis]).unwrap_or(0);
    let middle = usize::midpoint(from[longest], to[longest]);
    let until = |end: usize| std::array::from_fn(|axis| if axis == longest { end } else { to[axis] });
    let since = |start: usize| std::array::from_fn(|axis| if axis == longest { start } else { from[axis] });
    if to[longest] - from[longest] > 2 {
        dissect(from, until(middle), visit);
        dissect(since(middle + 1), to, visit);
        dissect(since(middle), until(middle + 1), visit);
        return;
    }
    for x in from[0]..to[0] {
        for y in from[1]..to[1] {
            (from[2]..to[2]).for_each(|z| visit([x, y, z]));
        }
    }
}

/// Nodes that are coupled to all of those around them.
fn grid(name: &'static str, sides: [usize; 3], dofs: usize) -> Mesh {
    let nodes = sides.iter().product();
    let at = |node: usize| [node / sides[2] / sides[1], node / sides[2] % sides[1], node % sides[2]];
    let mut edges = Vec::new();
    for node in 0..nodes {
        for step in 14..27 {
            let to: [usize; 3] = std::array::from_fn(|k| at(node)[k] + step / [9, 3, 1][k] % 3);
            if (0..3).all(|k| (1..=sides[k]).contains(&to[k])) {
                edges.push((node, ((to[0] - 1) * sides[1] + to[1] - 1) * sides[2] + to[2] - 1));
            }
        }
    }
    Mesh { name, nodes, dofs, edges, sides: Some(sides) }
}

/// A storey frame of beams: nodes along columns and girders.
fn frame() -> Mesh {
    let (bays, storeys, parts) = (6, 40, 8);
    let joint = |x: usize, y: usize, z: usize| (z * bays + y) * bays + x;
    let joints = bays * bays * storeys;
    let (mut nodes, mut edges) = (joints, Vec::new());
    for p in 0..joints {
        let [x, y, z] = [p % bays, p / bays % bays, p / bays / bays];
        let ends = [(x + 1 < bays).then(|| joint(x + 1, y, z)), (y + 1 < bays).then(|| joint(x, y + 1, z))];
        for end in ends.into_iter().chain([(z + 1 < storeys).then(|| joint(x, y, z + 1))]).flatten() {
            let mut last = p;
            for _ in 1..parts {
                edges.push((last, nodes));
                last = nodes;
                nodes += 1;
            }
            edges.push((last, end));
        }
    }
    Mesh { name: "frame", nodes, dofs: 6, edges, sides: None }
}

/// A cube of masses with springs to their neighbours along the axes.
fn springs(n: usize) -> Mesh {
    let node = |x: usize, y: usize, z: usize| (x * n + y) * n + z;
    let mut edges = Vec::new();
    for p in 0..n * n * n {
        let [x, y, z] = [p / n / n, p / n % n, p % n];
        let ends = [(x + 1, y, z), (x, y + 1, z), (x, y, z + 1)];
        let inside = ends.into_iter().filter(|end| end.0 < n && end.1 < n && end.2 < n);
        edges.extend(inside.map(|(x, y, z)| (p, node(x, y, z))));
    }
    Mesh { name: "springs", nodes: n * n * n, dofs: 1, edges, sides: Some([n; 3]) }
}

fn random(nodes: usize, degree: usize) -> Mesh {
    let mut state = 1u64;
    let mut draw = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % nodes
    };
    let edges = (0..nodes * degree / 2).map(|_| (draw(), draw())).filter(|(a, b)| a != b).collect();
    Mesh { name: "random", nodes, dofs: 1, edges, sides: None }
}

/// Some blocks that do not touch, and many nodes alone.
fn pieces() -> Mesh {
    let piece = grid("", [12; 3], 3);
    let edges = (0..6).flat_map(|k| piece.edges.iter().map(move |(a, b)| (a + k * 1728, b + k * 1728)));
    Mesh { name: "pieces", nodes: 6 * 1728 + 2000, dofs: 3, edges: edges.collect(), sides: None }
}

fn star(nodes: usize) -> Mesh {
    Mesh { name: "star", nodes, dofs: 1, edges: (1..nodes).map(|node| (0, node)).collect(), sides: None }
}

/// A block with constraints that hold on a face of it each, and one that holds everywhere.
fn constrained() -> Mesh {
    let block = grid("", [20; 3], 3);
    let (mut edges, nodes) = (block.edges, block.nodes);
    edges.extend((0..nodes).map(|node| (node, nodes)));
    edges.extend((0..400).map(|node| (node, nodes + 1)));
    edges.extend((0..400).map(|k| (20 * k, nodes + 2)));
    Mesh { name: "constrained", nodes: nodes + 3, dofs: 3, edges, sides: None }
}
