//! Datasets as bytes, delimiter lines included: a file is any number of them one after the other.
//!
//! Numbers are written as the format document has them, with one digit before the decimal point. Text is UTF-8.

mod fixed;
mod function;
mod header;
mod nodes;
mod shapes;
mod units;

use super::binary::Endian;

pub use function::function;
pub use header::file_header;
pub use nodes::{nodes_15, nodes_2411};
pub use shapes::{ModeShape, mode_shape};
pub use units::units;

/// How the data of a function are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Form {
    /// Dataset 58: 6 significant digits in single, 13 in double precision; a stored abscissa always has 6.
    #[default]
    Ascii,
    /// Dataset 58b: all numbers, a stored abscissa too, as IEEE 754 in the precision of the ordinate.
    Binary {
        /// Order of their bytes.
        endian: Endian,
    },
}

const DELIMITER: &str = "    -1\n";
