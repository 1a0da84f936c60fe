//! Sparse L D Lᵀ of symmetric matrices: real indefinite, and complex symmetric (A = Aᵀ, not Hermitian).
//!
//! ```
//! use multifrontal::{Options, Symbolic, Threads};
//!
//! // [4 1 0; 1 0 2; 0 2 5], the lower triangle by columns.
//! let symbolic = Symbolic::new(3, &[0, 2, 4, 5], &[0, 1, 1, 2, 2], &Options::default())?;
//! let values = [4.0, 1.0, 0.0, 2.0, 5.0];
//! let factor = symbolic.factor(&values, &Options::default())?;
//! let mut x = [6.0, 7.0, 19.0];
//! factor.solve_in_place(&mut x, Threads::One);
//! let exact: [f64; 3] = [1.0, 2.0, 3.0];
//! assert!(x.iter().zip(exact).all(|(x, exact)| (x - exact).abs() < 1e-14));
//! assert_eq!(factor.inertia().negative, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Everything that no number changes is done once ([`Symbolic`]); then each matrix of that pattern is
//! factorised ([`Symbolic::factor`]) and solved with ([`Factor::solve_in_place`]). The factorisation is multifrontal:
//! dense fronts along the elimination tree, each with pivots of one and two under a threshold, and what cannot be
//! eliminated safely is left to the parent front.
//!
//! [`Solver`] refines its solutions and says how good they are. [`SymmetricMatrix`] makes the lower triangle of triplets,
//! of compressed columns and, with the features `faer` and `sprs`, of the sparse matrices of these crates.
//!
//! # Threads
//! [`Threads`] is an option of every step: the calling thread, or the rayon pool in which the call is made. The numbers
//! do not depend on it.
//!
//! # Source
//! I. S. Duff, J. K. Reid, ACM Trans. Math. Softw. 9 (1983) 302–325; J. W. H. Liu, SIAM Rev. 34 (1992) 82–109.

#![cfg_attr(docsrs, feature(doc_cfg))]
#![allow(clippy::needless_range_loop, reason = "rows, columns and parts are numbered as in the formulas")]

mod branch;
mod error;
mod factor;
mod front;
mod kernel;
mod matrix;
mod memory;
mod options;
mod ordering;
mod packed_lower;
mod rounded;
mod run;
mod scalar;
mod scaling;
mod solve;
mod solver;
mod symbolic;
mod threads;

pub use error::FactorError;
pub use factor::{Factor, Inertia};
pub use matrix::{MatrixError, SymmetricMatrix, Triangle};
pub use options::Options;
pub use rounded::RoundedFactor;
pub use scalar::{Scalar, c32, c64};
pub use solver::{Precision, Solution, Solver};
pub use symbolic::{Ordering, PatternError, Symbolic};
pub use threads::Threads;

/// The instruction set of this machine, found out once.
fn arch() -> pulp::Arch {
    static ARCH: std::sync::OnceLock<pulp::Arch> = std::sync::OnceLock::new();
    *ARCH.get_or_init(pulp::Arch::new)
}

/// max |x|; NaN if one of the numbers is NaN.
fn size<T: Scalar>(x: &[T]) -> f64 {
    let larger = |largest: f64, size: f64| if size > largest || size.is_nan() { size } else { largest };
    x.iter().map(|x| x.modulus()).fold(0.0, larger)
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
