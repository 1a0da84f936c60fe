//! What a table of moduli is written as.

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

/// A word that is none of those that are known.
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

/// The units of the model that the table is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnitSystem {
    /// m, kg, s: moduli in Pa, densities in kg/m³.
    #[default]
    Si,
    /// mm, t, s (and N): moduli in MPa, densities in t/mm³.
    MillimetreTonne,
}

impl UnitSystem {
    /// As the command line has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Si => "SI",
            Self::MillimetreTonne => "mm-t-s",
        }
    }

    /// The unit of a modulus.
    pub fn modulus_unit(self) -> &'static str {
        match self {
            Self::Si => "Pa",
            Self::MillimetreTonne => "MPa",
        }
    }

    /// The unit of a density.
    pub fn density_unit(self) -> &'static str {
        match self {
            Self::Si => "kg/m^3",
            Self::MillimetreTonne => "t/mm^3",
        }
    }

    /// A modulus in pascal, in this system: 1 N/mm² = 1 MPa.
    pub fn modulus(self, pascal: f64) -> f64 {
        match self {
            Self::Si => pascal,
            Self::MillimetreTonne => pascal / 1e6,
        }
    }

    /// A density in kg/m³, in this system: 1 t/mm³ = 1e12 kg/m³.
    pub fn density(self, kg_per_m3: f64) -> f64 {
        match self {
            Self::Si => kg_per_m3,
            Self::MillimetreTonne => kg_per_m3 / 1e12,
        }
    }
}

impl FromStr for UnitSystem {
    type Err = UnknownWord;

    fn from_str(text: &str) -> Result<Self, UnknownWord> {
        known(&[("SI", Self::Si), ("mm-t-s", Self::MillimetreTonne)], text)
    }
}

/// What is to be written, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// Who is to read it.
    pub target: Target,
    /// The units of the numbers.
    pub units: UnitSystem,
    /// Poisson's ratio; a solver needs it.
    pub poisson: Option<f64>,
    /// kg/m³.
    pub density: Option<f64>,
    /// The modulus in pascal that the matrix was made with, where the table's factors are relative to it.
    pub modulus: Option<f64>,
    /// Number of the material (Nastran and Ansys), and of the first of Nastran's tables.
    pub id: u32,
    /// Name of the material (Abaqus).
    pub name: String,
    /// Every row with a modulus, not only those that are `ok`.
    pub all: bool,
}
