//! The hexahedron of eight nodes, with or without incompatible modes.

use crate::error::poisson as checked_poisson;
use crate::grid::CORNERS;
use crate::quadrature::GAUSS_2;
use crate::{Element, Error};

/// How a hexahedron deforms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Formulation {
    /// Trilinear displacement with the three bubbles 1−ξ², 1−η², 1−ζ² in each direction, condensed: bends
    /// without locking, and is exact in pure bending of rectangular elements.
    #[default]
    Incompatible,
    /// Trilinear displacement only: far too stiff in bending, and as ν → 1/2.
    Standard,
}

/// Shape functions of the displacement: eight corners, then three bubbles.
const SHAPES: usize = 11;
type Vector = [f64; 3];

/// The element with these corners (m) and Poisson's ratio; dofs X, Y, Z at each corner.
///
/// The corners are in the order of [`Element`]s of a box: the bottom face counterclockwise seen from above,
/// then the top face. 2 × 2 × 2 Gauss points:
/// K = ∫ (λ ∇Nₐ⊗∇N_b + μ ∇N_b⊗∇Nₐ + μ ∇Nₐ·∇N_b 𝟏) dV with λ = ν/((1+ν)(1−2ν)), μ = 1/(2(1+ν)).
/// Gradients of the bubbles are taken with the Jacobian of the centre, j₀/j J₀⁻¹ ∇_ξ N, so that their
/// integral vanishes and any hexahedron passes the patch test.
///
/// Condensing the bubbles commutes with the factor E, for every entry has it. Bubbles carry no mass.
///
/// # Errors
/// [`Error::InsideOut`] where the volume is not positive at an integration point, [`Error::OutOfRange`] for ν.
///
/// # Limits
/// The mass of a hexahedron that is not a parallelepiped is integrated inexactly, its total exactly.
///
/// # Source
/// Taylor, Beresford & Wilson, Int. J. Numer. Methods Eng. 10 (1976) 1211–1219.
pub fn hexahedron(
    corners: &[Vector; 8],
    poisson: f64,
    formulation: Formulation,
) -> Result<Element<24>, Error> {
    let nu = checked_poisson(poisson)?;
    let (lambda, mu) = (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
    let centre = Geometry::at([0.0; 3], corners)?;
    let mut stiffness = [[0.0; 3 * SHAPES]; 3 * SHAPES];
    let mut element = Element { stiffness: [[0.0; 24]; 24], mass: [[0.0; 24]; 24], lumped: [0.0; 24] };
    for point in gauss_points() {
        let here = Geometry::at(point, corners)?;
        let gradients = gradients(point, &here, &centre);
        add_elasticity(&mut stiffness, &gradients, lambda * here.volume, mu * here.volume);
        add_inertia(&mut element, &corner_shapes(point), here.volume);
    }
    if formulation == Formulation::Incompatible {
        condense(&mut stiffness, 24);
    }
    (0..24).for_each(|i| element.stiffness[i].copy_from_slice(&stiffness[i][..24]));
    Ok(element)
}

fn gauss_points() -> impl Iterator<Item = Vector> {
    // All weights are 1.
    let points = GAUSS_2.map(|(point, _)| point);
    (0..8).map(move |i| [points[i % 2], points[i / 2 % 2], points[i / 4]])
}

/// The map from natural coordinates at one point.
struct Geometry {
    /// Rows are ∇ξ, ∇η, ∇ζ.
    inverse: [Vector; 3],
    /// Determinant of the Jacobian.
    volume: f64,
}

impl Geometry {
    fn at(point: Vector, corners: &[Vector; 8]) -> Result<Self, Error> {
        let mut tangents = [[0.0; 3]; 3];
        for (corner, shape) in corners.iter().zip(corner_gradients(point)) {
            for (tangent, derivative) in tangents.iter_mut().zip(shape) {
                (0..3).for_each(|axis| tangent[axis] += derivative * corner[axis]);
            }
        }
        let [u, v, w] = tangents;
        let normals = [cross(v, w), cross(w, u), cross(u, v)];
        let volume = dot(u, normals[0]);
        if !(volume > 0.0 && volume.is_finite()) {
            return Err(Error::InsideOut);
        }
        Ok(Self { inverse: normals.map(|normal| normal.map(|component| component / volume)), volume })
    }

    /// ∇N from ∂N/∂(ξ, η, ζ).
    fn gradient(&self, natural: Vector) -> Vector {
        std::array::from_fn(|axis| (0..3).map(|k| natural[k] * self.inverse[k][axis]).sum())
    }
}

/// ∇N of the eight corners and of the three bubbles.
fn gradients(point: Vector, here: &Geometry, centre: &Geometry) -> [Vector; SHAPES] {
    let corners = corner_gradients(point);
    std::array::from_fn(|shape| {
        if shape < 8 {
            return here.gradient(corners[shape]);
        }
        let mut bubble = [0.0; 3];
        bubble[shape - 8] = -2.0 * point[shape - 8] * centre.volume / here.volume;
        centre.gradient(bubble)
    })
}

/// ξ, η, ζ = ±1 of the corners.
fn signs() -> [Vector; 8] {
    CORNERS.map(|corner| corner.map(|step| 2.0 * step as f64 - 1.0))
}

fn corner_shapes(point: Vector) -> [f64; 8] {
    signs().map(|sign| (0..3).map(|k| (1.0 + sign[k] * point[k]) / 2.0).product())
}

fn corner_gradients(point: Vector) -> [Vector; 8] {
    signs().map(|sign| {
        let factor = |k: usize| (1.0 + sign[k] * point[k]) / 2.0;
        std::array::from_fn(|k| sign[k] / 2.0 * factor((k + 1) % 3) * factor((k + 2) % 3))
    })
}

/// K += λ ∇Nₐ⊗∇N_b + μ (∇N_b⊗∇Nₐ + ∇Nₐ·∇N_b 𝟏).
fn add_elasticity<const N: usize>(k: &mut [[f64; N]; N], gradients: &[Vector; SHAPES], lambda: f64, mu: f64) {
    for (a, of_a) in gradients.iter().enumerate() {
        for (b, of_b) in gradients.iter().enumerate() {
            let shear = mu * dot(*of_a, *of_b);
            for i in 0..3 {
                for j in 0..3 {
                    k[3 * a + i][3 * b + j] += lambda * of_a[i] * of_b[j] + mu * of_a[j] * of_b[i];
                }
                k[3 * a + i][3 * b + i] += shear;
            }
        }
    }
}

fn add_inertia(element: &mut Element<24>, shapes: &[f64; 8], volume: f64) {
    for (a, of_a) in shapes.iter().enumerate() {
        for i in 0..3 {
            element.lumped[3 * a + i] += volume * of_a;
            for (b, of_b) in shapes.iter().enumerate() {
                element.mass[3 * a + i][3 * b + i] += volume * of_a * of_b;
            }
        }
    }
}

/// Eliminates the unknowns from `keep` on, none of them loaded: K ← K_kk − K_kc K_cc⁻¹ K_ck.
fn condense<const N: usize>(k: &mut [[f64; N]; N], keep: usize) {
    for pivot in (keep..N).rev() {
        let eliminated = k[pivot];
        for row in k.iter_mut().take(pivot) {
            let factor = row[pivot] / eliminated[pivot];
            row.iter_mut().zip(eliminated).take(pivot).for_each(|(entry, other)| *entry -= factor * other);
        }
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
