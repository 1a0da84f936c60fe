//! Bending of an orthotropic plate, without and with transverse shear: rectangles whose deflection is that of Bogner, Fox and Schmit.

use crate::assembly::{Assembled, Group, assemble};
use crate::error::positive;
use crate::grid::{CORNERS, Grid};
use crate::quadrature::GAUSS_4;
use crate::{Direction, Element, Error, Mass, Support};

/// A plate on a rectangular grid, whose material has its axes along x and y.
///
/// With the reduced stiffnesses of plane stress in Pa,
///
/// D₁₁ = E₁/(1 − ν₁₂ν₂₁), D₂₂ = E₂/(1 − ν₁₂ν₂₁), D₁₂ = ν₁₂ D₂₂ = ν₂₁ D₁₁, D₆₆ = G₁₂,
///
/// the thickness h and rotations θ₁ (along x) and θ₂ (along y) of the cross-sections, the strain energy is
///
/// U = ½ h³/12 ∫ ( D₁₁ θ₁,x² + D₂₂ θ₂,y² + 2 D₁₂ θ₁,x θ₂,y + D₆₆ (θ₁,y + θ₂,x)² ) dA + ½ κh ∫ ( G₁₃ γ₁² + G₂₃ γ₂² ) dA.
///
/// It is linear in the constants: each has a stiffness matrix of its own.
///
/// - A thin plate (Kirchhoff) has no transverse shear, γ = 0: θ₁ = −w,x and θ₂ = −w,y with the deflection w. Four dofs a node: w (Z), RX = ∂w/∂y, RY = −∂w/∂x,
///   and the twist ∂²w/∂x∂y. No rotary inertia.
/// - A thick one (Reissner, Mindlin) has γ₁ = w,x + θ₁ and γ₂ = w,y + θ₂ as dofs five and six ([`Direction::ShearX`], [`Direction::ShearY`]), and κ = 5/6. RX = −θ₂ and RY = θ₁ are
///   rotations of the cross-section. Since the shear strains are unknowns of their own, none of them locks.
///
/// Nodes are counted along x first.
///
/// # Source
/// R. D. Mindlin, J. Appl. Mech. 18 (1951) 31–38; shear strains as unknowns: B. Oesterle, E. Ramm, M. Bischoff, Comput. Methods Appl. Mech. Eng. 307 (2016) 235–255.
#[derive(Debug, Clone, PartialEq)]
pub struct OrthotropicPlate {
    /// Positions in m of the grid lines along x and along y, ascending.
    pub lines: [Vec<f64>; 2],
    /// Thickness h in m.
    pub thickness: f64,
    /// Whether it has transverse shear and rotary inertia.
    pub thick: bool,
    /// How the edges at the first and the last x, at the first and the last y are held.
    pub edges: [Support; 4],
    /// Which mass matrix; the lumped one has no rotary inertia.
    pub mass: Mass,
}

impl Default for OrthotropicPlate {
    /// 1 m × 1 m, 10 mm thick, without transverse shear, one element, free all around, consistent mass.
    fn default() -> Self {
        Self {
            lines: [vec![0.0, 1.0], vec![0.0, 1.0]],
            thickness: 0.01,
            thick: false,
            edges: [Support::Free; 4],
            mass: Mass::Consistent,
        }
    }
}

impl OrthotropicPlate {
    /// Stiffness matrices for D₁₁ = 1, D₂₂ = 1, D₁₂ = 1 and D₆₆ = 1 Pa, of a thick plate for G₁₃ = 1 and G₂₃ = 1 Pa too, in this order, and one mass matrix for ρ = 1.
    ///
    /// Natural frequencies with the consistent mass converge from above: deflections, slopes and shear strains are continuous. Those of a thin plate converge like (element size)⁴, the small share of
    /// the shear of a thick one at least like its square.
    ///
    /// # Errors
    /// Where the thickness or a step between lines is not positive, there is no element, or nothing moves.
    ///
    /// # Limits
    /// At a clamped edge of a thick plate the cross-section does not turn at the nodes; between them only the mesh makes it so.
    pub fn assemble(&self) -> Result<Assembled, Error> {
        if self.thick {
            let directions = [
                Direction::Z,
                Direction::RX,
                Direction::RY,
                Direction::Twist,
                Direction::ShearX,
                Direction::ShearY,
            ];
            self.assemble_of(&directions, thick_elements)
        } else {
            self.assemble_of(&[Direction::Z, Direction::RX, Direction::RY, Direction::Twist], thin_elements)
        }
    }

