//! From a structure, and what is different in truth, to matrices.

use super::Failure;
use super::fault::{Change, Unknowns};
use super::structure::{Kind, SKIN_POISSON, Structure};
use frfit::c64;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Role, Term};
use frfit_fem::OrthotropicPlate;
use frfit_fem::brick::{Face, Layer};
use frfit_fem::{Assembled, Beam, Brick, Direction, Plate, Support};
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};

/// The term whose factor is unknown.
pub const UNKNOWN: &str = "unknown";

/// The terms of an orthotropic plate.
const CONSTANTS: [&str; 4] = [UNKNOWN, "D22", "D12", "D66"];

/// A structure as a finite element model.
#[derive(Debug)]
pub struct Realised {
    /// Its terms.
    pub model: DynamicStiffness,
    assembled: Assembled,
    /// What is to be added to a position in the frame of the structure.
    shift: [f64; 3],
    /// Distances below this count as zero, in m.
    tolerance: f64,
}

impl Realised {
    /// A structure with a law of its unknown material, and what is different.
    ///
    /// # Errors
    /// Where a change leaves nothing that moves, or something is attached where nothing does.
    pub fn new(structure: &Structure, law: &Law, change: &Change) -> Result<Self, Failure> {
        let (assembled, shift) = assemble(structure, change)?;
        let tolerance = 1e-6 * structure.thickness();
        let rows = Rows { assembled: &assembled, shift, tolerance };
        let mut terms = Vec::new();
        let mut add = |name: &str, role, matrix: &SymmetricMatrix, factor| {
            terms.push(Term { name: name.to_owned(), role, matrix: matrix.clone(), factor });
        };
        let real = |value: f64| Law::Constant(c64::new(value, 0.0));
        let sandwich = structure.kind == Kind::Sandwich;
        let unknown = usize::from(sandwich);
        if structure.kind == Kind::OrthotropicPlate {
            let constants = CONSTANTS.iter().zip(&assembled.stiffness).zip(structure.orthotropy);
            constants.for_each(|((name, matrix), over)| add(name, Role::Stiffness, matrix, law.scaled(over)));
        } else {
            add(UNKNOWN, Role::Stiffness, &assembled.stiffness[unknown], law.clone());
        }
        add("mass", Role::Mass, &assembled.mass[unknown], real(change.mass * structure.density));
        if sandwich {
            let (modulus, density) = structure.skins;
            add("skins", Role::Stiffness, &assembled.stiffness[0], Law::Constant(change.known * modulus));
            add("skins-mass", Role::Mass, &assembled.mass[0], real(change.mass * density));
        }
        for (k, spring) in structure.springs.iter().enumerate() {
            let steps = structure.mesh[0] as f64;
            let position = [(spring.at * steps).round() / steps * structure.length, 0.0, 0.0];
            let at_node = diagonal(&assembled, [(rows.find(position, Direction::Z)?, 1.0)]);
            let name = format!("spring-{k}");
            add(&name, Role::Stiffness, &at_node, Law::Constant(change.known * spring.stiffness));
        }
        for (k, &(position, kilograms)) in change.masses.iter().enumerate() {
            let all = [Direction::X, Direction::Y, Direction::Z]
                .map(|direction| rows.find(position, direction).ok());
            let matrix = diagonal(&assembled, all.into_iter().flatten().map(|row| (row, kilograms)));
            add(&format!("point-mass-{k}"), Role::Mass, &matrix, real(1.0));
        }
        for (k, &(position, stiffness)) in change.suspension.iter().enumerate() {
            let matrix = diagonal(&assembled, [(rows.find(position, Direction::Z)?, 1.0)]);
            add(&format!("suspension-{k}"), Role::Stiffness, &matrix, Law::Constant(stiffness));
        }
        if let Some(stiff) = change.clamp {
            let matrix = diagonal(&assembled, clamp(structure, &assembled, stiff, tolerance));
            add("clamp", Role::Stiffness, &matrix, real(1.0));
        }
        Ok(Self { model: DynamicStiffness::new(terms)?, shift, tolerance, assembled })
    }

    /// Terms whose factors are unknown, with those that they have.
    pub fn unknowns(&self, unknowns: Unknowns) -> Vec<(String, Law)> {
        let is_held = |name: &str| name.starts_with("suspension") || name == "clamp";
        let is_unknown = |term: &&Term| match unknowns {
            Unknowns::One => term.name == UNKNOWN,
            Unknowns::Several => term.role == Role::Stiffness && !is_held(&term.name),
        };
        let terms = self.model.terms().iter().filter(is_unknown);
        terms.map(|term| (term.name.clone(), term.factor.clone())).collect()
    }

    /// Where the structure may be driven and measured, in its own frame: all nodes that move along Z; of bricks those of the upper side.
    pub fn stations(&self) -> Vec<[f64; 3]> {
        let top = self.assembled.nodes.iter().map(|node| node[2]).fold(f64::NEG_INFINITY, f64::max);
        let rows = self.assembled.rows(Direction::Z).map(|row| self.assembled.dofs[row].node);
        let nodes =
            rows.map(|node| self.assembled.nodes[node - 1]).filter(|node| node[2] >= top - self.tolerance);
        nodes.map(|node| std::array::from_fn(|axis| node[axis] - self.shift[axis])).collect()
    }

    /// The row of Z at a station.
    ///
    /// # Errors
    /// Where no node is.
    pub fn row(&self, station: [f64; 3]) -> Result<usize, Failure> {
        let Self { assembled, shift, tolerance, .. } = self;
        Rows { assembled, shift: *shift, tolerance: *tolerance }.find(station, Direction::Z)
    }
}

