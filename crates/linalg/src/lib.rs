//! Linear algebra for dynamic stiffness matrices: sparse, symmetric, real or complex.
//!
//! | room | content |
//! |---|---|
//! | [`sparse`] | patterns shared by all terms of a model, matrices on them, products |
//! | [`solve`] | analyse → factor → solve, every solution checked by its true residual |
//! | [`spectral`] | the spectral radius of an operator given by its action |
//! | [`modes`] | the lowest natural modes of K φ = ω² M φ |
//! | [`column_block`] | a few long real vectors as one matrix |
//! | [`vector`] | products and projections of complex vectors |
//! | [`dense`] | small dense problems: eigenvalues, least squares, roots of polynomials |
//!
//! A complex symmetric matrix here satisfies Aᵀ = A, not Aᴴ = A: that is what a dynamic stiffness with
//! hysteretic damping is. This is the only crate of frfit that computes with faer. Scalars are `f64` and
//! [`c64`]; where one code serves both it is generic over exactly these two ([`Scalar`], sealed).

pub mod column_block;
pub mod dense;
pub mod modes;
mod scalar;
pub mod solve;
pub mod sparse;
pub mod spectral;
pub mod vector;

pub use num_complex::Complex64 as c64;
pub use scalar::Scalar;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
