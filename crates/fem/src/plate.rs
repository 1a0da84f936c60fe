//! Bending of a thin rectangular plate: the twelve-dof rectangle of Adini, Clough and Melosh.

use crate::assembly::{Assembled, Group, assemble};
use crate::error::{poisson, positive};
use crate::grid::Grid;
use crate::quadrature::GAUSS_4;
use crate::{Direction, Element, Error, Mass, Support};

/// A uniform Kirchhoff plate over 0 ≤ x ≤ a, 0 ≤ y ≤ b, in equal rectangles.
///
/// Three dofs a node: the deflection w (Z), RX = ∂w/∂y and RY = −∂w/∂x. Nodes are counted along x first.
/// With Young's modulus factored out, the bending stiffness is D/E = h³ / 12(1 − ν²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Sides a and b in m.
    pub sides: [f64; 2],
    /// Thickness h in m.
    pub thickness: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Numbers of elements along x and y.
    pub elements: [usize; 2],
    /// How the edges x = 0, x = a, y = 0 and y = b are held.
    pub edges: [Support; 4],
    /// Which mass matrix; the lumped one has no rotary inertia.
    pub mass: Mass,
}

impl Default for Plate {
    /// 1 m × 1 m, 10 mm thick, ν = 0.3, one element, free all around, consistent mass.
    fn default() -> Self {
        Self {
            sides: [1.0; 2],
            thickness: 0.01,
            poisson: 0.3,
            elements: [1; 2],
            edges: [Support::Free; 4],
            mass: Mass::Consistent,
        }
    }
}

impl Plate {
    /// Stiffness and mass of the plate: one material.
    ///
    /// Natural frequencies converge like h²; not from above, for the slope across an edge is not continuous.
    ///
    /// # Errors
    /// Where a dimension is not positive, Poisson's ratio outside (−1, 1/2), there is no element, or
    /// nothing moves.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        let grid = Grid::new(self.elements)?;
        let [a, b] = [positive("side", self.sides[0])?, positive("side", self.sides[1])?];
        let [dx, dy] = [a / self.elements[0] as f64, b / self.elements[1] as f64];
        let element = element([dx, dy], positive("thickness", self.thickness)?, poisson(self.poisson)?);
        let held = |node, direction| {
            let ends = grid.ends(node);
            (0..4).any(|edge| ends[edge] && holds(self.edges[edge], edge, direction))
        };
        let position = |[i, j, _]: [usize; 3]| [i as f64 * dx, j as f64 * dy, 0.0];
        let positions = (0..grid.nodes()).map(|node| position(grid.place(node))).collect();
        let group = Group { element, nodes: grid.corners::<4>(0..1), material: 0 };
        assemble(positions, &[Direction::Z, Direction::RX, Direction::RY], held, &[group], self.mass)
    }
}

/// A simply supported edge holds the deflection and with it the slope along the edge, not that across it.
fn holds(support: Support, edge: usize, direction: Direction) -> bool {
    let slope_across = if edge < 2 { Direction::RY } else { Direction::RX };
    match support {
        Support::Free => false,
        Support::Pinned => direction != slope_across,
        Support::Clamped => true,
    }
}

/// The element of these sides (m), thickness h (m) and Poisson's ratio; dofs (w, RX, RY) at the corners
/// (0,0), (a,0), (a,b), (0,b).
///
/// K = ∫ Bᵀ 𝐃 B dA with B = (∂²/∂x², ∂²/∂y², 2 ∂²/∂x∂y) N, M = h ∫ Nᵀ N dA, lumped mass h·ab/4 on each w.
///
/// # Source
/// Melosh, AIAA J. 1 (1963) 1631–1637; Zienkiewicz & Cheung, Proc. ICE 28 (1964) 471–488.
pub fn element(sides: [f64; 2], thickness: f64, poisson: f64) -> Element<12> {
    let half = sides.map(|side| side / 2.0);
    let area = half[0] * half[1];
    let rigidity = thickness.powi(3) / (12.0 * (1.0 - poisson * poisson));
    let mut element = Element { stiffness: [[0.0; 12]; 12], mass: [[0.0; 12]; 12], lumped: [0.0; 12] };
    for (xi, x_weight) in GAUSS_4 {
        for (eta, y_weight) in GAUSS_4 {
            let shape = shape_functions([xi, eta], half);
            let weight = x_weight * y_weight * area;
            for (i, [n, xx, yy, xy]) in shape.into_iter().enumerate() {
                // Moments per unit rigidity.
                let (mx, my, mxy) = (xx + poisson * yy, yy + poisson * xx, 2.0 * (1.0 - poisson) * xy);
                for (j, [n_j, xx_j, yy_j, xy_j]) in shape.into_iter().enumerate() {
                    element.stiffness[i][j] += weight * rigidity * (mx * xx_j + my * yy_j + mxy * xy_j);
                    element.mass[i][j] += weight * thickness * n * n_j;
                }
            }
        }
    }
    (0..4).for_each(|corner| element.lumped[3 * corner] = thickness * area);
    element
}

/// (N, N,xx, N,yy, N,xy) of the twelve shape functions at (ξ, η), for half sides (m).
///
/// At corner i, with s = ξᵢ and t = ηᵢ:
/// w: (1+sξ)(1+tη)(2+sξ+tη−ξ²−η²)/8 · RX = w,y: b(1+sξ)(t+η)(η²−1)/8 · RY = −w,x: −a(s+ξ)(ξ²−1)(1+tη)/8.
fn shape_functions([xi, eta]: [f64; 2], [a, b]: [f64; 2]) -> [[f64; 4]; 12] {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let per_corner = corners.map(|(s, t)| {
        let (p, q) = (1.0 + s * xi, 1.0 + t * eta);
        let deflection = [
            p * q * (2.0 + s * xi + t * eta - xi * xi - eta * eta),
            -6.0 * s * xi * q,
            -6.0 * t * eta * p,
            s * t * (4.0 - 3.0 * xi * xi - 3.0 * eta * eta),
        ];
        let about_x = [
            b * p * (t + eta) * (eta * eta - 1.0),
            0.0,
            b * p * (6.0 * eta + 2.0 * t),
            b * s * (3.0 * eta * eta + 2.0 * t * eta - 1.0),
        ];
        let about_y = [
            -a * q * (s + xi) * (xi * xi - 1.0),
            -a * q * (6.0 * xi + 2.0 * s),
            0.0,
            -a * t * (3.0 * xi * xi + 2.0 * s * xi - 1.0),
        ];
        [deflection, about_x, about_y]
    });
    std::array::from_fn(|i| {
        let [n, xx, yy, xy] = per_corner[i / 3][i % 3].map(|value| value / 8.0);
        [n, xx / (a * a), yy / (b * b), xy / (a * b)]
    })
}
