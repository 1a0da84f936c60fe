//! How a command ends.

use frfit_workflow::error::InputError;
use frfit_workflow::job::JobError;
use frfit_workflow::output::WriteError;
use frfit_workflow::terminal::printable;
use std::fmt;
use std::io::Write;
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

/// How a command line ends that is wrong, or that asks for help.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    // In colours, unless what was typed would bring some of its own.
    let typed = std::env::args_os().any(|word| word.to_string_lossy().contains(char::is_control));
    let shown = error.render().to_string();
    // Nothing can be done where standard error is closed.
    let _ = match typed && error.use_stderr() {
        true => std::io::stderr().write_all(printable(&shown).as_bytes()),
        false => error.print(),
    };
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
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
            JobError::Input(_)
            | JobError::OutsideTable(_)
            | JobError::Problem(_)
            | JobError::Memory(_)
            | JobError::Write(_) => Self::Input(error.to_string()),
        }
    }
}
