//! From one format to another: matrices to matrices, FRFs to FRFs.

mod matrices;
mod options;
mod precision;
mod table;
mod target;
mod uff;

pub use options::ConvertOptions;
pub(crate) use table::windowed;
pub(crate) use target::{OR_TO, ending_of};
pub(crate) use uff::{companion, frf_dataset};

use crate::error::{InputError, Place};
use crate::inspect::unknown_kind;
use crate::load::{load_bytes, matrices_of};
use crate::reads::Reads;
use frfit_formats::{FileKind, FormatError, detect, harwell_boeing, matrix_market, numpy, read_matrices};
use std::path::Path;
use target::Target;

/// The bytes of the output: what the input is, its content says, what the output is to be, its ending.
///
/// | from | to | what is kept |
/// |---|---|---|
/// | Matrix Market, Harwell–Boeing | either | every value bit for bit; of a title what the format has room for |
/// | CalculiX, Abaqus, Nastran DMIG and OUTPUT4, NumPy, MATLAB | Matrix Market, Harwell–Boeing | one matrix, every value bit for bit |
/// | any of these | SciPy (.npz) | one matrix, every value bit for bit, both triangles |
/// | any of these | MATLAB | all matrices, or one, every value bit for bit, both triangles |
/// | any of these | Nastran OUTPUT4 | all matrices, or one, every value bit for bit but for the sign of zeros; of names eight letters and digits |
/// | Harwell–Boeing, CalculiX, Abaqus, Nastran DMIG | table | what each row stands for, as the file or the one beside it says: the file of `[dofs]` |
/// | UFF | UFF | all datasets, or of the functions chosen FRFs with those between the same degrees of freedom: the functions (58) written again as text or binary, the others byte for byte |
/// | UFF | table | one FRF, bit for bit, and its coherence and standard deviation if the file has them |
/// | table | UFF | the FRF, its coherence and standard deviation: bit for bit in binary, 13 digits of a value in text |
/// | table | table | the FRF, sorted by frequency |
///
/// # Errors
/// An ending that names no format, or not one of matrices for a matrix, nor one of FRFs for an FRF; an option that
/// is missing or has no meaning here; whatever the reader or the writer refuses; frequencies that the text of a UFF
/// file would blur.
pub fn convert(
    input: &Path,
    output: &Path,
    options: &ConvertOptions,
    reads: &mut Reads,
) -> Result<Vec<u8>, InputError> {
    let target = Target::of(output, options.to.as_deref())?;
    let bytes = load_bytes(input, reads)?;
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let kind = match options.columns {
        // Rows of three numbers may be a matrix too.
        Some(_) => FileKind::Csv,
        None => detect(&bytes).ok_or_else(|| unknown_kind(input, &bytes, "a table (CSV)"))?,
    };
    match (kind, target) {
        (kind, Target::Op4 | Target::Mat) if kind.holds_matrices() => {
            options.only(&["--name"], "a matrix")?;
            let all = read_matrices(&bytes).map_err(in_input)?;
            match target {
                Target::Op4 => matrices::written(input, all, options, &matrices::NASTRAN),
                _ => matrices::written(input, all, options, &matrices::MATLAB),
            }
        }
        (kind, Target::MatrixMarket | Target::HarwellBoeing(_) | Target::Npz) if kind.holds_matrices() => {
            options.only(&["--name"], "a matrix")?;
            let all = read_matrices(&bytes).map_err(in_input)?;
            let matrix = matrices::one(input, all, options)?.matrix.map_err(in_input)?;
            let write = match target {
                Target::MatrixMarket => matrix_market::write,
                Target::Npz => numpy::write_sparse,
                _ => harwell_boeing::write,
            };
            let written = write(&matrix).map_err(in_input)?;
            target.fits(&written, output)?;
            Ok(written)
        }
        (kind, Target::Table) if kind.may_name_rows() => {
            options.only(&["--name"], "the names of rows")?;
            let one = matrices::one(input, matrices_of(input, &bytes, reads)?, options)?;
            matrices::names_of_rows(&one.labels).map_err(in_input)
        }
        (FileKind::Uff, Target::Uff) => {
            options.only(&["--record", "--binary"], "a UFF file")?;
            uff::rewritten(&bytes, &options.records, options.form()).map_err(in_input)
        }
        (FileKind::Uff, Target::Table) => {
            options.only(&["--record", "--quantity", "--response", "--reference"], "a table")?;
            table::of_uff(&bytes, options, in_input)
        }
        (FileKind::Csv, Target::Table) => {
            options.only(&["--columns"], "a table made of a table")?;
            table::of_table(&bytes, options).map_err(in_input)
        }
        (FileKind::Csv, Target::Uff) => {
            let meant = ["--columns", "--quantity", "--response", "--reference", "--binary"];
            options.only(&meant, "a table of one FRF")?;
            uff::of_table(&bytes, input, options)
        }
        (kind, target) => {
            let place = Place::file(output);
            Err(InputError::at(&place, target::endings_for(kind), format!("the ending of {target}")))
        }
    }
}
