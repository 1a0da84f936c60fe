//! What kind of file this is, by its content.

use std::fmt;

use crate::text::Lines;
use crate::{
    CoordinateMatrix, FormatError, Labels, NamedMatrix, abaqus, dmig, harwell_boeing, lvm, mat,
    matrix_market, numpy, op4, take_matrix, triplets,
};

/// The kinds of files this crate reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// Matrix Market: read it with [`matrix_market::read`].
    MatrixMarket,
    /// Harwell–Boeing: read it with [`harwell_boeing::read`].
    HarwellBoeing,
    /// A list of row, column and value, of CalculiX or Abaqus: read it with [`triplets::read`].
    Triplets,
    /// A matrix of Abaqus with labels: read it with [`abaqus::read`].
    Abaqus,
    /// Nastran DMIG cards: read them with [`dmig::read`].
    Dmig,
    /// Nastran OUTPUT4: read it with [`op4::read`].
    Op4,
    /// NumPy's arrays, and SciPy's sparse matrices: read it with [`numpy::read`].
    Numpy,
    /// MATLAB's variables: read it with [`mat::read`].
    Mat,
    /// Universal File Format: read it with [`uff`](crate::uff).
    Uff,
    /// A table with named columns: read it with [`csv::Table::read`](crate::csv::Table::read).
    Csv,
    /// A LabVIEW measurement file: read it with [`lvm::read`].
    Lvm,
}

/// The formats of matrices, as errors list them.
pub const MATRIX_FORMATS: &str =
    "Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG, Nastran OUTPUT4, NumPy, MATLAB";

impl FileKind {
    /// Whether its rows may have [labels](crate::Labels), in the file or in one beside it.
    #[must_use]
    pub fn may_name_rows(self) -> bool {
        matches!(self, Self::HarwellBoeing | Self::Triplets | Self::Abaqus | Self::Dmig)
    }

    /// Whether [`read_matrices`] reads it.
    #[must_use]
    pub fn holds_matrices(self) -> bool {
        match self {
            Self::MatrixMarket | Self::HarwellBoeing | Self::Triplets | Self::Abaqus | Self::Dmig => true,
            Self::Op4 | Self::Numpy | Self::Mat => true,
            Self::Uff | Self::Csv | Self::Lvm => false,
        }
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MatrixMarket => "a Matrix Market file",
            Self::HarwellBoeing => "a Harwell-Boeing file",
            Self::Triplets => "a list of row, column and value (CalculiX, Abaqus)",
            Self::Abaqus => "a matrix of Abaqus",
            Self::Dmig => "Nastran DMIG cards",
            Self::Op4 => "a Nastran OUTPUT4 file",
            Self::Numpy => "a NumPy file (.npy, .npz)",
            Self::Mat => "a MATLAB file (.mat)",
            Self::Uff => "a Universal File Format (UFF) file",
            Self::Csv => "a table (CSV)",
            Self::Lvm => "a LabVIEW measurement file",
        })
    }
}

/// The kind of a file by its content, not by its ending; `None` where it looks like none of them.
///
/// Only the first lines are looked at (and for DMIG cards, which may stand anywhere, the begin of each): a file of a
/// known kind may still be broken.
#[must_use]
pub fn detect(bytes: &[u8]) -> Option<FileKind> {
    if numpy::looks_like(bytes) {
        return Some(FileKind::Numpy);
    }
    if mat::looks_like(bytes) {
        return Some(FileKind::Mat);
    }
    let mut lines = Lines::new(bytes);
    if matrix_market::is_banner(lines.clone().next()?.bytes) {
        return Some(FileKind::MatrixMarket);
    }
    if lvm::is_first_line(lines.clone().next()?.bytes) {
        return Some(FileKind::Lvm);
    }
    if harwell_boeing::looks_like(bytes) {
        return Some(FileKind::HarwellBoeing);
    }
    if lines.clone().find(|line| !line.is_blank())?.bytes.trim_ascii() == b"-1" {
        return Some(FileKind::Uff);
    }
    let first = lines.clone().find(|line| !line.is_blank() && triplets::comment(*line).is_none());
    if first.is_some_and(triplets::is_entry) {
        return Some(FileKind::Triplets);
    }
    if first.is_some_and(abaqus::is_first_line) {
        return Some(FileKind::Abaqus);
    }
    // Behind Abaqus, whose entry in columns of eight would be a header with a number for a name; behind
    // Harwell-Boeing, whose first line may be anything.
    if op4::looks_like(bytes) {
        return Some(FileKind::Op4);
    }
    if dmig::looks_like(bytes) {
        return Some(FileKind::Dmig);
    }
    let names = lines.find(|line| !line.is_blank() && !line.bytes.trim_ascii().starts_with(b"#"))?;
    let is_text = std::str::from_utf8(names.bytes).is_ok() && !names.bytes.contains(&0);
    let has_delimiter = names.bytes.iter().any(|b| b",;\t".contains(b));
    (is_text && has_delimiter).then_some(FileKind::Csv)
}

/// Reads a file of one matrix, of any kind.
///
/// # Errors
/// As [`read_matrices`]; a file of several.
pub fn read_matrix(bytes: &[u8]) -> Result<CoordinateMatrix, FormatError> {
    take_matrix(read_matrices(bytes)?, None)?.matrix
}

/// Reads all matrices of a file, in its order. [`choose_matrix`](crate::choose_matrix) finds one by its name.
///
/// # Errors
/// What the reader of the kind says, or what the file is where it holds no matrices.
pub fn read_matrices(bytes: &[u8]) -> Result<Vec<NamedMatrix>, FormatError> {
    let unnamed = |matrix, labels| vec![NamedMatrix { labels, ..NamedMatrix::plain("", Ok(matrix)) }];
    let one = |matrix| unnamed(matrix, Labels::default());
    match detect(bytes) {
        Some(FileKind::MatrixMarket) => matrix_market::read(bytes).map(one),
        Some(FileKind::HarwellBoeing) => harwell_boeing::read(bytes).map(one),
        Some(FileKind::Triplets) => triplets::read(bytes).map(one),
        Some(FileKind::Abaqus) => abaqus::read(bytes).map(|(matrix, labels)| unnamed(matrix, labels)),
        Some(FileKind::Dmig) => dmig::read(bytes),
        Some(FileKind::Op4) => op4::read(bytes),
        Some(FileKind::Numpy) => numpy::read(bytes),
        Some(FileKind::Mat) => mat::read(bytes),
        other => Err(FormatError::whole(
            format!("a matrix ({MATRIX_FORMATS})"),
            match other {
                Some(kind) => kind.to_string(),
                None if bytes.is_empty() => "an empty file".into(),
                None => "none of them (no %%MatrixMarket, OUTPUT4 header or entry in line 1, no matrix type such as RSA \
                         in line 3, no DMIG card)"
                    .into(),
            },
        )),
    }
}
