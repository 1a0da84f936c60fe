//! What a table of moduli is written as.

use crate::units::UnitSystem;
use std::fmt;
use std::str::FromStr;

/// Who is to read it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Nastran's bulk data.
    Nastran,
    /// Abaqus's input.
    Abaqus,
    /// Ansys Mechanical APDL.
    Ansys,
    /// A table.
    Csv,
    /// JSON.
    Json,
}

impl Target {
    const ALL: [(&'static str, Self); 5] = [
        ("nastran", Self::Nastran),
        ("abaqus", Self::Abaqus),
        ("ansys", Self::Ansys),
        ("csv", Self::Csv),
        ("json", Self::Json),
    ];

    /// Whether it is the input of a solver.
    pub fn is_solver(self) -> bool {
        !matches!(self, Self::Csv | Self::Json)
    }
}

/// A word that is not known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownWord {
    expected: String,
    found: String,
}

impl fmt::Display for UnknownWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}, found {:?}", self.expected, self.found)
    }
}

impl std::error::Error for UnknownWord {}

fn known<T: Copy>(all: &[(&str, T)], text: &str) -> Result<T, UnknownWord> {
    all.iter().find(|(name, _)| *name == text).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        let (last, rest) = names.split_last().unwrap_or((&"", &[]));
        UnknownWord { expected: format!("{} or {last}", rest.join(", ")), found: text.to_owned() }
    })
}

impl FromStr for Target {
    type Err = UnknownWord;

    fn from_str(text: &str) -> Result<Self, UnknownWord> {
        known(&Self::ALL, text)
    }
}

/// What is to be written, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// Who is to read it.
    pub target: Target,
    /// The units of the numbers; `None`: those of the case that the table came of, else SI.
    pub units: Option<UnitSystem>,
    /// Poisson's ratio; a solver needs it.
    pub poisson: Option<f64>,
    /// kg/m³.
    pub density: Option<f64>,
    /// The modulus in pascal that the matrix was made with, where the table's factors are relative to it: then they are, whatever the case says.
    pub modulus: Option<f64>,
    /// Number of the material (Nastran and Ansys), and of the first of Nastran's tables.
    pub id: u32,
    /// Name of the material (Abaqus).
    pub name: String,
    /// Every row with a modulus, not only those that are `ok`.
    pub all: bool,
    /// Which of several unknowns; `None` where the table has one.
    pub unknown: Option<String>,
}
