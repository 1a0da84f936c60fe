//! What the command line says.

use std::path::PathBuf;

/// What the command line says in place of the case file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overrides {
    /// In place of `identify.method`.
    pub method: Option<String>,
    /// In place of `identify.order`.
    pub order: Option<usize>,
    /// In place of `identify.band_hz` or `respond.band_hz`.
    pub band_hz: Option<[f64; 2]>,
    /// In place of `identify.selection`.
    pub selection: Option<String>,
    /// In place of `identify.reduction`.
    pub reduction: Option<String>,
    /// A file with a reduced model that was trained already.
    pub reduced: Option<PathBuf>,
    /// A table of results: its moduli in place of the factors of the unknown matrices.
    pub identified: Option<PathBuf>,
    /// In place of `solver.engine`.
    pub engine: Option<String>,
    /// In place of `solver.launch`; any command.
    pub launch: Option<String>,
}