    /// All constants of the plate from those of one element by its sides and thickness.
    fn assemble_of<const N: usize, const CONSTANTS: usize>(
        &self,
        directions: &[Direction],
        elements: impl Fn([f64; 2], f64) -> [Element<N>; CONSTANTS],
    ) -> Result<Assembled, Error> {
        let [along_x, along_y] = &self.lines;
        let grid = Grid::new([along_x, along_y].map(|lines| lines.len().saturating_sub(1)))?;
        let thickness = positive("thickness", self.thickness)?;
        let steps = |lines: &[f64]| {
            let step = |pair: &[f64]| positive("step between grid lines", pair[1] - pair[0]);
            lines.windows(2).map(step).collect::<Result<Vec<f64>, Error>>()
        };
        let (dx, dy) = (steps(along_x)?, steps(along_y)?);
        let mut groups = Vec::with_capacity(CONSTANTS * dx.len() * dy.len());
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
        let mut assembled = assemble(positions, directions, held, &groups, self.mass)?;
        // The constants are of one material, with one density.
        assembled.mass.truncate(1);
        Ok(assembled)
    }
}

/// Grid lines of a side (m): 0, the inset, so many equal steps, the inset before the end, the end; where a plate is struck and measured near its corners there is a node.
pub fn inset_lines(side: f64, inset: f64, inner: usize) -> Vec<f64> {
    let inner_line = |k: usize| inset + (side - 2.0 * inset) * k as f64 / inner as f64;
    std::iter::once(0.0).chain((0..=inner).map(inner_line)).chain([side]).collect()
}

/// A simply supported edge holds the deflection, and rotation and shear along the edge. The rotation across it is free, and so is its
/// change along the edge, the twist. The shear is free where the cross-section is held.
fn holds(support: Support, edge: usize, direction: Direction) -> bool {
    let along =
        if edge < 2 { [Direction::RX, Direction::ShearY] } else { [Direction::RY, Direction::ShearX] };
    match support {
        Support::Free => false,
        Support::Pinned => direction == Direction::Z || along.contains(&direction),
        Support::Clamped => !matches!(direction, Direction::ShearX | Direction::ShearY),
    }
}

/// Shear correction factor κ of a homogeneous cross-section.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// The fields of one shape function at a point.
#[derive(Debug, Clone, Copy, Default)]
struct Fields {
    /// w.
    deflection: f64,
    /// θ₁ and θ₂ of a thick plate, whose rotary inertia counts.
    rotation: [f64; 2],
    /// θ₁,x, θ₂,y and θ₁,y + θ₂,x.
    curvature: [f64; 3],
    /// γ₁ and γ₂.
    shear: [f64; 2],
}

/// The elements of a thin plate of these sides (m) and thickness h (m) for D₁₁, D₂₂, D₁₂ and D₆₆ of 1 Pa, all with the mass for ρ = 1; dofs (w, RX, RY, twist) at
/// the corners (0,0), (a,0), (a,b), (0,b).
///
/// With θ,x for θ₁,x of the shape functions N and so on: K₁₁ = h³/12 ∫ θ,x θ,xᵀ dA, K₂₂ = h³/12 ∫ θ,y θ,yᵀ dA, K₁₂ = h³/12 ∫ ( θ,x θ,yᵀ + θ,y θ,xᵀ ) dA,
/// K₆₆ = h³/12 ∫ (θ₁,y + θ₂,x)(θ₁,y + θ₂,x)ᵀ dA, M = h ∫ N Nᵀ dA, lumped mass h·ab/4 on each w. The shape functions are products of cubic Hermite functions of x and of y.
///
/// # Source
/// F. K. Bogner, R. L. Fox, L. A. Schmit, The generation of inter-element-compatible stiffness and mass matrices by the use of interpolation formulas,
/// Proc. Conf. Matrix Methods in Structural Mechanics, AFFDL-TR-66-80, Wright-Patterson AFB 1965, 397–443.
pub fn thin_elements(sides: [f64; 2], thickness: f64) -> [Element<16>; 4] {
    elements(sides, thickness, thin_fields)
}

/// The elements of a thick plate as [`thin_elements`], with dofs (w, RX, RY, twist, γ₁, γ₂) at each corner: K₁₁ to K₆₆, K₅₅ = κh ∫ γ₁ γ₁ᵀ dA for G₁₃ and K₄₄ = κh ∫ γ₂ γ₂ᵀ dA for
/// G₂₃, M = h ∫ N Nᵀ dA + h³/12 ∫ ( θ₁ θ₁ᵀ + θ₂ θ₂ᵀ ) dA. The shear strains are bilinear.
pub fn thick_elements(sides: [f64; 2], thickness: f64) -> [Element<24>; 6] {
    elements(sides, thickness, thick_fields)
}

