//! One FRF of a UFF file.

use super::frf::{Choice, Frf};
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit_formats::uff::{self, File, FunctionHeader, FunctionType, Record, Values};
use frfit_formats::{FormatError, uff::Quantity as Axis};

/// Reads the FRF of a choice.
pub(super) fn read(bytes: &[u8], choice: &Choice) -> Result<Frf, FormatError> {
    let file = File::new(bytes)?;
    let frfs = frfs(&file)?;
    let (index, header) = &frfs[chosen(&frfs, choice)?];
    let line = file.entries().get(*index).map_or(1, |entry| entry.line);
    in_hertz(header).map_err(|found| FormatError::line(line, "an abscissa in Hz", found))?;
    in_si_units(&file)?;
    let function = file.function(*index)?;
    let (points, missing) = (function.header.points, function.missing_points());
    if missing > 0 {
        let (expected, found) = (format!("{points} points, as the header says"), points - missing);
        return Err(FormatError::line(line, expected, found.to_string()));
    }
    let Values::Complex(response) = function.values else {
        return Err(FormatError::line(line, "complex values of an FRF", "real ones"));
    };
    let is_coherence = |other: &FunctionHeader| other.function_type == FunctionType::Coherence;
    let is_std = |other: &FunctionHeader| {
        other.function_type == FunctionType::General && other.ordinate.label == STD_LABEL
    };
    let of = |is_wanted: &dyn Fn(&FunctionHeader) -> bool, limits| {
        companion(&file, header, &function.abscissa, is_wanted, limits)
    };
    let coherence = of(&is_coherence, ("coherences from 0 to 1", 1.0))?;
    let std = of(&is_std, ("standard deviations from 0 on", f64::MAX))?;
    let frf = Frf {
        frequency_hz: function.abscissa,
        response,
        coherence,
        std,
        quantity: quantity(header),
        measured_at: dof(&header.response),
        driven_at: dof(&header.reference),
    };
    sound(&frf, line)?;
    Ok(frf)
}

/// The label of a function that is the standard deviation √E|δH|² of an FRF: the format has no type for it.
pub(crate) const STD_LABEL: &str = "Standard deviation";

/// What the file says of an FRF beside its values: the one real function between the same degrees of freedom, at the same frequencies,
/// that is wanted. None where there is none, or several.
fn companion(
    file: &File<'_>,
    frf: &FunctionHeader,
    frequency_hz: &[f64],
    is_wanted: impl Fn(&FunctionHeader) -> bool,
    (expected, most): (&str, f64),
) -> Result<Option<Vec<f64>>, FormatError> {
    let mut found = None;
    for index in file.functions() {
        let header = file.function_header(index)?;
        let belongs = is_wanted(&header)
            && dof(&header.response) == dof(&frf.response)
            && dof(&header.reference) == dof(&frf.reference);
        if !belongs {
            continue;
        }
        let line = file.entries().get(index).map_or(1, |entry| entry.line);
        let function = file.function(index)?;
        let Values::Real(values) = function.values else {
            return Err(FormatError::line(line, format!("{expected}, real"), "complex ones"));
        };
        if function.abscissa != frequency_hz {
            continue;
        }
        if let Some(value) = values.iter().find(|value| !(0.0..=most).contains(*value)) {
            return Err(FormatError::line(line, expected, value.to_string()));
        }
        if found.replace(values).is_some() {
            return Ok(None);
        }
    }
    Ok(found)
}

/// The FRFs of a file: index of the dataset and header.
fn frfs(file: &File<'_>) -> Result<Vec<(usize, FunctionHeader)>, FormatError> {
    let mut frfs = Vec::new();
    let mut others = 0;
    for index in file.functions() {
        let header = file.function_header(index)?;
        match header.function_type {
            FunctionType::FrequencyResponse => frfs.push((index, header)),
            _ => others += 1,
        }
    }
    match frfs.is_empty() {
        true => Err(FormatError::whole(
            "a frequency response function (dataset 58 of function type 4)",
            format!("none, and {others} functions of other types"),
        )),
        false => Ok(frfs),
    }
}

