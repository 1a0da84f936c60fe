//! Bending of a thin orthotropic plate: the sixteen-dof rectangle of Bogner, Fox and Schmit.

use crate::assembly::{Assembled, Group, assemble};
use crate::error::positive;
use crate::grid::{CORNERS, Grid};
use crate::quadrature::GAUSS_4;
use crate::{Direction, Element, Error, Mass, Support};

/// A Kirchhoff plate on a rectangular grid, whose material has its axes along x and y.
///
/// Four dofs a node: the deflection w (Z), RX = ∂w/∂y, RY = −∂w/∂x, and the twist ∂²w/∂x∂y. Nodes are counted along x first.
///
/// With the reduced stiffnesses of plane stress in Pa,
///
/// D₁₁ = E₁/(1 − ν₁₂ν₂₁), D₂₂ = E₂/(1 − ν₁₂ν₂₁), D₁₂ = ν₁₂ D₂₂ = ν₂₁ D₁₁, D₆₆ = G₁₂,
///
/// and the thickness h, the strain energy is
///
/// U = ½ h³/12 ∫ ( D₁₁ w,xx² + D₂₂ w,yy² + 2 D₁₂ w,xx w,yy + 4 D₆₆ w,xy² ) dA.
///
/// It is linear in the four constants: each has a stiffness matrix of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct OrthotropicPlate {
    /// Positions in m of the grid lines along x and along y, ascending.
    pub lines: [Vec<f64>; 2],
    /// Thickness h in m.
    pub thickness: f64,
    /// How the edges at the first and the last x, at the first and the last y are held.
    pub edges: [Support; 4],
    /// Which mass matrix; the lumped one has no rotary inertia.
    pub mass: Mass,
}

impl Default for OrthotropicPlate {
    /// 1 m × 1 m, 10 mm thick, one element, free all around, consistent mass.
    fn default() -> Self {
        Self {
            lines: [vec![0.0, 1.0], vec![0.0, 1.0]],
            thickness: 0.01,
            edges: [Support::Free; 4],
            mass: Mass::Consistent,
        }
    }
}

impl OrthotropicPlate {
    /// Stiffness matrices for D₁₁ = 1, D₂₂ = 1, D₁₂ = 1 and D₆₆ = 1 Pa, in this order, and one mass matrix for ρ = 1.
    ///
    /// Natural frequencies with the consistent mass converge like h⁴, from above: deflections and slopes are continuous.
    ///
    /// # Errors
    /// Where the thickness or a step between lines is not positive, there is no element, or nothing moves.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        let [along_x, along_y] = &self.lines;
        let grid = Grid::new([along_x, along_y].map(|lines| lines.len().saturating_sub(1)))?;
        let thickness = positive("thickness", self.thickness)?;
        let steps = |lines: &[f64]| {
            let step = |pair: &[f64]| positive("step between grid lines", pair[1] - pair[0]);
            lines.windows(2).map(step).collect::<Result<Vec<f64>, Error>>()
        };
        let (dx, dy) = (steps(along_x)?, steps(along_y)?);
        let mut groups = Vec::with_capacity(4 * dx.len() * dy.len());
        for (cell, corners) in grid.corners::<4>(0..1).into_iter().enumerate() {
            let elements = elements([dx[cell % dx.len()], dy[cell / dx.len()]], thickness);
            for (material, element) in elements.into_iter().enumerate() {
                groups.push(Group { element, nodes: vec![corners], material });
            }
        }
        let held = |node, direction| {
            let ends = grid.ends(node);
            (0..4).any(|edge| ends[edge] && holds(self.edges[edge], edge, direction))
        };
        let position = |[i, j, _]: [usize; 3]| [along_x[i], along_y[j], 0.0];
        let positions = (0..grid.nodes()).map(|node| position(grid.place(node))).collect();
        let directions = [Direction::Z, Direction::RX, Direction::RY, Direction::Twist];
        let mut assembled = assemble(positions, &directions, held, &groups, self.mass)?;
        // The four constants are of one material, with one density.
        assembled.mass.truncate(1);
        Ok(assembled)
    }
}

/// Grid lines of a side (m): 0, the inset, so many equal steps, the inset before the end, the end; where a plate is struck and measured near its corners there is a node.
pub fn inset_lines(side: f64, inset: f64, inner: usize) -> Vec<f64> {
    let inner_line = |k: usize| inset + (side - 2.0 * inset) * k as f64 / inner as f64;
    std::iter::once(0.0).chain((0..=inner).map(inner_line)).chain([side]).collect()
}

/// A simply supported edge holds the deflection and with it the slope along the edge. The slope across it is free, and so is its
/// change along the edge, the twist.
fn holds(support: Support, edge: usize, direction: Direction) -> bool {
    let slope_along = if edge < 2 { Direction::RX } else { Direction::RY };
    match support {
        Support::Free => false,
        Support::Pinned => direction == Direction::Z || direction == slope_along,
        Support::Clamped => true,
    }
}

