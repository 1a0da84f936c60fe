//! Time functions of a UFF file.

use super::raw::{Raw, RawChannel, common_step_s, step_s};
use crate::error::InputError;
use frfit::dof::DofName;
use frfit::signal::{Kind, Unit};
use frfit_formats::FormatError;
use frfit_formats::uff::{
    File, Function, FunctionHeader, FunctionType, Quantity, Record, Spacing, Units, Values,
};
use std::path::Path;

/// The k-th function of each channel (its quantity and degree of freedom) belongs to the k-th recording.
pub(super) fn raw(path: &Path, bytes: &[u8]) -> Result<Vec<Raw>, InputError> {
    let in_file = |error| InputError::in_file(path, error);
    let file = File::new(bytes).map_err(in_file)?;
    let mut units = Units::default();
    let mut recordings: Vec<(Vec<f64>, Vec<RawChannel>)> = Vec::new();
    for (index, entry) in file.entries().iter().enumerate() {
        if entry.dataset == 164
            && let Record::Units(there) = file.record(index).map_err(in_file)?
        {
            units = *there;
        }
        if entry.dataset != 58 {
            continue;
        }
        let header = file.function_header(index).map_err(in_file)?;
        if !is_time(&header) {
            continue;
        }
        let function = file.function(index).map_err(in_file)?;
        let (channel, step) = channel(function, &units, entry.line).map_err(in_file)?;
        let has_it = |(_, channels): &(_, Vec<RawChannel>)| {
            channels.iter().any(|other| (&other.name, other.dof) == (&channel.name, channel.dof))
        };
        let place = match recordings.iter().position(|recording| !has_it(recording)) {
            Some(place) => place,
            None => {
                recordings.push(Default::default());
                recordings.len() - 1
            }
        };
        recordings[place].0.push(step);
        recordings[place].1.push(channel);
    }
    if recordings.is_empty() {
        return Err(in_file(FormatError::whole("time functions (dataset 58 of function type 1)", "none")));
    }
    recordings
        .into_iter()
        .map(|(steps, channels)| {
            Ok(Raw {
                file: path.to_path_buf(),
                step_s: common_step_s(path, steps.into_iter().map(Ok))?,
                channels,
            })
        })
        .collect()
}

/// A function over time, also where its type was left open.
fn is_time(header: &FunctionHeader) -> bool {
    let over_time = matches!(header.abscissa.quantity, Quantity::Time);
    header.function_type == FunctionType::TimeResponse
        || header.function_type == FunctionType::General && over_time
}

/// A channel and its step.
fn channel(function: Function, units: &Units, line: usize) -> Result<(RawChannel, f64), FormatError> {
    let missing = function.missing_points();
    let Function { header, abscissa, values } = function;
    if missing > 0 {
        let expected = format!("{} points, as the header says", header.points);
        return Err(FormatError::line(line, expected, (header.points - missing).to_string()));
    }
    let Values::Real(samples) = values else {
        return Err(FormatError::line(line, "real values of a time function", "complex ones"));
    };
    if samples.iter().any(|x| !x.is_finite()) {
        return Err(FormatError::line(line, "finite values", "others"));
    }
    let step = match header.spacing {
        Spacing::Even { increment, .. } if increment > 0.0 => increment,
        Spacing::Even { increment, .. } => {
            return Err(FormatError::line(line, "an increment above 0", increment.to_string()));
        }
        Spacing::Uneven => {
            let at_line = |error: FormatError| FormatError::line(line, error.expected, error.found);
            step_s(&abscissa).map_err(at_line)?
        }
    };
    let axis = header.ordinate;
    let dof = u64::try_from(header.response.node)
        .ok()
        .and_then(|node| DofName::from_uff(node, header.response.direction));
    let said = said(axis.quantity, units);
    let name = match said {
        Some(unit) => unit.kind.name().to_owned(),
        None if !axis.label.is_empty() => axis.label.clone(),
        None => header.id[0].clone(),
    };
    Ok((RawChannel { name, unit: axis.unit, said, dof, samples }, step))
}

/// What the specific data type says, in the units of the file: SI is the value over the factor.
fn said(quantity: Quantity, units: &Units) -> Option<Unit> {
    let (kind, factor) = match quantity {
        Quantity::ExcitationForce | Quantity::ReactionForce => (Kind::Force, units.force),
        Quantity::Displacement => (Kind::Displacement, units.length),
        Quantity::Velocity => (Kind::Velocity, units.length),
        Quantity::Acceleration => (Kind::Acceleration, units.length),
        _ => return None,
    };
    Some(Unit { kind, factor: 1.0 / factor })
}
