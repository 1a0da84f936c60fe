//! What a caller must fix before a structure can be assembled.

use std::fmt;

/// Why a structure cannot be assembled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Error {
    /// A number outside its range.
    OutOfRange {
        /// What the number is.
        name: &'static str,
        /// The range.
        expected: &'static str,
        /// The number.
        found: f64,
    },
    /// Every dof is held.
    NothingMoves,
    /// More nodes than [`Error::MAX_NODES`].
    TooManyNodes,
    /// The corners of a hexahedron are not in the order of the element, or it is folded or flat.
    InsideOut,
    /// Dimensions so large or small that a matrix is not finite.
    NotFinite,
}

impl Error {
    /// Most nodes of one structure: some 50 million dofs of bricks, whose matrices take tens of gigabytes.
    pub const MAX_NODES: usize = 1 << 24;
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { name, expected, found } => {
                write!(f, "{name}: expected {expected}, found {found}")
            }
            Self::NothingMoves => write!(f, "every degree of freedom is held: expected one that moves"),
            Self::TooManyNodes => write!(f, "number of nodes: expected at most {}", Self::MAX_NODES),
            Self::InsideOut => write!(f, "hexahedron: expected a positive volume at every integration point"),
            Self::NotFinite => write!(f, "dimensions: expected sizes whose matrices are finite"),
        }
    }
}

impl std::error::Error for Error {}

/// Refuses what is not a finite number above zero.
pub(crate) fn positive(name: &'static str, found: f64) -> Result<f64, Error> {
    if found.is_finite() && found > 0.0 {
        return Ok(found);
    }
    Err(Error::OutOfRange { name, expected: "a finite number above 0", found })
}

/// Refuses Poisson's ratios of no isotropic solid: −1 < ν < 1/2.
pub(crate) fn poisson(found: f64) -> Result<f64, Error> {
    if found > -1.0 && found < 0.5 {
        return Ok(found);
    }
    Err(Error::OutOfRange { name: "Poisson's ratio", expected: "more than -1 and less than 1/2", found })
}
