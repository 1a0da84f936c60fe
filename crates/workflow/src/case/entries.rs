//! What stands in a case file, as types.

use crate::error::{InputError, Place};
use crate::nearest::nearest;
use crate::units::{Amount, UnitSystem};
use frfit::dof::{Axis, DofName};
use frfit::identify::{Method, ModelErrors, Reduction, Selection, Variation};
use frfit::material::Law;
use frfit::model::{FactorStd, Role};
use frfit::quantity::Quantity;
use std::path::PathBuf;
use std::str::FromStr;

/// A value and where it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Its place.
    pub place: Place,
}

/// A case file.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseFile {
    /// The file it was read from.
    pub file: PathBuf,
    /// `title`.
    pub title: Option<String>,
    /// `units`: those of the model.
    pub units: UnitSystem,
    /// `[[matrix]]`, at least one, names distinct.
    pub matrices: Vec<MatrixEntry>,
    /// `dofs.file`.
    pub dofs: Option<Located<String>>,
    /// `[[attached]]`.
    pub attached: Vec<AttachedEntry>,
    /// `[load]`.
    pub load: LoadEntry,
    /// `[[measurement]]`, at least one.
    pub measurements: Vec<MeasurementEntry>,
    /// `model_error`: what is known of the errors of the model.
    pub model_error: ModelErrors,
    /// `[coarser_mesh]`.
    pub coarser_mesh: Option<CoarserMeshEntry>,
    /// `[identify]`, or all `[[identify]]`.
    pub identify: Option<IdentifyEntry>,
    /// `[respond]`.
    pub respond: Option<RespondEntry>,
    /// `[solver]`.
    pub solver: SolverEntry,
}

impl CaseFile {
    /// What is unknown.
    pub(crate) fn unknowns(&self) -> impl Iterator<Item = &UnknownEntry> {
        self.identify.iter().flat_map(|entry| &entry.unknowns)
    }

    /// Refuses a name that no matrix has.
    ///
    /// # Errors
    /// The names that there are, and the nearest.
    pub(crate) fn has_matrices<'n>(
        &self,
        mut named: impl Iterator<Item = &'n Located<String>>,
    ) -> Result<(), InputError> {
        let known = || self.matrices.iter().map(|matrix| matrix.name.value.as_str());
        match named.find(|name| !known().any(|own| own == name.value)) {
            None => Ok(()),
            Some(Located { value, place }) => {
                let all = known().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
                let hint = nearest(value, known()).map(|name| format!("; did you mean {name:?}?"));
                let found = format!("{value:?}{}", hint.unwrap_or_default());
                Err(InputError::at(place, format!("a matrix of the case ({all})"), found))
            }
        }
    }
}

/// `[[matrix]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixEntry {
    /// Name.
    pub name: Located<String>,
    /// Role.
    pub role: Role,
    /// File of the matrix.
    pub file: Located<String>,
    /// Which matrix of the file, `file = { file = "model.op4", name = "K" }`; `None`: its only one.
    pub in_file: Option<Located<String>>,
    /// The files of the same matrix at several values of a dimension, of which `file` is the first; `None` where there is one file.
    pub at: Option<AtValues>,
    /// Factor, 1 where none is given.
    pub factor: Located<FactorEntry>,
    /// How well it is known, where the case says so.
    pub factor_std: Option<Located<FactorStd>>,
    /// Whether its factor is a modulus, where the case says; else it is relative to that of the matrix.
    pub factor_is_modulus: Option<bool>,
}

/// A matrix that is given at several values of a dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct AtValues {
    /// The dimension's name.
    pub dimension: Located<String>,
    /// Its values, each once, with the file of each.
    pub files: Vec<(f64, Located<String>)>,
    /// Its powers that are in the matrix, one fewer than values; `None`: 0, 1, 2 and so on.
    pub powers: Option<Located<Vec<i32>>>,
}

/// A factor: a law, or the file of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum FactorEntry {
    /// Number, complex modulus or another law.
    Law(Law),
    /// File of a table of modulus over frequency.
    Table(Located<String>),
}

/// A degree of freedom by its name or by its row.
#[derive(Debug, Clone, PartialEq)]
pub enum Spot {
    /// `dof = "12+Z"`.
    Dof(Located<DofName>),
    /// `row = 41`, from 1; not yet checked against the model.
    Row(Located<i64>),
}

/// `[[attached]]`: what is on the structure besides the model, at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct AttachedEntry {
    /// Where the table begins.
    pub place: Place,
    /// Where it is.
    pub spot: Spot,
    /// A point mass, as of an accelerometer or a hammer's tip.
    pub mass: Option<Amount>,
    /// In which directions of the node it moves; `None`: in all translations that the node has.
    pub directions: Option<Vec<Located<Axis>>>,
    /// A spring to ground.
    pub stiffness: Option<Amount>,
    /// A viscous damper to ground.
    pub damping: Option<Amount>,
}

/// `[load]`.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadEntry {
    /// Unit force at one degree of freedom.
    At(Spot),
    /// File of a load vector.
    File(Located<String>),
}

