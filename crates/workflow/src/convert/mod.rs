//! From one format to another: matrices to matrices, FRFs to FRFs.

mod options;
mod precision;
mod table;
mod target;
mod uff;

pub use options::ConvertOptions;
pub(crate) use uff::{companion, frf_dataset};

use crate::error::{InputError, Place};
use crate::inspect::unknown_kind;
use crate::load::{load_bytes, matrices_of};
use frfit_formats::{
    CoordinateMatrix, FileKind, FormatError, Labels, choose, csv, detect, harwell_boeing, matrix_market,
};
use std::path::Path;
use target::Target;

/// What can be converted.
const CONVERTED: &str =
    "a UFF file, a matrix (Matrix Market, Harwell-Boeing, CalculiX, Abaqus, Nastran DMIG) or a table (CSV)";

/// The bytes of the output: what the input is, its content says, what the output is to be, its ending.
///
/// | from | to | what is kept |
/// |---|---|---|
/// | Matrix Market, Harwell–Boeing | either | every value bit for bit; of a title what the format has room for |
/// | CalculiX, Abaqus, Nastran DMIG | Matrix Market, Harwell–Boeing | every value bit for bit |
/// | the same, Harwell–Boeing with a mapping | table | what each row stands for: the file of `[dofs]` |
/// | UFF | UFF | all datasets: the functions (58) anew as text or binary, the others byte for byte |
/// | UFF | table | one FRF, bit for bit, and its coherence and standard deviation if the file has them |
/// | table | UFF | the FRF, its coherence and standard deviation: bit for bit in binary, 13 digits of a value in text |
/// | table | table | the FRF, sorted by frequency |
///
/// # Errors
/// An ending that names no format, or not one of matrices for a matrix, nor one of FRFs for an FRF; an option that
/// is missing or has no meaning here; whatever the reader or the writer refuses; frequencies that the text of a UFF
/// file would blur.
pub fn convert(input: &Path, output: &Path, options: &ConvertOptions) -> Result<Vec<u8>, InputError> {
    let target = Target::of(output)?;
    let bytes = load_bytes(input)?;
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let kind = detect(&bytes).ok_or_else(|| unknown_kind(input, &bytes, CONVERTED))?;
    match (kind, target) {
        (kind, Target::MatrixMarket | Target::HarwellBoeing(_)) if kind.holds_matrices() => {
            options.only(&["--name"], "a matrix")?;
            let (matrix, _) = matrix_of(input, &bytes, options)?;
            let write = match target {
                Target::MatrixMarket => matrix_market::write,
                _ => harwell_boeing::write,
            };
            let written = write(&matrix).map_err(in_input)?;
            target.fits(&written, output)?;
            Ok(written)
        }
        (kind, Target::Table) if kind.holds_matrices() && kind != FileKind::MatrixMarket => {
            options.only(&["--name"], "the names of rows")?;
            let (_, labels) = matrix_of(input, &bytes, options)?;
            names_of_rows(&labels).map_err(in_input)
        }
        (FileKind::Uff, Target::Uff) => {
            options.only(&["--binary"], "a whole UFF file")?;
            uff::rewritten(&bytes, options.form()).map_err(in_input)
        }
        (FileKind::Uff, Target::Table) => {
            options.only(&["--record", "--quantity", "--response", "--reference"], "a table")?;
            table::of_uff(&bytes, options, in_input)
        }
        (FileKind::Csv, Target::Table) => {
            options.only(&[], "a table made of a table")?;
            table::of_table(&bytes).map_err(in_input)
        }
        (FileKind::Csv, Target::Uff) => {
            options.only(&["--quantity", "--response", "--reference", "--binary"], "a table of one FRF")?;
            uff::of_table(&bytes, input, options)
        }
        (kind, target) => {
            let place = Place::file(output);
            Err(InputError::at(&place, target::endings_for(kind), format!("the ending of {target}")))
        }
    }
}

/// The matrix that is meant, and what its rows stand for.
fn matrix_of(
    input: &Path,
    bytes: &[u8],
    options: &ConvertOptions,
) -> Result<(CoordinateMatrix, Labels), InputError> {
    let all = matrices_of(input, bytes)?;
    let in_input = |error: FormatError| InputError::in_file(input, error);
    let chosen = choose(&all, options.name.as_deref()).map_err(|error| match options.name {
        Some(_) => InputError::at(&Place::option("--name"), error.expected, error.found),
        None => InputError::at(&Place::file(input), "one matrix, or --name", error.found),
    })?;
    Ok((chosen.matrix.clone().map_err(in_input)?, chosen.labels.clone()))
}

/// A table of row, node and direction, which `[dofs]` reads; rows without a direction, or at a node of the solver's own,
/// are not in it.
fn names_of_rows(labels: &Labels) -> Result<Vec<u8>, FormatError> {
    let named = labels.rows.iter().enumerate().filter(|(_, label)| label.node > 0);
    let rows: Vec<_> = named
        .filter_map(|(row, label)| Some((row, usize::try_from(label.node).ok()?, label.direction()?)))
        .map(|(row, node, direction)| {
            [csv::Cell::Count(row + 1), csv::Cell::Count(node), csv::Cell::Text(direction.name())]
        })
        .collect();
    if rows.is_empty() {
        let expected = "a file that names its rows (or has a .dof or .mapping file beside it)";
        return Err(FormatError::whole(expected, "no names"));
    }
    csv::write(&["row", "node", "direction"], rows).map(String::into_bytes)
}
