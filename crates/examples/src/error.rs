//! Why an example cannot be made.

use frfit::material::OutsideTable;
use frfit::model::ModelError;
use frfit_formats::FormatError;
use frfit_linalg::solve::Breakdown;
use std::fmt;

/// Why an example, or a model of the size that was asked for, cannot be made.
#[derive(Debug, Clone, PartialEq)]
pub enum Error {
    /// No example has this name.
    UnknownExample {
        /// The name that was asked for.
        asked: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// A mesh without elements, or too large to be numbered.
    Mesh(frfit_fem::Error),
    /// The terms make no model.
    Model(ModelError),
    /// A law that does not reach a frequency.
    Law(OutsideTable),
    /// A system that cannot be solved.
    Breakdown(Breakdown),
    /// A record that a format cannot hold.
    Format(FormatError),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownExample { asked, known } => {
                write!(f, "expected the name of an example ({}), found {asked:?}", known.join(", "))
            }
            Self::Mesh(error) => write!(f, "{error}"),
            Self::Model(error) => write!(f, "{error}"),
            Self::Law(error) => write!(f, "{error}"),
            Self::Breakdown(error) => write!(f, "{error}"),
            Self::Format(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<frfit_fem::Error> for Error {
    fn from(error: frfit_fem::Error) -> Self {
        Self::Mesh(error)
    }
}

impl From<ModelError> for Error {
    fn from(error: ModelError) -> Self {
        Self::Model(error)
    }
}

impl From<OutsideTable> for Error {
    fn from(error: OutsideTable) -> Self {
        Self::Law(error)
    }
}

impl From<Breakdown> for Error {
    fn from(error: Breakdown) -> Self {
        Self::Breakdown(error)
    }
}

impl From<FormatError> for Error {
    fn from(error: FormatError) -> Self {
        Self::Format(error)
    }
}