/// The elements of these sides (m) and thickness h (m) for D₁₁, D₂₂, D₁₂ and D₆₆ of 1 Pa, all with the mass for ρ = 1; dofs (w, RX, RY, twist) at
/// the corners (0,0), (a,0), (a,b), (0,b).
///
/// K₁₁ = h³/12 ∫ N,xx N,xxᵀ dA, K₂₂ = h³/12 ∫ N,yy N,yyᵀ dA, K₁₂ = h³/12 ∫ ( N,xx N,yyᵀ + N,yy N,xxᵀ ) dA, K₆₆ = h³/3 ∫ N,xy N,xyᵀ dA,
/// M = h ∫ N Nᵀ dA, lumped mass h·ab/4 on each w. The shape functions N are products of cubic Hermite functions of x and of y.
///
/// # Source
/// F. K. Bogner, R. L. Fox, L. A. Schmit, The generation of inter-element-compatible stiffness and mass matrices by the use of interpolation formulas,
/// Proc. Conf. Matrix Methods in Structural Mechanics, AFFDL-TR-66-80, Wright-Patterson AFB 1965, 397–443.
pub fn elements(sides: [f64; 2], thickness: f64) -> [Element<16>; 4] {
    let area = sides[0] * sides[1];
    let bending = thickness.powi(3) / 12.0;
    let (mut stiffness, mut mass) = ([[[0.0; 16]; 16]; 4], [[0.0; 16]; 16]);
    for (xi, x_weight) in GAUSS_4 {
        for (eta, y_weight) in GAUSS_4 {
            let shape = shape_functions([xi, eta].map(|at| 0.5 * (1.0 + at)), sides);
            // The weights of (−1, 1) add up to two.
            let weight = 0.25 * x_weight * y_weight * area;
            let (bent, moved) = (weight * bending, weight * thickness);
            for (i, [n, xx, yy, xy]) in shape.into_iter().enumerate() {
                for (j, [n_j, xx_j, yy_j, xy_j]) in shape.into_iter().enumerate() {
                    stiffness[0][i][j] += bent * xx * xx_j;
                    stiffness[1][i][j] += bent * yy * yy_j;
                    stiffness[2][i][j] += bent * (xx * yy_j + yy * xx_j);
                    stiffness[3][i][j] += bent * 4.0 * xy * xy_j;
                    mass[i][j] += moved * n * n_j;
                }
            }
        }
    }
    let mut lumped = [0.0; 16];
    (0..4).for_each(|corner| lumped[4 * corner] = 0.25 * thickness * area);
    stiffness.map(|stiffness| Element { stiffness, mass, lumped })
}

/// (N, N,xx, N,yy, N,xy) of the sixteen shape functions at (ξ, η) in (0, 1), for sides (m).
fn shape_functions([xi, eta]: [f64; 2], [a, b]: [f64; 2]) -> [[f64; 4]; 16] {
    let (along_x, along_y) = (hermite(xi, a), hermite(eta, b));
    std::array::from_fn(|i| {
        let [x_end, y_end, _] = CORNERS[i / 4];
        // Of w, RX = w,y, RY = −w,x and w,xy: whether the function of x, that of y is one of slopes, and the sign.
        let (x_slope, y_slope, sign) = [(0, 0, 1.0), (0, 1, 1.0), (1, 0, -1.0), (1, 1, 1.0)][i % 4];
        let ([x0, x1, x2], [y0, y1, y2]) = (along_x[2 * x_end + x_slope], along_y[2 * y_end + y_slope]);
        [x0 * y0, x2 * y0, x0 * y2, x1 * y1].map(|value| sign * value)
    })
}

/// Value, first and second derivative at s in (0, 1) of the cubic functions on a length l that have the value 1 at 0, the slope 1 at 0, the value 1 at l, the
/// slope 1 at l, and none of the other three.
fn hermite(s: f64, l: f64) -> [[f64; 3]; 4] {
    let (s2, s3) = (s * s, s * s * s);
    let value = [1.0 - 3.0 * s2 + 2.0 * s3, 6.0 * (s2 - s) / l, (12.0 * s - 6.0) / (l * l)];
    let slope = [l * (s - 2.0 * s2 + s3), 1.0 - 4.0 * s + 3.0 * s2, (6.0 * s - 4.0) / l];
    let far_value = [3.0 * s2 - 2.0 * s3, 6.0 * (s - s2) / l, (6.0 - 12.0 * s) / (l * l)];
    let far_slope = [l * (s3 - s2), 3.0 * s2 - 2.0 * s, (6.0 * s - 2.0) / l];
    [value, slope, far_value, far_slope]
}