/// By number; else by its degrees of freedom; else the only one.
fn chosen(frfs: &[(usize, FunctionHeader)], choice: &Choice) -> Result<usize, FormatError> {
    if let Some(record) = choice.record {
        let at = usize::try_from(record).ok().filter(|number| (1..=frfs.len()).contains(number));
        let refuse = || {
            FormatError::whole(format!("record = 1 to {} ({})", frfs.len(), listed(frfs)), record.to_string())
        };
        return Ok(at.ok_or_else(refuse)? - 1);
    }
    let agrees = |wanted: Option<DofName>, there: &uff::Dof| wanted.is_none() || wanted == dof(there);
    let mut fitting = frfs.iter().enumerate().filter(|(_, (_, header))| {
        choice.measured_at.is_some()
            && agrees(choice.measured_at, &header.response)
            && agrees(choice.driven_at, &header.reference)
    });
    match (frfs.len(), fitting.next(), fitting.next()) {
        (1, ..) => Ok(0),
        (_, Some((k, _)), None) => Ok(k),
        (_, first, _) => {
            let which = match (choice.measured_at, first) {
                (None, _) => "several, and no dof or record that tells which",
                (Some(_), None) => "none with the dof and load of the case",
                (Some(_), Some(_)) => {
                    "several with the dof and load of the case, and no record that tells which"
                }
            };
            let found = format!("{which} ({})", listed(frfs));
            Err(FormatError::whole("one frequency response function", found))
        }
    }
}

/// Number, response and reference of the first few FRFs.
fn listed(frfs: &[(usize, FunctionHeader)]) -> String {
    const MOST: usize = 8;
    let shown = |(k, (_, header)): (usize, &(usize, FunctionHeader))| {
        format!("{}: {}/{}", k + 1, header.response.label(), header.reference.label())
    };
    let first: Vec<_> = frfs.iter().enumerate().take(MOST).map(shown).collect();
    format!("{}{}", first.join(", "), if frfs.len() > MOST { ", ..." } else { "" })
}

/// What the numerator of the ordinate says, where the denominator is a force or says nothing.
fn quantity(header: &FunctionHeader) -> Option<Quantity> {
    let over_force = matches!(
        header.denominator.quantity,
        Axis::ExcitationForce | Axis::ReactionForce | Axis::Unknown | Axis::General
    );
    match header.ordinate.quantity {
        Axis::Displacement if over_force => Some(Quantity::Receptance),
        Axis::Velocity if over_force => Some(Quantity::Mobility),
        Axis::Acceleration if over_force => Some(Quantity::Accelerance),
        _ => None,
    }
}

fn dof(dof: &uff::Dof) -> Option<DofName> {
    DofName::from_uff(u64::try_from(dof.node).ok()?, dof.direction)
}

fn in_hertz(header: &FunctionHeader) -> Result<(), String> {
    let axis = &header.abscissa;
    match axis.quantity {
        Axis::Frequency | Axis::Unknown | Axis::General if axis.unit.to_lowercase().contains("rad") => {
            Err(format!("the unit {:?}", axis.unit))
        }
        Axis::Frequency | Axis::Unknown | Axis::General => Ok(()),
        other => Err(other.name().to_owned()),
    }
}

/// Refuses units in which an FRF differs from m/N by a factor: a mistake of 1000 would pass for physics.
fn in_si_units(file: &File<'_>) -> Result<(), FormatError> {
    for (index, entry) in file.entries().iter().enumerate().filter(|(_, entry)| entry.dataset == 164) {
        let Record::Units(units) = file.record(index)? else { continue };
        // Length over force in the file's units, over that in metres per newton.
        let scale = units.length / units.force;
        if (scale - 1.0).abs() > 1e-6 {
            let found = format!("unit factors {} of length and {} of force", units.length, units.force);
            return Err(FormatError::line(entry.line, "an FRF in SI units", found));
        }
    }
    Ok(())
}

/// Refuses what a table would not have: no point, values that are not finite, frequencies that do not ascend.
fn sound(frf: &Frf, line: usize) -> Result<(), FormatError> {
    if frf.response.is_empty() {
        return Err(FormatError::line(line, "at least one point", "none"));
    }
    let mut last = None;
    for (&frequency_hz, value) in frf.frequency_hz.iter().zip(&frf.response) {
        // Written so that NaN fails too.
        if !(frequency_hz.is_finite() && frequency_hz >= 0.0 && last.is_none_or(|last| frequency_hz > last)) {
            let after = last.map_or(String::new(), |last| format!(" after {last} Hz"));
            let expected = "frequencies from 0 on in ascending order";
            return Err(FormatError::line(line, expected, format!("{frequency_hz} Hz{after}")));
        }
        if !value.is_finite() {
            return Err(FormatError::line(line, "finite values", format!("{value} at {frequency_hz} Hz")));
        }
        last = Some(frequency_hz);
    }
    Ok(())
}