/// `[[measurement]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasurementEntry {
    /// Where the table begins.
    pub place: Place,
    /// File of the frequency response function.
    pub file: Option<Located<String>>,
    /// Where it was measured; `None`: as the file says.
    pub spot: Option<Spot>,
    /// Names of the columns of a table, in place of its own.
    pub columns: Option<Located<Vec<String>>>,
    /// Which FRF of a UFF file, from 1.
    pub record: Option<Located<i64>>,
    /// What was measured; `None`: as the file says.
    pub quantity: Option<Quantity>,
    /// What its values are to be multiplied by; `None`: one.
    pub scale: Option<Located<Calibration>>,
    /// By how much the channel is late, s; `None`: by nothing.
    pub delay_s: Option<Located<Calibration>>,
    /// Over how many records the coherence was averaged; `None`: not known.
    pub averages: Option<Located<i64>>,
    /// The decay rate α of an exponential window e^{−αt} on force and response, 1/s; `None`: as the file says.
    pub decay_per_s: Option<Located<f64>>,
    /// The window of random excitation; `None`: as the values show it.
    pub window: Option<Located<RandomWindow>>,
    /// The length of the records under it, s; `None`: 1 over the spacing of the lines.
    pub record_s: Option<f64>,
}

/// `window` of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RandomWindow {
    /// A Hann window, which leaks into neighbouring lines.
    Hann,
    /// None, or nothing that leaks: periodic or transient excitation.
    None,
}

impl FromStr for RandomWindow {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "hann" => Ok(Self::Hann),
            "none" => Ok(Self::None),
            _ => Err("\"hann\" or \"none\" (an exponential window is decay_per_s)".into()),
        }
    }
}

/// `scale` or `delay_s` of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Calibration {
    /// A scale is the value in SI units over that of the file, a delay in s.
    Known(f64),
    /// To be found.
    Unknown,
}

/// `[coarser_mesh]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CoarserMeshEntry {
    /// The case file of the same structure on a coarser mesh.
    pub file: Located<String>,
    /// How much longer its elements are; `None`: twice.
    pub element_ratio: Option<f64>,
    /// The order of the error of natural frequencies in the length of elements; `None`: 2.
    pub order: Option<f64>,
}

/// `[solver]`: what computes factors.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SolverEntry {
    /// Ranks of MUMPS, if they compute them.
    pub mumps: Option<MumpsEntry>,
}

/// How the ranks of MUMPS are started.
#[derive(Debug, Clone, PartialEq)]
pub struct MumpsEntry {
    /// Where the engine is named.
    pub place: Place,
    /// The launcher and its arguments.
    pub launch: String,
    /// The name of this machine, for a rank 0 on another one.
    pub host: Option<String>,
    /// A folder for factors that are kept on disk.
    pub out_of_core: Option<String>,
}

/// `[identify]`, or all `[[identify]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifyEntry {
    /// Where the first table begins.
    pub place: Place,
    /// What is unknown, at least one, names distinct.
    pub unknowns: Vec<UnknownEntry>,
    /// First and last frequency.
    pub band_hz: Option<Located<[f64; 2]>>,
    /// Frequencies and bands that are left out: no number of them is used.
    pub exclude: Located<Vec<Exclusion>>,
    /// Of more lines than this, those that show the unknowns best.
    pub max_lines: Option<Located<i64>>,
    /// Whether a sensor that contradicts all others is left out.
    pub reject_outliers: Option<bool>,
    /// Whether to look for what is wrong with the data.
    pub check: bool,
    /// Method.
    pub method: Option<Method>,
    /// Order.
    pub order: Option<Located<i64>>,
    /// Selection.
    pub selection: Option<Located<Selection>>,
    /// What answers at a frequency.
    pub reduction: Option<Reduction>,
    /// Where it says `start = "bounds"`.
    pub start: Option<Place>,
    /// Where the first thing stands that only a single unknown that varies can have.
    pub of_single: Option<Place>,
}

/// One `[[identify]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownEntry {
    /// Where it begins.
    pub place: Place,
    /// Its name; that of its matrices where none is given.
    pub name: Located<String>,
    /// Matrices that share the unknown factor; none for a dimension.
    pub matrices: Vec<Located<String>>,
    /// Matrices that a dimension multiplies, each with its power.
    pub powers: Vec<(Located<String>, i32)>,
    /// How it varies.
    pub varies: Located<Variation>,
    /// Whether it is real.
    pub real: bool,
    /// Value of a dimension to begin with; `None` of a factor.
    pub nominal: Option<Located<f64>>,
    /// `bounds.storage`, or `bounds` of a real one.
    pub storage: Option<Located<[f64; 2]>>,
    /// `bounds.loss_factor`.
    pub loss_factor: Option<Located<[f64; 2]>>,
    /// What a simulated measurement was made with.
    pub reference: Option<Located<FactorEntry>>,
}

/// What `exclude_hz` lists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exclusion {
    /// A frequency: the line there, or where it is between two lines, both.
    Line(f64),
    /// All lines from low to high, both included.
    Band([f64; 2]),
}

/// `[respond]`.
#[derive(Debug, Clone, PartialEq)]
pub struct RespondEntry {
    /// First and last frequency.
    pub band_hz: Located<[f64; 2]>,
    /// How many frequencies, equally spaced, both ends included.
    pub points: usize,
}
