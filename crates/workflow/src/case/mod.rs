//! A case file as it is written: read, every key and type checked, no other file opened.

mod document;
mod field;
mod keys;
mod parse;
mod reference;
mod sections;
mod several;
mod snippet;

pub(crate) use parse::law_of_snippet;
pub use parse::parse;
pub use reference::reference;
pub(crate) use sections::checked_band;
pub use snippet::snippet;

use crate::error::Place;
use crate::units::{Amount, UnitSystem};
use frfit::dof::{Axis, DofName};
use frfit::identify::{Method, ModelErrors, Reduction, Selection, Variation};
use frfit::laws::LawKind;
use frfit::material::Law;
use frfit::model::{FactorStd, Role};
use frfit::quantity::Quantity;
use std::path::PathBuf;

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
    /// `[identify]`, of one unknown that varies.
    pub identify: Option<IdentifyEntry>,
    /// `[[identify]]`: several unknowns, or one that does not vary.
    pub several: Option<SeveralEntry>,
    /// `[respond]`.
    pub respond: Option<RespondEntry>,
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
    /// Which FRF of a UFF file, from 1.
    pub record: Option<Located<i64>>,
    /// What was measured; `None`: as the file says.
    pub quantity: Option<Quantity>,
    /// What its values are to be multiplied by; `None`: one.
    pub scale: Option<Located<Calibration>>,
    /// By how much the channel is late, s; `None`: by nothing.
    pub delay_s: Option<Located<Calibration>>,
    /// Over how many records the coherence was averaged; `None`: not told.
    pub averages: Option<Located<i64>>,
    /// The decay rate α of an exponential window e^{−αt} on force and response, 1/s; `None`: as the file says.
    pub decay_per_s: Option<Located<f64>>,
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

/// `[identify]`.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifyEntry {
    /// Where the table begins.
    pub place: Place,
    /// Matrices that share the unknown factor, at least one.
    pub matrices: Vec<Located<String>>,
    /// First and last frequency.
    pub band_hz: Option<Located<[f64; 2]>>,
    /// Frequencies and bands that are left out: no number of them is used.
    pub exclude: Vec<Exclusion>,
    /// Of more lines than this those that tell most.
    pub max_lines: Option<Located<i64>>,
    /// How the factor varies, where that is said; the place is that of `varies`.
    pub varies: Option<Located<VariesEntry>>,
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
    /// `bounds.storage`.
    pub storage: Option<Located<[f64; 2]>>,
    /// `bounds.loss_factor`.
    pub loss_factor: Option<Located<[f64; 2]>>,
    /// Whether the factor is real.
    pub real: bool,
    /// Whether a sensor that contradicts all others is left out.
    pub reject_outliers: Option<bool>,
    /// Whether to look for what is wrong with the data first.
    pub check: bool,
    /// The factor that a simulated measurement was made with.
    pub reference: Option<Located<FactorEntry>>,
}

/// How the factor varies over frequency: `varies`, with `law` and `branches`.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum VariesEntry {
    /// Anyhow: one of its own at each frequency.
    #[default]
    PerFrequency,
    /// Smoothly.
    Smoothly,
    /// By one of these laws, which are to be compared.
    ByLaw(Vec<LawKind>),
}

impl From<VariesEntry> for Variation {
    fn from(varies: VariesEntry) -> Self {
        match varies {
            VariesEntry::PerFrequency => Self::PerFrequency,
            VariesEntry::Smoothly => Self::Smooth,
            VariesEntry::ByLaw(kinds) => Self::Law(kinds),
        }
    }
}

impl VariesEntry {
    /// What the word alone says: `law` all laws.
    ///
    /// # Errors
    /// The words that there are.
    pub(crate) fn of_word(word: &str) -> Result<Self, String> {
        match word {
            "frequency" => Ok(Self::PerFrequency),
            "smooth" => Ok(Self::Smoothly),
            "law" => Ok(Self::ByLaw(LawKind::ALL.to_vec())),
            _ => Err("\"frequency\" (a factor of its own at each), \"smooth\" or \"law\"".into()),
        }
    }
}

/// All `[[identify]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct SeveralEntry {
    /// Where the first begins.
    pub place: Place,
    /// Each of them, at least one, names distinct.
    pub unknowns: Vec<UnknownEntry>,
    /// First and last frequency.
    pub band_hz: Option<Located<[f64; 2]>>,
    /// Frequencies and bands that are left out.
    pub exclude: Vec<Exclusion>,
    /// Of more lines than this those that tell most.
    pub max_lines: Option<Located<i64>>,
    /// Whether a sensor that contradicts all others is left out.
    pub reject_outliers: Option<bool>,
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
    pub varies: UnknownVaries,
    /// Whether it is real.
    pub real: bool,
    /// Value of a dimension to begin with.
    pub nominal: Option<Located<f64>>,
    /// `bounds.storage`, or `bounds` of a real one.
    pub storage: Option<Located<[f64; 2]>>,
    /// `bounds.loss_factor`.
    pub loss_factor: Option<Located<[f64; 2]>>,
    /// What a simulated measurement was made with.
    pub reference: Option<Located<FactorEntry>>,
}

/// How one of several unknowns varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnknownVaries {
    /// A value of its own at each frequency.
    PerFrequency,
    /// One value for the band.
    Constant,
    /// By a law.
    ByLaw(LawKind),
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
