//! Why a job was not done.

use crate::error::InputError;
use crate::memory::MemoryError;
use crate::output::WriteError;
use frfit::identify::ProblemError;
use frfit::material::OutsideTable;
use frfit_figures::PngError;
use std::fmt;

/// Why a job was not done.
#[derive(Debug)]
pub enum JobError {
    /// The user's input is at fault.
    Input(InputError),
    /// A table of a factor does not reach a frequency of the band.
    OutsideTable(OutsideTable),
    /// The case has a fault that was not seen when it was loaded.
    Problem(ProblemError),
    /// The model does not fit into memory.
    Memory(MemoryError),
    /// The output folder cannot be written.
    Write(WriteError),
    /// A figure could not be drawn: a fault of this program.
    Figure(PngError),
    /// The page could not be made of the results, which are written: a fault of this program.
    Report(InputError),
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => write!(f, "{error}"),
            Self::OutsideTable(error) => write!(f, "{error}"),
            Self::Problem(error) => write!(f, "{error}"),
            Self::Memory(error) => write!(f, "{error}"),
            Self::Write(error) => write!(f, "{error}"),
            Self::Figure(error) => write!(f, "a figure could not be drawn: {error}"),
            Self::Report(error) => {
                write!(f, "the results are written, but no report.html could be made of them: {error}")
            }
        }
    }
}

impl std::error::Error for JobError {}

macro_rules! from {
    ($($kind:ident($error:ty)),*) => {
        $(impl From<$error> for JobError {
            fn from(error: $error) -> Self {
                Self::$kind(error)
            }
        })*
    };
}

from!(
    Input(InputError),
    OutsideTable(OutsideTable),
    Problem(ProblemError),
    Memory(MemoryError),
    Write(WriteError),
    Figure(PngError)
);
