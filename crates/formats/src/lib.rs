//! Bytes in, typed records out, for the files that structural dynamics lives on.
//!
//! | format | module |
//! |---|---|
//! | Matrix Market | [`matrix_market`] |
//! | Harwell–Boeing | [`harwell_boeing`] |
//! | Universal File Format (UFF) | [`uff`] |
//! | tables with named columns (CSV) | [`csv`] |
//! | LabVIEW measurement files (.lvm) | [`lvm`] |
//! | input decks of Nastran, Abaqus, Ansys (written only) | [`cards`] |
//!
//! [`detect`] tells which of them a file is, [`read_matrix`] reads either kind of matrix file.
//!
//! The crate knows neither physics nor a linear algebra library. Every reader takes the whole file as
//! bytes and says, when it refuses one, where ([`Position`]), what it expected and what it found
//! ([`FormatError`]). No reader allocates from a number in a header before that number is checked
//! against the bytes that are there.

mod assemble;
mod detect;
mod error;
mod matrix;
mod text;

pub mod cards;
pub mod csv;
pub mod harwell_boeing;
pub mod lvm;
pub mod matrix_market;
pub mod uff;

pub use detect::{FileKind, detect, read_matrix};
pub use error::{FormatError, Position};
pub use matrix::{CoordinateMatrix, Entries, Symmetry};
