//! From elements to the matrices of a structure.

use crate::{Direction, Dof, Element, Error, Mass};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Values};
use std::sync::Arc;

/// A structure: D(ω) = Σ_g ( E_g K_g − ω² ρ_g M_g ) over its materials g, and where its rows are.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembled {
    /// Stiffness matrix of each material for E = 1, n × n; of an orthotropic plate, of each of its constants.
    pub stiffness: Vec<SymmetricMatrix>,
    /// Mass matrix of each material for ρ = 1, n × n; on the pattern of the stiffness unless lumped.
    pub mass: Vec<SymmetricMatrix>,
    /// The dof of each row, ascending by node and direction; held dofs have no row.
    pub dofs: Vec<Dof>,
    /// Coordinates in m of each node, that with label 1 first; held nodes included.
    pub nodes: Vec<[f64; 3]>,
}

impl Assembled {
    /// Row of a dof, counted from 0; `None` where it is held or there is no such dof.
    pub fn row(&self, node: usize, direction: Direction) -> Option<usize> {
        self.dofs.binary_search(&Dof { node, direction }).ok()
    }

    /// All rows of one direction, ascending.
    pub fn rows(&self, direction: Direction) -> impl Iterator<Item = usize> + '_ {
        self.dofs.iter().enumerate().filter(move |(_, dof)| dof.direction == direction).map(|(row, _)| row)
    }

    /// Label of the node nearest to a position, among those that move; the first of several.
    pub fn nearest(&self, position: [f64; 3]) -> Option<usize> {
        let distance = |label: usize| {
            let node = self.nodes[label - 1];
            (0..3).map(|axis| (node[axis] - position[axis]).powi(2)).sum::<f64>()
        };
        let moving = self.dofs.iter().map(|dof| dof.node);
        moving.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }
}

/// Equal elements of one material: their matrices, and the nodes (from 0) of each.
pub(crate) struct Group<const NODES: usize, const N: usize> {
    pub(crate) element: Element<N>,
    pub(crate) nodes: Vec<[usize; NODES]>,
    pub(crate) material: usize,
}

/// Assembles groups of elements whose nodes have the given directions, without the dofs that are held.
///
/// # Errors
/// [`Error::NothingMoves`], [`Error::NotFinite`].
pub(crate) fn assemble<const NODES: usize, const N: usize>(
    nodes: Vec<[f64; 3]>,
    directions: &[Direction],
    held: impl Fn(usize, Direction) -> bool,
    groups: &[Group<NODES, N>],
    mass: Mass,
) -> Result<Assembled, Error> {
    let numbering = Numbering::new(nodes.len(), directions, held);
    let dim = numbering.dofs.len();
    if dim == 0 {
        return Err(Error::NothingMoves);
    }
    let materials = groups.iter().map(|group| group.material + 1).max().unwrap_or(0);
    let mut assembled = Assembled { stiffness: Vec::new(), mass: Vec::new(), dofs: Vec::new(), nodes };
    for material in 0..materials {
        let groups: Vec<_> = groups.iter().filter(|group| group.material == material).collect();
        let coupled = Arc::new(numbering.pattern(&groups));
        let diagonal = || Arc::new(Pattern::new(dim, []));
        let mass_pattern = if mass == Mass::Lumped { diagonal() } else { Arc::clone(&coupled) };
        assembled.stiffness.push(numbering.sum(&groups, coupled, |element| element.stiffness)?);
        assembled.mass.push(numbering.sum(&groups, mass_pattern, |element| element.mass_matrix(mass))?);
    }
    assembled.dofs = numbering.dofs;
    Ok(assembled)
}

/// Which row each dof of each node has.
struct Numbering {
    per_node: usize,
    rows: Vec<Option<usize>>,
    dofs: Vec<Dof>,
}

impl Numbering {
    fn new(nodes: usize, directions: &[Direction], held: impl Fn(usize, Direction) -> bool) -> Self {
        let (mut rows, mut dofs) = (Vec::with_capacity(nodes * directions.len()), Vec::new());
        for node in 0..nodes {
            for &direction in directions {
                let moves = !held(node, direction);
                rows.push(moves.then_some(dofs.len()));
                if moves {
                    dofs.push(Dof { node: node + 1, direction });
                }
            }
        }
        Self { per_node: directions.len(), rows, dofs }
    }

    fn rows_of(&self, node: usize) -> &[Option<usize>] {
        &self.rows[node * self.per_node..][..self.per_node]
    }

    /// Couplings by pairs of nodes first: of bricks, a pair occurs in up to eight elements, and has nine positions.
    fn pattern<const NODES: usize, const N: usize>(&self, groups: &[&Group<NODES, N>]) -> Pattern {
        let elements = groups.iter().flat_map(|group| &group.nodes);
        let mut pairs: Vec<(usize, usize)> = elements
            .flat_map(|nodes| nodes.iter().flat_map(|&a| nodes.map(|b| (a.min(b), a.max(b)))))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        let block = |a: usize, b: usize| {
            let rows = self.rows_of(b).iter().flatten();
            rows.flat_map(move |&row| self.rows_of(a).iter().flatten().map(move |&col| (row, col)))
        };
        Pattern::new(self.dofs.len(), pairs.into_iter().flat_map(|(a, b)| block(a, b)))
    }

    fn sum<const NODES: usize, const N: usize>(
        &self,
        groups: &[&Group<NODES, N>],
        pattern: Arc<Pattern>,
        matrix: impl Fn(&Element<N>) -> [[f64; N]; N],
    ) -> Result<SymmetricMatrix, Error> {
        let mut values = vec![0.0; pattern.stored()];
        for group in groups {
            let matrix = matrix(&group.element);
            for nodes in &group.nodes {
                let rows: [Option<usize>; N] =
                    std::array::from_fn(|i| self.rows_of(nodes[i / self.per_node])[i % self.per_node]);
                for (i, row) in rows.iter().enumerate() {
                    for (j, col) in rows[..=i].iter().enumerate() {
                        // A lumped mass has no positions off its diagonal, and zeros there.
                        let position = row.zip(*col).and_then(|(row, col)| pattern.find(row, col));
                        position.into_iter().for_each(|k| values[k] += matrix[i][j]);
                    }
                }
            }
        }
        if !values.iter().all(|value| value.is_finite()) {
            return Err(Error::NotFinite);
        }
        Ok(SymmetricMatrix::new(pattern, Values::Real(values)))
    }
}
