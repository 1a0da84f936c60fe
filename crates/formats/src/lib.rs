//! Bytes in, typed records out, for the files that structural dynamics lives on.
//!
//! | format | module |
//! |---|---|
//! | Matrix Market | [`matrix_market`] |
//! | Harwell–Boeing | [`harwell_boeing`] |
//! | CalculiX (`.sti`, `.mas`, `.dof`) | [`triplets`] |
//! | Abaqus matrices (`.mtx`) | [`abaqus`], [`triplets`] |
//! | Ansys mapping of HBMAT (`.mapping`) | [`ansys`] |
//! | Nastran DMIG (`.pch`, bulk data) | [`dmig`] |
//! | Nastran OUTPUT4 (`.op4`) | [`op4`] |
//! | NumPy and SciPy (`.npy`, `.npz`) | [`numpy`] |
//! | MATLAB (`.mat`, versions 5 to 7) | [`mat`] |
//! | Universal File Format (UFF) | [`uff`] |
//! | tables with named columns (CSV) | [`csv`] |
//! | LabVIEW measurement files (.lvm) | [`lvm`] |
//! | input decks of Nastran, Abaqus, Ansys (written only) | [`cards`] |
//!
//! [`detect`] says which of them a file is, [`read_matrices`] reads every kind of matrix file.
//!
//! The crate knows neither physics nor a linear algebra library. Every reader takes the whole file as
//! bytes and says, when it refuses one, where ([`Position`]), what it expected and what it found
//! ([`FormatError`]). No reader allocates from a number in a header before that number is checked
//! against the bytes that are there.

mod assemble;
mod bytes;
mod columns;
mod detect;
mod error;
mod gather;
mod inflated;
mod label;
mod labelled;
mod matrix;
mod named;
mod text;

pub mod abaqus;
pub mod ansys;
pub mod cards;
pub mod csv;
pub mod dmig;
pub mod harwell_boeing;
pub mod lvm;
pub mod mat;
pub mod matrix_market;
pub mod numpy;
pub mod op4;
pub mod triplets;
pub mod uff;

pub use detect::{FileKind, MATRIX_FORMATS, detect, read_matrices, read_matrix};
pub use error::{FormatError, Position};
pub use label::{DofLabel, Labels, listed_labels};
pub use matrix::{CoordinateMatrix, Entries, Symmetry};
pub use named::{NamedMatrix, choose_matrix, take_matrix};
