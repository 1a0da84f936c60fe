//! An FRF as a table.

use super::options::ConvertOptions;
use crate::error::{InputError, Place};
use crate::load::{Frf, decay_line, read_frf};
use frfit::dof::DofName;
use frfit_formats::FormatError;
use frfit_formats::csv::{Cell, write};
use frfit_formats::uff::{Dof, File, FunctionType, Values};

/// One FRF of a UFF file, with its coherence if the file has it.
pub(super) fn of_uff(
    bytes: &[u8],
    options: &ConvertOptions,
    in_input: impl Fn(FormatError) -> InputError,
) -> Result<Vec<u8>, InputError> {
    let choice = options.of_uff()?;
    let mut frf = read_frf(bytes, &choice).map_err(&in_input)?;
    if let (Some(wanted), Some(there)) = (options.quantity, frf.quantity)
        && wanted != there
    {
        let expected = format!("{there}, as the file says (values are not converted)");
        return Err(InputError::at(&Place::option("--quantity"), expected, wanted.to_string()));
    }
    frf.coherence = coherence(bytes, &frf).map_err(&in_input)?;
    written(&frf).map_err(in_input)
}

/// The FRF of a table, sorted by frequency, with commas.
pub(super) fn of_table(bytes: &[u8], options: &ConvertOptions) -> Result<Vec<u8>, FormatError> {
    written(&read_frf(bytes, &options.of_columns())?)
}

fn written(frf: &Frf) -> Result<Vec<u8>, FormatError> {
    let optional = [("coherence", &frf.coherence), ("std", &frf.std)];
    let optional: Vec<_> =
        optional.into_iter().filter_map(|(name, values)| Some((name, values.as_ref()?))).collect();
    let columns: Vec<&str> =
        ["frequency_hz", "re", "im"].into_iter().chain(optional.iter().map(|(name, _)| *name)).collect();
    let rows = frf.frequency_hz.iter().zip(&frf.response).enumerate().map(|(k, (&frequency_hz, value))| {
        let more = optional.iter().map(|(_, values)| values.get(k).copied());
        [frequency_hz, value.re, value.im]
            .into_iter()
            .map(Some)
            .chain(more)
            .map(Cell::from)
            .collect::<Vec<_>>()
    });
    let table = write(&columns, rows)?;
    Ok(windowed(frf.decay_per_s, table).into_bytes())
}

/// A table of an FRF, with what is known of its window in a comment line before it.
pub(crate) fn windowed(decay_per_s: Option<f64>, table: String) -> String {
    match decay_per_s {
        Some(decay_per_s) => format!("# {}\n{table}", decay_line(decay_per_s)),
        None => table,
    }
}

/// The coherence between response and reference of an FRF at its frequencies: the only one in the file, with
/// values from 0 to 1. `None` where there is no such function.
fn coherence(bytes: &[u8], frf: &Frf) -> Result<Option<Vec<f64>>, FormatError> {
    let file = File::new(bytes)?;
    let dof = |dof: &Dof| DofName::from_uff(u64::try_from(dof.node).ok()?, dof.direction);
    let mut found = None;
    for index in file.functions() {
        let header = file.function_header(index)?;
        let ends = (dof(&header.response), dof(&header.reference));
        let is_coherence = header.function_type == FunctionType::Coherence;
        if !is_coherence || ends != (frf.measured_at, frf.driven_at) || ends.0.is_none() {
            continue;
        }
        let function = file.function(index)?;
        let Values::Real(values) = function.values else { continue };
        if function.abscissa != frf.frequency_hz || !values.iter().all(|x| (0.0..=1.0).contains(x)) {
            continue;
        }
        if found.replace(values).is_some() {
            return Ok(None);
        }
    }
    Ok(found)
}
