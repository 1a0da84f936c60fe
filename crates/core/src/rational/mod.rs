//! The response as a rational function of one parameter: poles are represented, so resonances do not bound convergence.
//!
//! B-1: an orthonormal basis V of the Neumann vectors, D(c) projected on it with the transpose (which keeps the complex
//! symmetry),
//! $$ x_m(c) \approx \ell^T \Big(\sum_{q=0}^d c^q V^T A_q V\Big)^{-1} V^T F, \qquad \ell = V^T e_m. $$
//! B-2: all solutions of x_m(c) = u are eigenvalues of one small pencil; each is polished and carries its true residual.
//!
//! # Source
//! U. Kirsch, Computers & Structures 78 (2000) 481–492 (combined approximations) is the precedent in structural reanalysis.

mod basis;
mod between;
mod poles;
mod response;
mod roots;

pub use between::PolesBetween;
pub use poles::Poles;
pub use response::RationalResponse;
pub use roots::RationalRoot;
