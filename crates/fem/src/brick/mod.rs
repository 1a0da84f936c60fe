//! Three-dimensional elasticity: a box of eight-node hexahedra, in layers of several materials.

mod hexahedron;

pub use hexahedron::{Formulation, hexahedron};

use crate::assembly::{Assembled, Group, assemble};
use crate::error::positive;
use crate::grid::{CORNERS, Grid};
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

/// A face of a [`Brick`], in the order of the ends of a grid.
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
        let grid = Grid::new([nx, ny, nz])?;
        let (length, width) = (positive("length", self.length)?, positive("width", self.width)?);
        let [dx, dy] = [length / nx as f64, width / ny as f64];
        let (mut groups, mut heights) = (Vec::with_capacity(self.layers.len()), vec![0.0]);
        for layer in &self.layers {
            let dz = self.step(layer)?;
            let corners = CORNERS.map(|[i, j, k]| [i as f64 * dx, j as f64 * dy, k as f64 * dz]);
            let (below, bottom) = (heights.len() - 1, heights[heights.len() - 1]);
            heights.extend((1..=layer.elements).map(|k| bottom + k as f64 * dz));
            groups.push(Group {
                element: hexahedron(&corners, layer.poisson, self.formulation)?,
                nodes: grid.corners::<8>(below..below + layer.elements),
                material: layer.material,
            });
        }
        let held = |node, _: Direction| {
            let ends = grid.ends(node);
            self.clamped.iter().any(|&face| ends[face as usize])
        };
        let position = |[i, j, k]: [usize; 3]| [i as f64 * dx, j as f64 * dy, heights[k]];
        let positions = (0..grid.nodes()).map(|node| position(grid.place(node))).collect();
        assemble(positions, &[Direction::X, Direction::Y, Direction::Z], held, &groups, self.mass)
    }

    /// Height of the elements of a layer, once the layer is found to be one of this box.
    fn step(&self, layer: &Layer) -> Result<f64, Error> {
        Grid::new([layer.elements])?;
        if layer.material >= self.layers.len() {
            let expected = "a number below that of the layers";
            return Err(Error::OutOfRange { name: "material", expected, found: layer.material as f64 });
        }
        Ok(positive("thickness", layer.thickness)? / layer.elements as f64)
    }
}