/// The matrices of the first constants in the order D₁₁, D₂₂, D₁₂, D₆₆, G₁₃, G₂₃, from the fields of the shape functions at (ξ, η) in (0, 1).
fn elements<const N: usize, const CONSTANTS: usize>(
    sides: [f64; 2],
    thickness: f64,
    fields: impl Fn([f64; 2], [f64; 2]) -> [Fields; N],
) -> [Element<N>; CONSTANTS] {
    let area = sides[0] * sides[1];
    let bending = thickness.powi(3) / 12.0;
    let (mut stiffness, mut mass) = ([[[0.0; N]; N]; CONSTANTS], [[0.0; N]; N]);
    for (xi, x_weight) in GAUSS_4 {
        for (eta, y_weight) in GAUSS_4 {
            let fields = fields([xi, eta].map(|at| 0.5 * (1.0 + at)), sides);
            // The weights of (−1, 1) add up to two.
            let weight = 0.25 * x_weight * y_weight * area;
            let (bent, moved) = (weight * bending, weight * thickness);
            let sheared = SHEAR_CORRECTION * moved;
            for (i, of_i) in fields.iter().enumerate() {
                let ([xx, yy, xy], [g1, g2], [t1, t2]) = (of_i.curvature, of_i.shear, of_i.rotation);
                for (j, of_j) in fields.iter().enumerate() {
                    let ([xx_j, yy_j, xy_j], [g1_j, g2_j]) = (of_j.curvature, of_j.shear);
                    let constants = [
                        bent * xx * xx_j,
                        bent * yy * yy_j,
                        bent * (xx * yy_j + yy * xx_j),
                        bent * xy * xy_j,
                        sheared * g1 * g1_j,
                        sheared * g2 * g2_j,
                    ];
                    for (matrix, constant) in stiffness.iter_mut().zip(constants) {
                        matrix[i][j] += constant;
                    }
                    let turned = t1 * of_j.rotation[0] + t2 * of_j.rotation[1];
                    mass[i][j] += moved * of_i.deflection * of_j.deflection + bent * turned;
                }
            }
        }
    }
    let mut lumped = [0.0; N];
    (0..4).for_each(|corner| lumped[N / 4 * corner] = 0.25 * thickness * area);
    stiffness.map(|stiffness| Element { stiffness, mass, lumped })
}

fn thin_fields(at: [f64; 2], sides: [f64; 2]) -> [Fields; 16] {
    let deflections = deflections(at, sides);
    std::array::from_fn(|i| {
        let Deflection { w, xx, yy, xy, .. } = deflections[i];
        Fields { deflection: w, curvature: [-xx, -yy, -2.0 * xy], ..Fields::default() }
    })
}

/// Of w, RX, RY and the twist θ = −∇w. Of γ₁ the deflection that has the slope w,x = γ₁ at the node too, so that the rotation RY there does not change; of γ₂ alike.
fn thick_fields(at: [f64; 2], sides: [f64; 2]) -> [Fields; 24] {
    let deflections = deflections(at, sides);
    std::array::from_fn(|i| {
        let (corner, dof) = (i / 6, i % 6);
        let [n, n_x, n_y] = bilinear(at, sides, corner);
        let (shape, sign, shear) = match dof {
            4 => (2, -1.0, [1.0, 0.0]),
            5 => (1, 1.0, [0.0, 1.0]),
            _ => (dof, 1.0, [0.0; 2]),
        };
        let Deflection { w, x, y, xx, yy, xy } = deflections[4 * corner + shape];
        let [g1, g2] = shear;
        Fields {
            deflection: sign * w,
            rotation: [n * g1 - sign * x, n * g2 - sign * y],
            curvature: [n_x * g1 - sign * xx, n_y * g2 - sign * yy, n_y * g1 + n_x * g2 - 2.0 * sign * xy],
            shear: [n * g1, n * g2],
        }
    })
}

/// The bilinear function that is one at a corner, and its derivatives along x and y, at (ξ, η) in (0, 1).
fn bilinear([xi, eta]: [f64; 2], [a, b]: [f64; 2], corner: usize) -> [f64; 3] {
    let [x_end, y_end, _] = CORNERS[corner];
    let linear =
        |end: usize, s: f64, side: f64| if end == 1 { (s, 1.0 / side) } else { (1.0 - s, -1.0 / side) };
    let ((x, x_slope), (y, y_slope)) = (linear(x_end, xi, a), linear(y_end, eta, b));
    [x * y, x_slope * y, x * y_slope]
}

/// A deflection and its derivatives at a point.
#[derive(Debug, Clone, Copy)]
struct Deflection {
    w: f64,
    x: f64,
    y: f64,
    xx: f64,
    yy: f64,
    xy: f64,
}

/// The sixteen shape functions of w, RX = w,y, RY = −w,x and w,xy at the four corners, at (ξ, η) in (0, 1), for sides (m).
fn deflections([xi, eta]: [f64; 2], [a, b]: [f64; 2]) -> [Deflection; 16] {
    let (along_x, along_y) = (hermite(xi, a), hermite(eta, b));
    std::array::from_fn(|i| {
        let [x_end, y_end, _] = CORNERS[i / 4];
        // Of each dof: whether the function of x, that of y is one of slopes, and the sign.
        let (x_slope, y_slope, sign) = [(0, 0, 1.0), (0, 1, 1.0), (1, 0, -1.0), (1, 1, 1.0)][i % 4];
        let ([x0, x1, x2], [y0, y1, y2]) = (along_x[2 * x_end + x_slope], along_y[2 * y_end + y_slope]);
        let [w, x, y, xx, yy, xy] =
            [x0 * y0, x1 * y0, x0 * y1, x2 * y0, x0 * y2, x1 * y1].map(|value| sign * value);
        Deflection { w, x, y, xx, yy, xy }
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
