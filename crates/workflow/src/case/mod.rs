//! A case file as it is written: read, every key and type checked, no other file opened.

mod document;
mod edited;
mod entries;
mod field;
mod identify;
mod keys;
mod launcher;
mod parse;
mod reference;
mod sections;
mod snippet;

pub(crate) use edited::{Edit, edited};
pub use entries::{
    AtValues, AttachedEntry, Calibration, CaseFile, CoarserMeshEntry, Exclusion, FactorEntry, IdentifyEntry,
    LoadEntry, Located, MatrixEntry, MeasurementEntry, MumpsEntry, RandomWindow, RespondEntry, SolverEntry,
    Spot, UnknownEntry,
};
pub(crate) use identify::variation;
pub(crate) use launcher::DEFAULT as DEFAULT_LAUNCH;
pub(crate) use parse::law_of_snippet;
pub use parse::parse;
pub use reference::reference;
pub(crate) use sections::{are_powers, check_values, checked_band, expected_powers};
pub use snippet::{law_keys, snippet};
