//! What stands in the way of a problem.

use super::options::OptionsError;
use crate::material::OutsideTable;
use crate::subspace::KeptError;
use std::borrow::Cow;
use std::fmt;

/// What is wrong with a problem, and where.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ProblemError {
    /// A wrong number of something.
    Count {
        /// Of what, and where.
        what: String,
        /// How many there should be.
        expected: String,
        /// How many there are.
        found: usize,
    },
    /// A value that cannot be.
    Value {
        /// Which, and where.
        what: String,
        /// What it should be.
        expected: Cow<'static, str>,
        /// What it is.
        found: String,
    },
    /// An unknown that cannot be.
    Unknown {
        /// Its name.
        name: String,
        /// What was expected of it.
        expected: String,
        /// What it is.
        found: String,
    },
    /// More unknown than measured real numbers.
    Undetermined {
        /// Measured real numbers.
        measured: usize,
        /// Unknown real numbers.
        unknown: usize,
    },
    /// A combination that has no method.
    Unsupported {
        /// What.
        what: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// A table of a factor that does not reach a frequency.
    Table(OutsideTable),
    /// A wrong option.
    Options(OptionsError),
    /// A reduced model that was kept of another model.
    Reduced(KeptError),
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { what, expected, found } => write!(f, "{what}: expected {expected}, found {found}"),
            Self::Value { what, expected, found } => write!(f, "{what}: expected {expected}, found {found}"),
            Self::Unknown { name, expected, found } => {
                write!(f, "unknown {name:?}: expected {expected}, found {found}")
            }
            Self::Undetermined { measured, unknown } => {
                write!(
                    f,
                    "expected at least {unknown} measured real numbers for as many unknown ones, found {measured}"
                )
            }
            Self::Unsupported { what, reason } => write!(f, "{what}: {reason}"),
            Self::Table(outside) => outside.fmt(f),
            Self::Options(wrong) => wrong.fmt(f),
            Self::Reduced(wrong) => write!(f, "the reduced model: {wrong}"),
        }
    }
}

impl std::error::Error for ProblemError {}

impl From<OutsideTable> for ProblemError {
    fn from(outside: OutsideTable) -> Self {
        Self::Table(outside)
    }
}

impl From<OptionsError> for ProblemError {
    fn from(wrong: OptionsError) -> Self {
        Self::Options(wrong)
    }
}

impl From<KeptError> for ProblemError {
    fn from(wrong: KeptError) -> Self {
        Self::Reduced(wrong)
    }
}

/// A wrong value.
pub(super) fn value(
    what: impl Into<String>,
    expected: impl Into<Cow<'static, str>>,
    found: impl ToString,
) -> ProblemError {
    ProblemError::Value { what: what.into(), expected: expected.into(), found: found.to_string() }
}
