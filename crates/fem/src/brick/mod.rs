//! Three-dimensional elasticity: a box of eight-node hexahedra, in layers of several materials.

mod hexahedron;

pub use hexahedron::{Formulation, hexahedron};

use crate::assembly::{Assembled, Group, assemble};
use crate::error::{nodes_of_grid, poisson, positive};
use crate::{Direction, Error, Mass};

/// A box over 0 ≤ x ≤ length, 0 ≤ y ≤ width, layer upon layer from z = 0, in equal elements within a layer.
///
/// Three dofs a node: X, Y, Z. Nodes are counted along x first, then y, then z. Each material has its own
/// stiffness and mass matrix, so that a sandwich is E_skins K_skins + E_core K_core.
#[derive(Debug, Clone, PartialEq)]
pub struct Brick {
    /// Length along x in m.
    pub length: f64,
    /// Width along y in m.
    pub width: f64,
    /// Numbers of elements along x and y.
    pub elements: [usize; 2],
    /// Layers from z = 0 upwards.
    pub layers: Vec<Layer>,
    /// Faces whose nodes are held in all directions.
    pub clamped: Vec<Face>,
    /// How an element deforms.
    pub formulation: Formulation,
    /// Which mass matrix.
    pub mass: Mass,
}

/// One layer of a [`Brick`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Thickness along z in m.
    pub thickness: f64,
    /// Number of elements through the thickness.
    pub elements: usize,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Which material, from 0; below the number of layers. Layers may share one.
    pub material: usize,
}

/// A face of a [`Brick`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// x = 0.
    XMin,
    /// x = length.
    XMax,
    /// y = 0.
    YMin,
    /// y = width.
    YMax,
    /// z = 0.
    ZMin,
    /// z = the sum of all thicknesses.
    ZMax,
}

impl Default for Layer {
    /// 1 m thick, one element, ν = 0.3, material 0.
    fn default() -> Self {
        Self { thickness: 1.0, elements: 1, poisson: 0.3, material: 0 }
    }
}

impl Default for Brick {
    /// A free cube of 1 m, one element of one material, with incompatible modes and consistent mass.
    fn default() -> Self {
        Self {
            length: 1.0,
            width: 1.0,
            elements: [1; 2],
            layers: vec![Layer::default()],
            clamped: Vec::new(),
            formulation: Formulation::Incompatible,
            mass: Mass::Consistent,
        }
    }
}

impl Brick {
    /// Stiffness and mass of each material, up to the largest number that a layer names; the matrices of a
    /// number that no layer names are zero.
    ///
    /// # Errors
    /// Where a dimension is not positive, Poisson's ratio outside (−1, 1/2), a layer without elements, a
    /// material not below the number of layers, or nothing moves.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        let [nx, ny] = self.elements;
        let nz = self.layers.iter().fold(0_usize, |sum, layer| sum.saturating_add(layer.elements));
        let nodes = nodes_of_grid(&[nx, ny, nz])?;
        let heights = self.heights()?;
        let at = |node: usize| {
            let plane = (nx + 1) * (ny + 1);
            [node % (nx + 1), node % plane / (nx + 1), node / plane]
        };
        let (dx, dy) =
            (positive("length", self.length)? / nx as f64, positive("width", self.width)? / ny as f64);
        let positions =
            (0..nodes).map(at).map(|[i, j, k]| [i as f64 * dx, j as f64 * dy, heights[k]]).collect();
        let held = |node, _: Direction| {
            let [i, j, k] = at(node);
            self.clamped.iter().any(|face| match face {
                Face::XMin => i == 0,
                Face::XMax => i == nx,
                Face::YMin => j == 0,
                Face::YMax => j == ny,
                Face::ZMin => k == 0,
                Face::ZMax => k == nz,
            })
        };
        let directions = [Direction::X, Direction::Y, Direction::Z];
        assemble(positions, &directions, held, &self.groups([dx, dy])?, self.mass)
    }

    /// z of each plane of nodes.
    fn heights(&self) -> Result<Vec<f64>, Error> {
        let (mut heights, mut bottom) = (vec![0.0], 0.0);
        for layer in &self.layers {
            let step = positive("thickness", layer.thickness)? / layer.elements as f64;
            heights.extend((1..=layer.elements).map(|k| bottom + k as f64 * step));
            bottom += layer.thickness;
        }
        Ok(heights)
    }

    /// One group a layer: its elements are equal.
    fn groups(&self, [dx, dy]: [f64; 2]) -> Result<Vec<Group<8, 24>>, Error> {
        let [nx, ny] = self.elements;
        let (line, plane) = (nx + 1, (nx + 1) * (ny + 1));
        let mut first = 0;
        let mut groups = Vec::with_capacity(self.layers.len());
        for layer in &self.layers {
            nodes_of_grid(&[layer.elements])?;
            if layer.material >= self.layers.len() {
                let expected = "a number below that of the layers";
                return Err(Error::OutOfRange { name: "material", expected, found: layer.material as f64 });
            }
            let corners = CORNERS.map(|[x, y, z]| {
                let step = layer.thickness / layer.elements as f64;
                [(x + 1.0) / 2.0 * dx, (y + 1.0) / 2.0 * dy, (z + 1.0) / 2.0 * step]
            });
            let planes = first..first + layer.elements;
            let lowest = planes
                .flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| i + line * j + plane * k)));
            groups.push(Group {
                element: hexahedron(&corners, poisson(layer.poisson)?, self.formulation)?,
                nodes: lowest
                    .map(|n| {
                        let bottom = [n, n + 1, n + 1 + line, n + line];
                        std::array::from_fn(|corner| bottom[corner % 4] + corner / 4 * plane)
                    })
                    .collect(),
                material: layer.material,
            });
            first += layer.elements;
        }
        Ok(groups)
    }
}

/// Natural coordinates of the corners: the bottom face counterclockwise seen from above, then the top face.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
