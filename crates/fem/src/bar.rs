//! Longitudinal vibration of a uniform bar: two nodes, linear displacement.

use crate::assembly::{Assembled, Group, assemble};
use crate::error::positive;
use crate::grid::Grid;
use crate::{Direction, Element, Error, Mass, Support};

/// A uniform bar along x from 0 to its length, in equal elements; one dof a node, X.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Length in m.
    pub length: f64,
    /// Area of the cross-section in m².
    pub area: f64,
    /// Number of elements.
    pub elements: usize,
    /// How the ends at 0 and at the length are held; pinned is as good as clamped.
    pub ends: [Support; 2],
    /// Which mass matrix.
    pub mass: Mass,
}

impl Default for Bar {
    /// 1 m long, 1 m² thick, one element, free at both ends, consistent mass.
    fn default() -> Self {
        Self { length: 1.0, area: 1.0, elements: 1, ends: [Support::Free; 2], mass: Mass::Consistent }
    }
}

impl Bar {
    /// Stiffness and mass of the bar: one material.
    ///
    /// Receptances and natural frequencies converge like h², natural frequencies with the mean mass like h⁴.
    ///
    /// # Errors
    /// Where a dimension is not positive, there is no element, or nothing moves.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        let grid = Grid::new([self.elements])?;
        let step = positive("length", self.length)? / self.elements as f64;
        let element = element(positive("area", self.area)?, step);
        let held = |node, _: Direction| {
            let ends = grid.ends(node);
            (0..2).any(|end| ends[end] && self.ends[end] != Support::Free)
        };
        let positions = (0..grid.nodes()).map(|i| [i as f64 * step, 0.0, 0.0]).collect();
        let group = Group { element, nodes: grid.corners::<2>(0..1), material: 0 };
        assemble(positions, &[Direction::X], held, &[group], self.mass)
    }
}

/// The element of area A (m²) and length L (m): K = A/L [1 −1; −1 1], M = AL/6 [2 1; 1 2], lumped AL/2.
pub fn element(area: f64, length: f64) -> Element<2> {
    let (k, m) = (area / length, area * length / 6.0);
    Element { stiffness: [[k, -k], [-k, k]], mass: [[2.0 * m, m], [m, 2.0 * m]], lumped: [3.0 * m; 2] }
}
