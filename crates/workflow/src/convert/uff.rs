//! A UFF file.

use super::options::ConvertOptions;
use super::precision::{written, written_evenly_or_not};
use crate::error::{InputError, Place};
use crate::load::{Frf, STD_LABEL, decay_line, read_frf};
use frfit::c64;
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::uff::{
    Axis, DataType, Dof, File, Form, Function, FunctionHeader, FunctionType, Quantity as Kind, Units, Values,
    write,
};
use frfit_formats::{FormatError, Position};
use std::path::Path;

/// All datasets: functions written again, the others byte for byte. With `records` (from 1) of the functions those FRFs, and the records between the same degrees
/// of freedom: coherence, standard deviation.
pub(super) fn rewritten(bytes: &[u8], records: &[i64], form: Form) -> Result<Vec<u8>, FormatError> {
    let file = File::new(bytes)?;
    let chosen = match records {
        [] => None,
        _ => Some(chosen(&file, records)?),
    };
    let mut out = Vec::new();
    for (index, entry) in file.entries().iter().enumerate() {
        if entry.dataset == 58 && chosen.as_ref().is_some_and(|chosen| !chosen.contains(&index)) {
            continue;
        }
        if entry.dataset != 58 {
            out.extend_from_slice(bytes.get(entry.bytes.clone()).unwrap_or_default());
            // The last line of a file may have no end.
            if !out.ends_with(b"\n") {
                out.push(b'\n');
            }
            continue;
        }
        let line = entry.line;
        let function = file.function(index)?;
        let (points, missing) = (function.header.points, function.missing_points());
        if missing > 0 {
            let (expected, found) = (format!("{points} points, as the header says"), points - missing);
            return Err(FormatError::line(line, expected, found.to_string()));
        }
        let at_line = |error| FormatError { position: Position::Line { line, column: None }, ..error };
        out.extend(written(&function, form).map_err(at_line)?);
    }
    Ok(out)
}

/// The datasets of the FRFs with these numbers, and of the other functions between their degrees of freedom.
fn chosen(file: &File<'_>, records: &[i64]) -> Result<Vec<usize>, FormatError> {
    let mut headers = Vec::new();
    for index in file.functions() {
        headers.push((index, file.function_header(index)?));
    }
    let is_frf = |header: &FunctionHeader| header.function_type == FunctionType::FrequencyResponse;
    let frfs: Vec<_> = headers.iter().filter(|(_, header)| is_frf(header)).collect();
    let mut chosen = Vec::new();
    for &record in records {
        let at = usize::try_from(record).ok().and_then(|number| frfs.get(number.checked_sub(1)?));
        let refuse = || FormatError::whole(format!("--record from 1 to {}", frfs.len()), record.to_string());
        let (index, frf) = at.ok_or_else(refuse)?;
        let beside = headers.iter().filter(|(_, other)| {
            !is_frf(other) && (&other.response, &other.reference) == (&frf.response, &frf.reference)
        });
        chosen.extend(beside.map(|(index, _)| *index).chain([*index]));
    }
    Ok(chosen)
}

/// The FRF of a table, its coherence and its standard deviation as functions of their own, in SI units.
pub(super) fn of_table(bytes: &[u8], input: &Path, options: &ConvertOptions) -> Result<Vec<u8>, InputError> {
    let needs = |name, expected: &str| InputError::at(&Place::option(name), expected, "none");
    let quantity = options
        .quantity
        .ok_or_else(|| needs("--quantity", "receptance, mobility or accelerance: the table does not say"))?;
    let response = options
        .response
        .ok_or_else(|| needs("--response", "where it was measured, such as 34+Z: the table does not say"))?;
    let reference = options
        .reference
        .ok_or_else(|| needs("--reference", "where it was driven, such as 12+Z: the table does not say"))?;
    let in_input = |error| InputError::in_file(input, error);
    let frf = read_frf(bytes, &options.of_columns()).map_err(in_input)?;
    let decay = frf.decay_per_s.map(decay_line).unwrap_or_default();
    let header = FunctionHeader {
        id: [name(input), String::new(), decay, String::new(), String::new()],
        response: dof(response, "--response")?,
        reference: dof(reference, "--reference")?,
        ..FunctionHeader::default()
    };
    datasets(frf, header, quantity, options.form()).map_err(in_input)
}

/// Units, FRF, coherence, standard deviation.
fn datasets(
    frf: Frf,
    header: FunctionHeader,
    quantity: Quantity,
    form: Form,
) -> Result<Vec<u8>, FormatError> {
    let Frf { frequency_hz, response, coherence, std, .. } = frf;
    let mut out = write::units(&Units::default())?;
    out.extend(frf_dataset(&frequency_hz, response, header.clone(), quantity, form)?);
    if let Some(coherence) = coherence {
        out.extend(companion(&frequency_hz, coherence, header.clone(), FunctionType::Coherence, form)?);
    }
    if let Some(std) = std {
        out.extend(companion(&frequency_hz, std, header, FunctionType::General, form)?);
    }
    Ok(out)
}

/// One FRF in SI units; the header says where it was measured and driven.
pub(crate) fn frf_dataset(
    frequency_hz: &[f64],
    response: Vec<c64>,
    header: FunctionHeader,
    quantity: Quantity,
    form: Form,
) -> Result<Vec<u8>, FormatError> {
    let (ordinate, unit) = match quantity {
        Quantity::Receptance => (Kind::Displacement, "m"),
        Quantity::Mobility => (Kind::Velocity, "m/s"),
        Quantity::Accelerance => (Kind::Acceleration, "m/s^2"),
    };
    let header = FunctionHeader {
        abscissa: axis(Kind::Frequency, "Frequency", "Hz"),
        ordinate: axis(ordinate, quantity.name(), unit),
        denominator: axis(Kind::ExcitationForce, "Force", "N"),
        ..header
    };
    let frf = Function::new(header, frequency_hz.to_vec(), Values::Complex(response));
    written_evenly_or_not(&frf, form)
}

/// What is known of an FRF beside its values, between the same degrees of freedom: its coherence, or as a general function its
/// standard deviation.
pub(crate) fn companion(
    frequency_hz: &[f64],
    values: Vec<f64>,
    header: FunctionHeader,
    function_type: FunctionType,
    form: Form,
) -> Result<Vec<u8>, FormatError> {
    let label = if function_type == FunctionType::Coherence { "Coherence" } else { STD_LABEL };
    let header = FunctionHeader {
        function_type,
        data_type: DataType::RealDouble,
        abscissa: axis(Kind::Frequency, "Frequency", "Hz"),
        ordinate: axis(Kind::Unknown, label, ""),
        ..header
    };
    let function = Function::new(header, frequency_hz.to_vec(), Values::Real(values));
    written_evenly_or_not(&function, form)
}

/// The name of the input, as far as an ID line has room for it.
fn name(input: &Path) -> String {
    let name = input.file_name().unwrap_or_default().to_string_lossy();
    name.chars().filter(|c| !c.is_control()).take(80).collect()
}

fn axis(quantity: Kind, label: &str, unit: &str) -> Axis {
    Axis { quantity, label: label.into(), unit: unit.into(), ..Axis::default() }
}

/// A node label has ten columns.
fn dof(name: DofName, option: &str) -> Result<Dof, InputError> {
    match i64::try_from(name.node) {
        Ok(node) if node < 10_000_000_000 => {
            Ok(Dof { node, direction: name.uff_direction(), ..Dof::default() })
        }
        _ => Err(InputError::at(&Place::option(option), "a node of at most ten digits", name.to_string())),
    }
}
