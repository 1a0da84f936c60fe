//! The one error of all readers: where, what was expected, what was found.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file a reader stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// The file as a whole (empty, of an unknown kind, shorter than its header says).
    File,
    /// A text line, counted from 1, and the column (in characters, counted from 1), where one can be named.
    Line {
        /// Line number, from 1.
        line: usize,
        /// Column in characters, from 1; `None` where the whole line is meant.
        column: Option<usize>,
    },
    /// A byte offset, counted from 0, in a binary part.
    Byte(usize),
}

/// A file that cannot be read: where, what was expected there, what was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormatError {
    /// The file, where the caller has said which ([`FormatError::in_file`]).
    pub file: Option<PathBuf>,
    /// The place in it.
    pub position: Position,
    /// What the format asks for at this place.
    pub expected: String,
    /// The text that was found instead.
    pub found: String,
}

impl FormatError {
    /// An error about the file as a whole.
    pub fn whole(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { file: None, position: Position::File, expected: expected.into(), found: found.into() }
    }

    /// An error about a whole line (from 1).
    pub fn line(line: usize, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { position: Position::Line { line, column: None }, ..Self::whole(expected, found) }
    }

    /// An error at a column (from 1) of a line (from 1).
    pub fn column(line: usize, column: usize, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { position: Position::Line { line, column: Some(column) }, ..Self::whole(expected, found) }
    }

    /// An error at a byte offset (from 0).
    pub fn byte(offset: usize, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { position: Position::Byte(offset), ..Self::whole(expected, found) }
    }

    /// The same error with the file's name in it.
    #[must_use]
    pub fn in_file(mut self, file: &Path) -> Self {
        self.file = Some(file.to_path_buf());
        self
    }
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.file {
            Some(file) => write!(f, "{}", file.display())?,
            None => write!(f, "input")?,
        }
        match self.position {
            Position::File => write!(f, ": ")?,
            Position::Line { line, column: None } => write!(f, ":{line}: ")?,
            Position::Line { line, column: Some(column) } => write!(f, ":{line}:{column}: ")?,
            Position::Byte(offset) => write!(f, ", byte {offset}: ")?,
        }
        write!(f, "expected {}, found {}", self.expected, self.found)
    }
}

impl std::error::Error for FormatError {}
