//! How a command ends.

use frfit_workflow::error::InputError;
use frfit_workflow::job::JobError;
use frfit_workflow::output::WriteError;
use std::fmt;
use std::process::ExitCode;

/// A command that was carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Done: 0.
    Done,
    /// Done, but under `--strict` some frequency has no trusted answer: 1.
    NotTrusted,
}

impl Outcome {
    pub(crate) fn code(self) -> ExitCode {
        match self {
            Self::Done => ExitCode::SUCCESS,
            Self::NotTrusted => ExitCode::from(1),
        }
    }
}

/// A command that was not carried out.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The user's input is at fault: 2.
    Input(String),
    /// This program is: 3.
    Internal(String),
}

impl Failure {
    pub(crate) fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Input(_) => 2,
            Self::Internal(_) => 3,
        })
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) => write!(f, "{message}"),
            Self::Internal(message) => write!(f, "internal error: {message}"),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<JobError> for Failure {
    fn from(error: JobError) -> Self {
        match error {
            JobError::Figure(_) | JobError::Report(_) => Self::Internal(error.to_string()),
            JobError::Input(_) | JobError::OutsideTable(_) | JobError::Memory(_) | JobError::Write(_) => {
                Self::Input(error.to_string())
            }
        }
    }
}
