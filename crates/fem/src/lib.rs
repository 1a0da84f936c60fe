//! Small honest finite elements for examples and tests, with closed-form solutions beside them.
//!
//! | room | contents |
//! |---|---|
//! | [`bar`] | longitudinal vibration, two nodes, X |
//! | [`beam`] | Euler–Bernoulli bending, two nodes, Z and RY |
//! | [`plate`] | Kirchhoff bending, rectangle of four nodes, Z, RX and RY |
//! | [`orthotropic_plate`] | Kirchhoff bending of an orthotropic plate, rectangle of four nodes, Z, RX, RY and the twist; a matrix for each of four constants |
//! | [`brick`] | three-dimensional elasticity, hexahedron of eight nodes, X, Y and Z; layers of several materials |
//! | [`exact`] | responses, wavenumbers and natural frequencies in closed form |
//!
//! Young's modulus and density are factored out: every stiffness is for E = 1 and every mass for ρ = 1, one
//! pair for each material, so that the dynamic stiffness is
//!
//! D(ω) = Σ_g ( E_g(ω) K_g − ω² ρ_g M_g ).
//!
//! An orthotropic plate has four stiffnesses, one for each of its constants, and one mass.
//!
//! Lengths are in metres, angles in radians. Rotations are right-handed about their axis, so that
//! RX = ∂w/∂y and RY = −∂w/∂x for a deflection w along Z.
//!
//! ```
//! use frfit_fem::{Bar, Direction};
//!
//! let rod = Bar { length: 0.3, area: 5e-4, elements: 100, ..Bar::default() }.assemble()?;
//! let tip = rod.nearest([0.3, 0.0, 0.0]).unwrap();
//! assert_eq!((tip, rod.row(tip, Direction::X)), (101, Some(100)));
//! # Ok::<(), frfit_fem::Error>(())
//! ```

mod assembly;
pub mod bar;
pub mod beam;
pub mod brick;
mod dof;
mod element;
mod error;
pub mod exact;
mod grid;
pub mod orthotropic_plate;
pub mod plate;
mod quadrature;
mod support;

pub use assembly::Assembled;
pub use bar::Bar;
pub use beam::Beam;
pub use brick::Brick;
pub use dof::{Direction, Dof};
pub use element::{Element, Mass};
pub use error::Error;
pub use orthotropic_plate::{OrthotropicPlate, inset_lines};
pub use plate::Plate;
pub use support::Support;