struct Rows<'a> {
    assembled: &'a Assembled,
    shift: [f64; 3],
    tolerance: f64,
}

impl Rows<'_> {
    fn find(&self, position: [f64; 3], direction: Direction) -> Result<usize, Failure> {
        let position = std::array::from_fn(|axis| position[axis] + self.shift[axis]);
        let near = |&node: &usize| {
            let found = self.assembled.nodes[node - 1];
            (0..3).all(|axis| (found[axis] - position[axis]).abs() <= self.tolerance)
        };
        let row = self
            .assembled
            .nearest(position)
            .filter(near)
            .and_then(|node| self.assembled.row(node, direction));
        row.ok_or_else(|| format!("nothing moves along {direction} at {position:?}").into())
    }
}

/// Entries on the diagonal.
fn diagonal(assembled: &Assembled, entries: impl IntoIterator<Item = (usize, f64)>) -> SymmetricMatrix {
    let mut triplets = Triplets::new(assembled.dofs.len());
    entries.into_iter().for_each(|(row, value)| triplets.add(row, row, value));
    triplets.assemble()
}

/// The matrices, and where the structure's origin is in their frame.
fn assemble(structure: &Structure, change: &Change) -> Result<(Assembled, [f64; 3]), Failure> {
    let Structure { length, width, .. } = *structure;
    let mesh = structure.mesh.map(|elements| elements * change.plan);
    // A clamp that gives is a free edge on springs.
    let released =
        |support| if change.clamp.is_some() && support == Support::Clamped { Support::Free } else { support };
    let edges = structure.edges.map(released);
    if structure.kind != Kind::Sandwich && !change.bricks {
        let assembled = match structure.kind {
            Kind::OrthotropicPlate => {
                let lines = |side: f64, steps: usize| -> Vec<f64> {
                    (0..=steps).map(|k| side * k as f64 / steps as f64).collect()
                };
                let lines = [lines(length, mesh[0]), lines(width, mesh[1])];
                let thickness = structure.thickness();
                OrthotropicPlate { lines, thickness, edges, ..OrthotropicPlate::default() }.assemble()?
            }
            Kind::Plate => {
                let (sides, thickness, poisson) = ([length, width], structure.thickness(), structure.poisson);
                Plate { sides, thickness, poisson, elements: mesh, edges, ..Plate::default() }.assemble()?
            }
            _ => {
                let (area, inertia) = (width * structure.thickness(), structure.bending());
                let ends = [edges[0], edges[1]];
                Beam { length, area, inertia, elements: mesh[0], ends, ..Beam::default() }.assemble()?
            }
        };
        return Ok((assembled, [0.0; 3]));
    }
    let faces = [Face::XMin, Face::XMax, Face::YMin, Face::YMax].into_iter().zip(edges);
    let clamped = faces.filter(|(_, edge)| *edge == Support::Clamped).map(|(face, _)| face).collect();
    let layer = |thickness, material, elements, poisson| Layer { thickness, elements, poisson, material };
    let (layers, across, shift) = match structure.layers.as_slice() {
        &[below, core, above] => {
            let n = change.layers;
            let skin = |thickness| layer(thickness, 0, n, SKIN_POISSON);
            (vec![skin(below), layer(core, 1, n, structure.poisson), skin(above)], mesh[1], [0.0; 3])
        }
        // Two elements through the thickness, so that there are nodes in the middle, where plates and beams have theirs.
        _ => {
            let thickness = structure.thickness();
            let is_plate = structure.kind == Kind::Plate;
            let (across, y) = if is_plate { (mesh[1], 0.0) } else { (2, 0.5 * width) };
            (vec![layer(thickness, 0, 2, structure.poisson)], across, [0.0, y, 0.5 * thickness])
        }
    };
    let brick = Brick { length, width, elements: [mesh[0], across], layers, clamped, ..Brick::default() };
    Ok((brick.assemble()?, shift))
}

/// What springs of a clamp that gives have in deflection over what they have in rotation, in units of the structure: clamps turn long before they shift.
const SHIFT: f64 = 1e4;

/// Springs in place of clamped edges, (row, N/m or N·m/rad), `stiff` times as stiff as the structure is on its length.
fn clamp(structure: &Structure, assembled: &Assembled, stiff: f64, tolerance: f64) -> Vec<(usize, f64)> {
    let Structure { length, width, storage, .. } = *structure;
    let mut springs = Vec::new();
    let clamped = structure.edges.iter().enumerate().filter(|(_, edge)| **edge == Support::Clamped);
    for (edge, _) in clamped {
        let (along, across) = if edge < 2 { (length, width) } else { (width, length) };
        let place = [0.0, length, 0.0, width][edge];
        let on_edge = |node: &[f64; 3]| (node[edge / 2] - place).abs() <= tolerance;
        let nodes = assembled.nodes.iter().filter(|node| on_edge(node)).count().max(1) as f64;
        for (row, dof) in assembled.dofs.iter().enumerate() {
            if !on_edge(&assembled.nodes[dof.node - 1]) {
                continue;
            }
            let total = match structure.layers.as_slice() {
                // Bricks: as stiff as so many lengths of the skins.
                [below, _, above] => structure.skins.0.re * width * (below + above) / length,
                _ => {
                    let inertia = across * structure.thickness().powi(3) / 12.0;
                    let rotation = storage * inertia / along;
                    if dof.direction == Direction::Z { SHIFT * rotation / (along * along) } else { rotation }
                }
            };
            springs.push((row, stiff * total / nodes));
        }
    }
    springs
}
