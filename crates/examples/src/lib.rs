//! Complete runnable cases with known answers, generated offline.
//!
//! An example is a folder: a case file that reads as documentation, the matrices of a finite element model, a
//! measurement, the truth, and a README with what to expect. [`list`] names them, [`generate`] yields their files,
//! the same bytes each time; writing them is the caller's.
//!
//! | example | model | what it shows |
//! |---|---|---|
//! | `rubber-bar` | [`rubber_bar`] | the paper's Section 6: a law of the modulus recovered over two decades |
//! | `rubber-bar-end` | [`rubber_bar_end`] | several moduli explain one sensor, a second sensor separates them |
//! | `clamped-plate` | [`clamped_plate`] | the paper's Section 8: divergence near resonances |
//! | `density` | [`density`] | a real factor of the mass |
//! | `hammer-bar` | [`hammer_bar`] | the paper's Section 7: from the records of a hammer test to the modulus |
//! | `sandwich` | [`sandwich`] | one unknown among several matrices, named degrees of freedom, two sensors |
//! | `plate-thickness` | [`plate_thickness`] | a geometric parameter: one real number for the band, with an error bar |
//! | `two-materials` | [`two_materials`] | two complex moduli at every frequency from three sensors |
//! | `joint-stiffness` | [`joint_stiffness`] | a spring between two parts: a matrix of rank one, a complex constant |
//! | `added-mass` | [`added_mass`] | a mass that sits on the structure and the modulus below it, and their correlation |
//! | `two-meshes` | [`two_meshes`] | a mesh that is too coarse, and a coarser one that says so |
//! | `orthotropic-plate` | [`orthotropic_plate`] | from five impacts to the four constants of a wooden plate |
//!
//! The functions in the second column take the size of the mesh, for tests and benchmarks. The measurement is a direct
//! solution of the same model with the true parameter, as in the paper: it shows what the method recovers, not what
//! a test rig adds. The examples with constants have noise, whose standard deviation is known. `hammer-bar` is measured on an exact solution, `two-meshes` and `orthotropic-plate` on a finer mesh: what the mesh adds is in their answers.
//!
//! ```
//! use frfit::identify::{Options, Unknown, identify_at};
//!
//! let bar = frfit_examples::rubber_bar(100)?;
//! let (nominal, measured) = (bar.nominal_at(1500.0)?, bar.measured_at(1500.0)?);
//! let answer = identify_at(&nominal, &measured, &Unknown::of_parameter(&bar.parameter), &Options::default());
//! let (found, truth) = (answer.factor().unwrap(), bar.truth.at(1500.0)?);
//! assert!((found - truth).norm() < 1e-6 * truth.norm());
//! # Ok::<(), frfit_examples::Error>(())
//! ```

mod added_mass;
mod cantilever;
mod clamped_plate;
mod density;
mod error;
mod example;
mod file;
mod hammer_bar;
mod hammer_test;
mod joint_stiffness;
mod model;
mod orthotropic_plate;
mod plate_thickness;
mod rig;
mod rubber_bar;
mod sandwich;
mod several;
mod two_materials;
mod two_meshes;

pub use added_mass::added_mass;
pub use clamped_plate::clamped_plate;
pub use density::density;
pub use error::Error;
pub use example::{Example, generate, list};
pub use file::{File, matrix};
pub use hammer_bar::{hammer_accelerance, hammer_bar, hammer_records, hammer_rod, polyurethane};
pub use joint_stiffness::joint_stiffness;
pub use model::Model;
pub use orthotropic_plate::{orthotropic_plate, plate_records};
pub use plate_thickness::plate_thickness;
pub use rig::Rig;
pub use rubber_bar::{POLYBUTADIENE, rubber_bar, rubber_bar_end};
pub use sandwich::sandwich;
pub use several::{Measured, SeveralModel};
pub use two_materials::two_materials;
pub use two_meshes::two_meshes;

/// The program of the documentation site's page on the library, as a doc test: it uses the crates that this one does.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/site/src/library.md")]
struct Library;
