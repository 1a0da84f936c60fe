//! What an output is to be, by the ending of its name.

use crate::error::{InputError, Place};
use frfit_formats::FileKind;
use std::fmt;
use std::path::Path;

/// What an output is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    MatrixMarket,
    /// With the matrix type that the ending names, such as `rsa`.
    HarwellBoeing(Option<[u8; 3]>),
    /// Nastran OUTPUT4.
    Op4,
    /// A sparse matrix of SciPy.
    Npz,
    /// MATLAB, version 5.
    Mat,
    Uff,
    Table,
}

const OF_MATRICES: &str = ".mtx or .mm (Matrix Market), .hb, .rb, .rsa, .rua, .csa, .cua, .psa or another matrix type (Harwell-Boeing), \
     .op4 (Nastran OUTPUT4), .npz (SciPy), .mat (MATLAB)";
const OF_FRFS: &str = ".uff, .unv or .uf (UFF), .csv (table)";

impl Target {
    /// By the ending of the output's name, or by one that is given in its place.
    pub(super) fn of(output: &Path, to: Option<&str>) -> Result<Self, InputError> {
        let (place, ending) = ending_of(output, to);
        let refuse = |found| {
            let expected = format!("an ending that names a format: {OF_MATRICES}, {OF_FRFS}{OR_TO}");
            Err(InputError::at(&place, expected, found))
        };
        let Some(ending) = ending else { return refuse("none".to_owned()) };
        match ending.as_bytes() {
            b"mtx" | b"mm" => Ok(Self::MatrixMarket),
            b"hb" | b"rb" => Ok(Self::HarwellBoeing(None)),
            &[values @ (b'r' | b'c' | b'p'), symmetry @ (b's' | b'u' | b'h' | b'z' | b'r'), b'a'] => {
                Ok(Self::HarwellBoeing(Some([values, symmetry, b'a'])))
            }
            b"op4" => Ok(Self::Op4),
            b"npz" => Ok(Self::Npz),
            b"mat" => Ok(Self::Mat),
            b"uff" | b"unv" | b"uf" => Ok(Self::Uff),
            b"csv" => Ok(Self::Table),
            _ => refuse(format!(".{ending}")),
        }
    }

    /// Refuses a Harwell–Boeing ending that names another matrix type than line 3 of the file does: programs that
    /// trust either would misread the other.
    pub(super) fn fits(self, written: &[u8], output: &Path) -> Result<(), InputError> {
        let Self::HarwellBoeing(Some(named)) = self else { return Ok(()) };
        let type_line = written.split(|&byte| byte == b'\n').nth(2).unwrap_or_default();
        let Some(kind) = type_line.first_chunk::<3>().filter(|kind| !kind.eq_ignore_ascii_case(&named))
        else {
            return Ok(());
        };
        let shown = |letters: &[u8]| String::from_utf8_lossy(letters).to_ascii_lowercase();
        let expected = format!("the ending .{} of what the matrix is, or .hb", shown(kind));
        Err(InputError::at(&Place::file(output), expected, format!(".{}", shown(&named))))
    }
}

/// What else can be said where a name has no ending.
pub(crate) const OR_TO: &str = "; or --to with one, for a name without (standard output, a device)";

/// The ending that says the format of an output, and where it stands.
pub(crate) fn ending_of(output: &Path, to: Option<&str>) -> (Place, Option<String>) {
    match to {
        Some(to) => (Place::option("--to"), Some(to.strip_prefix('.').unwrap_or(to).to_ascii_lowercase())),
        None => {
            let ending = output.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
            (Place::file(output), ending)
        }
    }
}

/// The endings to which a file of this kind can be converted.
pub(super) fn endings_for(kind: FileKind) -> String {
    let endings = match kind {
        kind if kind.may_name_rows() => format!("{OF_MATRICES}, .csv (the names of the rows)"),
        kind if kind.holds_matrices() => OF_MATRICES.into(),
        FileKind::Lvm => "none: frfit frf makes an FRF of time records".into(),
        _ => OF_FRFS.into(),
    };
    format!("an ending to which {kind} can be converted: {endings}")
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MatrixMarket | Self::HarwellBoeing(_) | Self::Op4 | Self::Npz | Self::Mat => "a matrix",
            Self::Uff | Self::Table => "an FRF",
        })
    }
}
