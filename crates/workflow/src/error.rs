//! What a user has to put right: where, what was expected, what was found.

use crate::terminal::one_line;
use frfit_formats::{FormatError, Position};
use std::fmt;
use std::path::{Path, PathBuf};

/// A place in the user's input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file; `None` for the command line.
    pub file: Option<PathBuf>,
    /// Where in the file.
    pub position: Position,
    /// The key of the case file (`identify.order`) or the option (`--order`), where one can be named.
    pub key: Option<String>,
}

impl Place {
    /// A file as a whole.
    pub fn file(path: &Path) -> Self {
        Self { file: Some(path.to_path_buf()), position: Position::File, key: None }
    }

    /// An option of the command line.
    pub fn option(name: &str) -> Self {
        Self { file: None, position: Position::File, key: Some(name.to_owned()) }
    }

    /// The same place, for a key below its own.
    #[must_use]
    pub fn below(&self, key: &str) -> Self {
        let path = self.key.iter().map(String::as_str).chain([key]).collect::<Vec<_>>().join(".");
        Self { key: Some(path), ..self.clone() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}", one_line(&file.to_string_lossy()))?;
            match self.position {
                Position::File => {}
                Position::Line { line, column: None } => write!(f, ":{line}")?,
                Position::Line { line, column: Some(column) } => write!(f, ":{line}:{column}")?,
                Position::Byte(offset) => write!(f, ", byte {offset}")?,
            }
        }
        match (&self.file, &self.key) {
            (Some(_), Some(key)) => write!(f, ": {}", one_line(key)),
            (None, Some(key)) => write!(f, "{}", one_line(key)),
            (_, None) => Ok(()),
        }
    }
}

/// An input that cannot be used.
///
/// Shown in one line, `place: expected …, found …`, and, where a file is at fault that a case names, a second
/// line that says where it is named. What is quoted of files has no end of a line in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// Where.
    pub place: Box<Place>,
    /// What is asked for there.
    pub expected: String,
    /// The text that was found instead.
    pub found: String,
    /// The key that names the file at fault.
    pub named_by: Option<Box<Place>>,
}

impl InputError {
    /// An error at a place.
    pub fn at(place: &Place, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            place: Box::new(place.clone()),
            expected: expected.into(),
            found: found.into(),
            named_by: None,
        }
    }

    /// What a reader says about a file.
    pub fn in_file(path: &Path, error: FormatError) -> Self {
        let place = Place { position: error.position, ..Place::file(path) };
        Self::at(&place, error.expected, error.found)
    }

    /// The same error, with the key that names the file.
    #[must_use]
    pub fn named_by(self, place: &Place) -> Self {
        Self { named_by: Some(Box::new(place.clone())), ..self }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (expected, found) = (one_line(&self.expected), one_line(&self.found));
        write!(f, "{}: expected {expected}, found {found}", self.place)?;
        match &self.named_by {
            Some(place) => write!(f, "\nnamed in {place}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for InputError {}
