//! Update a finite element model until its FRFs match a test.
//!
//! The dynamic stiffness of a linear structure is affine in its parameters, P-10:
//! $$ D(\omega) = A_0(\omega) + \sum_j c_j A_j(\omega), \qquad D x = F. $$
//! Its response to a change of one parameter is a truncated Neumann (= Taylor) series, P-17, whose terms all come
//! from one factorisation. Setting it equal to a measured response gives a polynomial in the change, P-30; one of its
//! roots corrects the model.
//!
//! ```
//! use frfit::c64;
//! use frfit::for_each::sequential;
//! use frfit::identify::{Context, Frfs, Noise, Options, Problem, Status, Unknown, identify};
//! use frfit::linalg::sparse::Triplets;
//! use frfit::material::Law;
//! use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
//!
//! // Three masses of 1 kg on springs, clamped at one end, struck at the other, and measured at both moving ends.
//! let (mut springs, mut masses) = (Triplets::new(3), Triplets::new(3));
//! springs.add(0, 0, 1.0);
//! for i in 0..3 {
//!     masses.add(i, i, 1.0);
//!     if i < 2 {
//!         springs.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
//!     }
//! }
//! let (springs, masses) = (springs.assemble(), masses.assemble());
//! let chain = |stiffness: c64| {
//!     let term = |name: &str, role, matrix, factor| Term { name: String::from(name), role, matrix, factor };
//!     DynamicStiffness::new(vec![
//!         term("springs", Role::Stiffness, springs.clone(), Law::Constant(stiffness)),
//!         term("masses", Role::Mass, masses.clone(), Law::Constant(c64::new(1.0, 0.0))),
//!     ])
//! };
//! let tip = Sensor { row: 2, sign: 1.0 };
//! let experiment = Experiment::driven_at(3, tip, vec![tip, Sensor { row: 0, sign: 1.0 }]);
//!
//! // What is measured: the springs have 1200 N/m, and a loss factor of 0.05.
//! let truth = c64::new(1200.0, 60.0);
//! let measured_chain = chain(truth)?;
//! let frequency_hz: Vec<f64> = (4..48).map(|k| 0.25 * f64::from(k)).collect();
//! let mut receptance = Vec::new();
//! for &f in &frequency_hz {
//!     let factor = measured_chain.analysis().factor(&measured_chain.at(f, &[])?.assemble(&[]))?;
//!     let mut x = experiment.load.clone();
//!     factor.solve(&mut x)?;
//!     receptance.push(experiment.observe(&x));
//! }
//!
//! // The model has 1000 N/m.
//! let model = chain(c64::new(1000.0, 0.0))?;
//! let unknowns = [Unknown::factor_of(&model, &["springs"])?];
//! let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &receptance, noise: Noise::Unknown };
//! let problem = Problem::new(&model, &experiment, &unknowns, &[], frfs)?;
//! let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
//! let found = identify(&problem, &Options::default(), context)?;
//! for line in &found.lines {
//!     assert!(line.status == Status::Ok && (line.factor().unwrap() - truth).norm() < 1e-6 * truth.norm());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Data flows one way:
//!
//! ```text
//! frequency → material → model → full → { series, rational } → roots → identify → outcome
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`frequency`], [`material`], [`quantity`], [`dof`] | the words: hertz and rad/s, laws of the complex modulus, receptance and its kin, names of degrees of freedom |
//! | [`model`] | [`model::DynamicStiffness`]: named terms, each matrix × law; what is unknown in it; load and sensors |
//! | [`response`] | [`response::Response`]: what the methods ask of a model at one frequency, and the full model's answer |
//! | [`series`] | the Neumann series, the sensitivities, the spectral radius |
//! | [`rational`] | the response as a rational function of the parameter, and all solutions of it (B-1, B-2) |
//! | [`roots`] | the polynomial's roots, which of them are admissible, and why the others are not |
//! | [`select`] | which of the solutions of a whole band are one material, and where the data cannot decide (B-4) |
//! | [`identify`] | one frequency from measurement to updated factor, and a band of them |
//! | [`diagnostics`] | what is wrong with the data against the model, before anything is identified |
//! | [`sensitivity`] | what a response depends on, how well sensors identify it, and where another would add most |
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
mod frfs;
mod halton;
pub mod identify;
pub mod laws;
mod least_squares;
pub mod material;
mod median;
pub mod modal;
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
mod thinned;
mod with_fields;

pub use frfit_linalg as linalg;
pub use frfit_linalg::c64;
