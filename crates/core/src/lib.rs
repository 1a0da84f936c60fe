//! Correct a finite element model until its frequency response is the measured one.
//!
//! The dynamic stiffness of a linear structure is affine in its parameters, P-10:
//! $$ D(\omega) = A_0(\omega) + \sum_j c_j A_j(\omega), \qquad D x = F. $$
//! Its response to a change of one parameter is a truncated Neumann (= Taylor) series, P-17, whose terms all come
//! from one factorisation. Setting it equal to a measured response gives a polynomial in the change, P-30; one of its
//! roots corrects the model.
//!
//! Data flows one way:
//!
//! ```text
//! frequency → material → model → full → { series, rational } → roots → identify → outcome
//! ```
//!
//! | module | what is in it |
//! |---|---|
//! | [`frequency`], [`material`], [`quantity`], [`dof`] | the words: hertz and rad/s, laws of the complex modulus, receptance and its kin, names of degrees of freedom |
//! | [`model`] | [`model::DynamicStiffness`]: named terms, each matrix × law; what is unknown in it; load and sensors |
//! | [`response`] | [`response::Response`]: what the methods ask of a model at one frequency, and the full model's answer |
//! | [`series`] | the Neumann series, the sensitivities, the spectral radius |
//! | [`rational`] | the response as a rational function of the parameter, and all solutions of it (B-1, B-2) |
//! | [`roots`] | the polynomial's roots, which of them are admissible, and why the others are not |
//! | [`select`] | which of the solutions of a whole band are one material, and where the data cannot tell (B-4) |
//! | [`identify`] | one frequency from measurement to updated factor, and a band of them |
//! | [`diagnostics`] | what is wrong with the data against the model, before anything is identified |
//! | [`sensitivity`] | what a response depends on, what sensors tell of it, and where another would tell most |
//! | [`laws`] | laws of the modulus with few parameters, fitted to moduli or straight to the FRFs (B-7) |
//! | [`signal`] | records of a hammer test to an FRF with coherence and variance (B-6) |
//! | [`nelder_mead`] | the search on direct solves that the series is compared with |
//! | [`efficiency`] | operation counts, P-49 to P-51 |
//!
//! Labels P-n are equations of the paper (DOI 10.1115/1.4041217), B-n go beyond it; `docs/equations.md` lists
//! where each lives. Time convention e^{+iωt}; SI units unless the name says otherwise.

pub mod diagnostics;
pub mod dof;
pub mod efficiency;
pub mod for_each;
pub mod frequency;
pub mod identify;
pub mod laws;
pub mod material;
mod median;
pub mod model;
pub mod nelder_mead;
pub mod quantity;
pub mod rational;
pub mod response;
pub mod roots;
pub mod select;
pub mod sensitivity;
pub mod series;
pub mod signal;
mod smooth;
pub mod subspace;

pub use frfit_linalg::c64;
