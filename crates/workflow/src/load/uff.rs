//! One FRF of a UFF file.

use super::frf::{Choice, Frf};
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit::signal::Unit;
use frfit_formats::csv::decay_said;
use frfit_formats::uff::{self, Entry, File, FunctionHeader, FunctionType, Record, Values};
use frfit_formats::{FormatError, uff::Quantity as Axis};
use std::collections::HashMap;

/// Reads the FRF of a choice.
pub(super) fn read(bytes: &[u8], choice: &Choice) -> Result<Frf, FormatError> {
    Index::of(bytes)?.read(bytes, choice)
}

/// Reads the FRFs with these numbers, from 1, each as [`read_frf`](super::read_frf) does; the file is looked through once.
///
/// # Errors
/// As [`read_frf`](super::read_frf).
pub fn read_frfs(bytes: &[u8], records: &[i64]) -> Result<Vec<Frf>, FormatError> {
    let index = Index::of(bytes)?;
    let of = |&record: &i64| index.read(bytes, &Choice { record: Some(record), ..Choice::default() });
    records.iter().map(of).collect()
}

/// What is where in a file: found once for all FRFs that are taken of it, and looked up for each.
#[derive(Debug)]
pub(super) struct Index {
    entries: Vec<Entry>,
    /// Index of the dataset, and header, of every FRF.
    frfs: Vec<(usize, FunctionHeader)>,
    /// Which of the FRFs were measured at a degree of freedom, with the load at another one, or anywhere (`None`).
    between: HashMap<(DofName, Option<DofName>), Vec<usize>>,
    /// Other functions, by where they were measured and driven.
    others: HashMap<Ends, Vec<(usize, FunctionHeader)>>,
}

/// Where a function was measured and driven.
type Ends = [Option<DofName>; 2];

fn ends(header: &FunctionHeader) -> Ends {
    [dof(&header.response), dof(&header.reference)]
}

impl Index {
    /// Finds all datasets and reads the headers of the functions.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, FormatError> {
        let file = File::new(bytes)?;
        let mut frfs = Vec::new();
        let mut between: HashMap<(DofName, Option<DofName>), Vec<usize>> = HashMap::new();
        let mut others: HashMap<Ends, Vec<(usize, FunctionHeader)>> = HashMap::new();
        let mut count = 0;
        for index in file.functions() {
            let header = file.function_header(index)?;
            if header.function_type == FunctionType::FrequencyResponse {
                if let [Some(at), driven_at] = ends(&header) {
                    let mut add = |driven_at| between.entry((at, driven_at)).or_default().push(frfs.len());
                    add(None);
                    driven_at.into_iter().for_each(|driven_at| add(Some(driven_at)));
                }
                frfs.push((index, header));
            } else {
                count += 1;
                others.entry(ends(&header)).or_default().push((index, header));
            }
        }
        if frfs.is_empty() {
            return Err(FormatError::whole(
                "a frequency response function (dataset 58 of function type 4)",
                format!("none, and {count} functions of other types"),
            ));
        }
        Ok(Self { entries: file.entries().to_vec(), frfs, between, others })
    }

    /// Reads the FRF of a choice from the bytes that were looked through.
    pub(super) fn read(&self, bytes: &[u8], choice: &Choice) -> Result<Frf, FormatError> {
        let file = File::with_entries(bytes, &self.entries);
        let (index, header) = &self.frfs[self.chosen(choice)?];
        let line = self.entries.get(*index).map_or(1, |entry| entry.line);
        in_hertz(header).map_err(|found| FormatError::line(line, "an abscissa in Hz", found))?;
        let to_si = to_si(&file, header)?;
        let function = file.function(*index)?;
        let (points, missing) = (function.header.points, function.missing_points());
        if missing > 0 {
            let (expected, found) = (format!("{points} points, as the header says"), points - missing);
            return Err(FormatError::line(line, expected, found.to_string()));
        }
        let Values::Complex(mut response) = function.values else {
            return Err(FormatError::line(line, "complex values of an FRF", "real ones"));
        };
        let is_coherence = |other: &FunctionHeader| other.function_type == FunctionType::Coherence;
        let is_std = |other: &FunctionHeader| {
            other.function_type == FunctionType::General && other.ordinate.label == STD_LABEL
        };
        let others = self.others.get(&ends(header)).map_or(&[][..], Vec::as_slice);
        let of = |is_wanted: &dyn Fn(&FunctionHeader) -> bool, limits| {
            companion(&file, others, &function.abscissa, is_wanted, limits)
        };
        let coherence = of(&is_coherence, ("coherences from 0 to 1", 1.0))?;
        let mut std = of(&is_std, ("standard deviations from 0 on", f64::MAX))?;
        if to_si != 1.0 {
            response.iter_mut().for_each(|value| *value *= to_si);
            std.iter_mut().flatten().for_each(|value| *value *= to_si);
        }
        let frf = Frf {
            frequency_hz: function.abscissa,
            response,
            coherence,
            std,
            quantity: quantity(header),
            measured_at: dof(&header.response),
            driven_at: dof(&header.reference),
            decay_per_s: decay(header, line)?,
        };
        sound(&frf, line)?;
        Ok(frf)
    }

    /// By number; else by its degrees of freedom; else by these exchanged, as a hammer that moves has them (by reciprocity that FRF is the same); else the only one.
    fn chosen(&self, choice: &Choice) -> Result<usize, FormatError> {
        let frfs = &self.frfs;
        if let Some(record) = choice.record {
            let at = usize::try_from(record).ok().filter(|number| (1..=frfs.len()).contains(number));
            let refuse = || {
                FormatError::whole(
                    format!("record = 1 to {} ({})", frfs.len(), listed(frfs)),
                    record.to_string(),
                )
            };
            return Ok(at.ok_or_else(refuse)? - 1);
        }
        let between = |ends: Option<(DofName, Option<DofName>)>| {
            ends.and_then(|ends| self.between.get(&ends)).map_or(&[][..], Vec::as_slice)
        };
        let fitting = between(choice.measured_at.map(|at| (at, choice.driven_at)));
        let exchanged = || between(choice.driven_at.map(|at| (at, choice.measured_at)));
        match (frfs.len(), fitting) {
            (1, _) => Ok(0),
            (_, &[k]) => Ok(k),
            (_, fitting) => {
                let which = match (choice.measured_at, fitting) {
                    (None, _) => "several, and no dof or record that says which",
                    (Some(_), []) => match exchanged() {
                        &[k] => return Ok(k),
                        _ => "none with the dof and load of the case",
                    },
                    (Some(_), _) => {
                        "several with the dof and load of the case, and no record that says which"
                    }
                };
                let found = format!("{which} ({})", listed(frfs));
                Err(FormatError::whole("one frequency response function", found))
            }
        }
    }
}

