//! Bending of a uniform beam: two nodes, cubic deflection; Euler and Bernoulli's, or Timoshenko's with shear and rotary inertia.

use crate::assembly::{Assembled, Group, assemble};
use crate::error::positive;
use crate::grid::Grid;
use crate::quadrature::GAUSS_4;
use crate::{Direction, Element, Error, Mass, Support};

/// A uniform beam along x from 0 to its length, bending in the xz plane, in equal elements.
///
/// Two dofs a node: the deflection w (Z) and the rotation RY, −dw/dx where there is no shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Length in m.
    pub length: f64,
    /// Area of the cross-section in m².
    pub area: f64,
    /// Second moment of area about y in m⁴.
    pub inertia: f64,
    /// Number of elements.
    pub elements: usize,
    /// How the ends at 0 and at the length are held.
    pub ends: [Support; 2],
    /// Which mass matrix; the lumped one has no rotary inertia.
    pub mass: Mass,
    /// κG/E, the shear factor of the cross-section times shear over Young's modulus: Timoshenko's beam. `None`: Euler and Bernoulli's.
    pub shear: Option<f64>,
}

impl Default for Beam {
    /// 1 m long, 1 m² thick, 1 m⁴ stiff, one element, free at both ends, consistent mass, no shear.
    fn default() -> Self {
        let ends = [Support::Free; 2];
        Self { length: 1.0, area: 1.0, inertia: 1.0, elements: 1, ends, mass: Mass::Consistent, shear: None }
    }
}

impl Beam {
    /// Stiffness and mass of the beam: one material.
    ///
    /// Natural frequencies with the consistent mass converge like h⁴, from above; with shear like h².
    ///
    /// # Errors
    /// Where a dimension is not positive, there is no element, or nothing moves.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        let grid = Grid::new([self.elements])?;
        let step = positive("length", self.length)? / self.elements as f64;
        let (area, inertia) =
            (positive("area", self.area)?, positive("second moment of area", self.inertia)?);
        let held = |node, direction| {
            let ends = grid.ends(node);
            (0..2).any(|end| ends[end] && holds(self.ends[end], direction))
        };
        let positions = (0..grid.nodes()).map(|i| [i as f64 * step, 0.0, 0.0]).collect();
        let element = match self.shear {
            Some(shear) => shear_element(area, inertia, positive("shear", shear)?, step),
            None => element(area, inertia, step),
        };
        let group = Group { element, nodes: grid.corners::<2>(0..1), material: 0 };
        assemble(positions, &[Direction::Z, Direction::RY], held, &[group], self.mass)
    }
}

fn holds(end: Support, direction: Direction) -> bool {
    match end {
        Support::Free => false,
        Support::Pinned => direction == Direction::Z,
        Support::Clamped => true,
    }
}

/// The element of area A (m²), second moment I (m⁴) and length L (m); dofs (w, RY) at 0, (w, RY) at L.
///
/// Lumped mass: AL/2 on each w.
///
/// # Source
/// Archer, J. Struct. Div. ASCE 89 ST4 (1963) 161–178, with RY = −dw/dx.
pub fn element(area: f64, inertia: f64, length: f64) -> Element<4> {
    let l = length;
    let stiffness = [
        [12.0, -6.0 * l, -12.0, -6.0 * l],
        [-6.0 * l, 4.0 * l * l, 6.0 * l, 2.0 * l * l],
        [-12.0, 6.0 * l, 12.0, 6.0 * l],
        [-6.0 * l, 2.0 * l * l, 6.0 * l, 4.0 * l * l],
    ];
    let mass = [
        [156.0, -22.0 * l, 54.0, 13.0 * l],
        [-22.0 * l, 4.0 * l * l, -13.0 * l, -3.0 * l * l],
        [54.0, -13.0 * l, 156.0, 22.0 * l],
        [13.0 * l, -3.0 * l * l, 22.0 * l, 4.0 * l * l],
    ];
    let (k, m) = (inertia / l.powi(3), area * l / 420.0);
    let half = area * l / 2.0;
    Element {
        stiffness: stiffness.map(|row| row.map(|entry| k * entry)),
        mass: mass.map(|row| row.map(|entry| m * entry)),
        lumped: [half, 0.0, half, 0.0],
    }
}

/// The element of Timoshenko's beam, with κG/E besides: deflection w and rotation θ are those of a beam that is loaded at its ends alone.
///
/// With Φ = 12 I/(κ(G/E) A L²) there is no shear locking, and Φ = 0 leaves the stiffness of [`element`]. The mass is ∫ A w² + I θ² dx: it has rotary inertia.
///
/// # Source
/// Z. Friedman, J. B. Kosmatka, An improved two-node Timoshenko beam finite element, Comput. Struct. 47 (1993) 473–481, with RY = −θ.
pub fn shear_element(area: f64, inertia: f64, shear: f64, length: f64) -> Element<4> {
    let l = length;
    let phi = 12.0 * inertia / (shear * area * l * l);
    let k = inertia / (l.powi(3) * (1.0 + phi));
    let (same, other) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
    let stiffness = [
        [12.0, -6.0 * l, -12.0, -6.0 * l],
        [-6.0 * l, same, 6.0 * l, other],
        [-12.0, 6.0 * l, 12.0, 6.0 * l],
        [-6.0 * l, other, 6.0 * l, same],
    ];
    let mut mass = [[0.0; 4]; 4];
    for (point, weight) in GAUSS_4 {
        let s = 0.5 * (point + 1.0);
        let (s2, s3) = (s * s, s * s * s);
        let deflection = [
            1.0 - 3.0 * s2 + 2.0 * s3 + phi * (1.0 - s),
            -l * (s - 2.0 * s2 + s3 + 0.5 * phi * (s - s2)),
            3.0 * s2 - 2.0 * s3 + phi * s,
            -l * (s3 - s2 + 0.5 * phi * (s2 - s)),
        ];
        let rotation = [
            -6.0 / l * (s2 - s),
            1.0 - 4.0 * s + 3.0 * s2 + phi * (1.0 - s),
            -6.0 / l * (s - s2),
            3.0 * s2 - 2.0 * s + phi * s,
        ];
        let by = 0.5 * l * weight / (1.0 + phi).powi(2);
        for (i, row) in mass.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += by * (area * deflection[i] * deflection[j] + inertia * rotation[i] * rotation[j]);
            }
        }
    }
    let half = area * l / 2.0;
    Element {
        stiffness: stiffness.map(|row| row.map(|entry| k * entry)),
        mass,
        lumped: [half, 0.0, half, 0.0],
    }
}