/// The label of a function that is the standard deviation √E|δH|² of an FRF: the format has no type for it.
pub(crate) const STD_LABEL: &str = "Standard deviation";

/// What the file says of an FRF beside its values: of the other functions between the same degrees of freedom the one real one, at the same frequencies,
/// that is wanted. `None` if no function qualifies, or several do.
fn companion(
    file: &File<'_>,
    others: &[(usize, FunctionHeader)],
    frequency_hz: &[f64],
    is_wanted: impl Fn(&FunctionHeader) -> bool,
    (expected, most): (&str, f64),
) -> Result<Option<Vec<f64>>, FormatError> {
    let mut found = None;
    for &(index, _) in others.iter().filter(|(_, header)| is_wanted(header)) {
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

/// Number, response and reference of the first few FRFs.
fn listed(frfs: &[(usize, FunctionHeader)]) -> String {
    const MOST: usize = 8;
    let shown = |(k, (_, header)): (usize, &(usize, FunctionHeader))| {
        format!("{}: {}/{}", k + 1, header.response.label(), header.reference.label())
    };
    let first: Vec<_> = frfs.iter().enumerate().take(MOST).map(shown).collect();
    format!("{}{}", first.join(", "), if frfs.len() > MOST { ", ..." } else { "" })
}

/// What the ID lines say about an exponential window.
fn decay(header: &FunctionHeader, line: usize) -> Result<Option<f64>, FormatError> {
    let mut said = header.id.iter().filter_map(|id| Some((id, decay_said(id.as_bytes())?)));
    let Some((id, value)) = said.next() else { return Ok(None) };
    let refuse = || FormatError::line(line, "decay_per_s = a number of 1/s from 0 on in an ID line", id);
    value.ok_or_else(refuse).map(Some)
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

/// What the values of an FRF are multiplied by to be in SI units, as the file's dataset 164 says; 1 without one.
///
/// # Errors
/// Units that the labels of the FRF contradict: a mistake of 1000 would pass for physics.
fn to_si(file: &File<'_>, frf: &FunctionHeader) -> Result<f64, FormatError> {
    // The factor, and the line that says it.
    let mut said: Option<(f64, usize)> = None;
    for (index, entry) in file.entries().iter().enumerate().filter(|(_, entry)| entry.dataset == 164) {
        let Record::Units(units) = file.record(index)? else { continue };
        let turns = |dof: &uff::Dof| dof.direction.unsigned_abs() > 3;
        let check = |label: &str, of_file: f64| match label.parse::<Unit>() {
            Ok(unit) if (unit.factor * of_file - 1.0).abs() > 1e-6 => {
                let expected = format!("units of the file (dataset 164) that agree with the label {label:?}");
                let found = format!("unit factors {} of length and {} of force", units.length, units.force);
                Err(FormatError::line(entry.line, expected, found))
            }
            _ => Ok(()),
        };
        // An angle is in rad, and a moment in force times length. SI is the value over the factor.
        let length = if turns(&frf.response) { 1.0 } else { units.length };
        let force = if turns(&frf.reference) { units.force * units.length } else { units.force };
        let this = force / length;
        if (this - 1.0).abs() > 1e-6 {
            check(&frf.ordinate.unit, length)?;
            check(&frf.denominator.unit, force)?;
        }
        if let Some((_, line)) = said.filter(|(other, _)| *other != this) {
            let found = format!("other ones than in line {line}");
            return Err(FormatError::line(entry.line, "the same units throughout the file", found));
        }
        said = Some((this, entry.line));
    }
    // Factors that are 1 but for rounding are 1.
    Ok(said.map(|(factor, _)| factor).filter(|factor| (factor - 1.0).abs() > 1e-6).unwrap_or(1.0))
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
