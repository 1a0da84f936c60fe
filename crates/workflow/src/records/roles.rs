//! Which channel is the hammer, which are sensors, and in which unit.

use super::raw::{Raw, RawChannel};
use crate::error::{InputError, Place};
use frfit::dof::DofName;
use frfit::quantity::Quantity;
use frfit::signal::{Kind, Sensitivity, Unit};
use std::path::Path;

/// What the files leave open, or say wrong. A channel is named by its name, or by its number from 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChannelOptions {
    /// The channel of the force; by default the only one in a unit of force.
    pub force: Option<String>,
    /// The channels of the responses; by default all in a unit of displacement, velocity or acceleration.
    pub responses: Vec<String>,
    /// Unit of the force's samples, in place of the file's.
    pub force_unit: Option<Unit>,
    /// Unit of the responses' samples, in place of the file's.
    pub response_unit: Option<Unit>,
    /// Of the hammer, where its samples are a voltage.
    pub force_sensitivity: Option<Sensitivity>,
    /// Of the sensors, where their samples are a voltage.
    pub response_sensitivity: Option<Sensitivity>,
    /// Where and in which direction it was driven, in place of what the file says.
    pub force_dof: Option<DofName>,
    /// Where and in which direction it was measured, one a response, in place of what the file says.
    pub response_dofs: Vec<DofName>,
}

/// A channel with its role.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Its name in the file.
    pub name: String,
    /// What it measures.
    pub kind: Kind,
    /// SI units per unit of the file.
    pub scale: f64,
    /// Where it is, where that is known.
    pub dof: Option<DofName>,
    /// Its degree of freedom in the file.
    key: Option<DofName>,
}

impl Sensor {
    /// The quantity of its FRF.
    pub fn quantity(&self) -> Quantity {
        match self.kind {
            Kind::Velocity => Quantity::Mobility,
            Kind::Acceleration => Quantity::Accelerance,
            Kind::Displacement | Kind::Force | Kind::Voltage => Quantity::Receptance,
        }
    }

    /// Its samples in SI units; none where a recording lacks it.
    pub(super) fn samples(&self, raw: &Raw) -> Vec<f64> {
        let is_it = |channel: &&RawChannel| channel.name == self.name && channel.dof == self.key;
        let found = raw.channels.iter().find(is_it);
        found.map_or(Vec::new(), |channel| channel.samples.iter().map(|x| self.scale * x).collect())
    }
}

/// The hammer and the sensors.
pub(super) fn roles(
    raw: &[Raw],
    file: &Path,
    options: &ChannelOptions,
) -> Result<(Sensor, Vec<Sensor>), InputError> {
    let channels = all(raw);
    let place = Place::file(file);
    let listed = || listed(&channels);
    let force = Source {
        unit: options.force_unit,
        sensitivity: options.force_sensitivity,
        names: ["--force-unit", "--force-sensitivity"],
    };
    let response = Source {
        unit: options.response_unit,
        sensitivity: options.response_sensitivity,
        names: ["--response-unit", "--response-sensitivity"],
    };
    let is_force = |channel: &&&RawChannel| plain_unit(channel).is_some_and(|unit| unit.kind == Kind::Force);
    let hammer = match &options.force {
        Some(name) => named(&channels, name, "--force")?,
        None => match channels.iter().filter(is_force).collect::<Vec<_>>()[..] {
            [channel] => channel,
            [] => {
                let expected = "a channel in a unit of force, or --force with its name or number";
                return Err(InputError::at(&place, expected, listed()));
            }
            _ => {
                let expected = "one channel in a unit of force, or --force with its name or number";
                return Err(InputError::at(&place, expected, listed()));
            }
        },
    };
    let is_motion = |channel: &&&RawChannel| {
        let kind = plain_unit(channel).map(|unit| unit.kind);
        matches!(kind, Some(Kind::Displacement | Kind::Velocity | Kind::Acceleration))
            && !std::ptr::eq(**channel, hammer)
    };
    let sensors: Vec<&RawChannel> = match options.responses.is_empty() {
        true => channels.iter().filter(is_motion).copied().collect(),
        false => options
            .responses
            .iter()
            .map(|name| named(&channels, name, "--response"))
            .collect::<Result<_, _>>()?,
    };
    if sensors.is_empty() {
        let expected = "a channel in a unit of acceleration, velocity or displacement, or --response with its name or number";
        return Err(InputError::at(&place, expected, listed()));
    }
    let wanted = options.response_dofs.len();
    if wanted > 0 && wanted != sensors.len() {
        let expected = format!("one degree of freedom for each response ({})", sensors.len());
        return Err(InputError::at(&Place::option("--response-dof"), expected, wanted.to_string()));
    }
    let hammer = force.sensor(hammer, &place, options.force_dof, |kind| kind == Kind::Force)?;
    let sensors = sensors.into_iter().enumerate().map(|(k, channel)| {
        let is_motion = |kind| matches!(kind, Kind::Displacement | Kind::Velocity | Kind::Acceleration);
        response.sensor(channel, &place, options.response_dofs.get(k).copied(), is_motion)
    });
    Ok((hammer, sensors.collect::<Result<_, _>>()?))
}

/// Every channel that is in some recording, in the order in which they are met.
fn all(raw: &[Raw]) -> Vec<&RawChannel> {
    let mut all: Vec<&RawChannel> = Vec::new();
    for channel in raw.iter().flat_map(|raw| &raw.channels) {
        if all.iter().all(|other| (&other.name, other.dof) != (&channel.name, channel.dof)) {
            all.push(channel);
        }
    }
    all
}

/// The channel of a name, or of a number from 1.
fn named<'a>(channels: &[&'a RawChannel], name: &str, option: &str) -> Result<&'a RawChannel, InputError> {
    let mut by_name = channels.iter().filter(|channel| channel.name == name);
    let refuse = |expected: &str| {
        let expected = format!("{expected}: {}", listed(channels));
        Err(InputError::at(&Place::option(option), expected, format!("{name:?}")))
    };
    match (by_name.next(), by_name.next()) {
        (Some(channel), None) => Ok(channel),
        (Some(_), Some(_)) => refuse("the number of one of several channels of this name"),
        _ => {
            let index = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
            match index.and_then(|index| channels.get(index)) {
                Some(channel) => Ok(channel),
                None => refuse("the name or the number of a channel"),
            }
        }
    }
}

/// Number, name and unit of the first few.
fn listed(channels: &[&RawChannel]) -> String {
    const MAX_SHOWN: usize = 8;
    let shown = |(k, channel): (usize, &&RawChannel)| {
        let unit = if channel.unit.is_empty() { "no unit" } else { &channel.unit };
        let dof = channel.dof.map_or(String::new(), |dof| format!(" at {dof}"));
        format!("{}: {:?}{dof} in {unit}", k + 1, channel.name)
    };
    let first: Vec<String> = channels.iter().enumerate().take(MAX_SHOWN).map(shown).collect();
    format!("{}{}", first.join(", "), if channels.len() > MAX_SHOWN { ", ..." } else { "" })
}

/// The unit by its name, or else by what the file says otherwise.
fn plain_unit(channel: &RawChannel) -> Option<Unit> {
    channel.unit.parse().ok().or(channel.said)
}

/// What the command line says about the channels of a role.
struct Source {
    unit: Option<Unit>,
    sensitivity: Option<Sensitivity>,
    /// Of the options of unit and sensitivity.
    names: [&'static str; 2],
}

impl Source {
    fn sensor(
        &self,
        channel: &RawChannel,
        place: &Place,
        dof: Option<DofName>,
        fits: impl Fn(Kind) -> bool,
    ) -> Result<Sensor, InputError> {
        let unit = self.unit.or_else(|| plain_unit(channel));
        let [unit_option, sensitivity_option] = self.names;
        let (kind, scale) = match (self.sensitivity, unit) {
            (Some(sensitivity), unit) => {
                let unit = unit.unwrap_or(sensitivity.voltage);
                if unit.kind != Kind::Voltage {
                    let expected = format!(
                        "a voltage in {:?} for a sensitivity, or {unit_option} V or mV",
                        channel.name
                    );
                    return Err(InputError::at(
                        &Place::option(sensitivity_option),
                        expected,
                        unit.kind.name(),
                    ));
                }
                (sensitivity.kind, unit.factor * sensitivity.units_per_volt())
            }
            (None, Some(Unit { kind: Kind::Voltage, .. })) => {
                let expected = format!("{sensitivity_option} for {:?}, such as 10mV/N", channel.name);
                return Err(InputError::at(place, expected, "a voltage"));
            }
            (None, Some(unit)) => (unit.kind, unit.factor),
            (None, None) => {
                let expected = format!("a known unit of {:?}, or {unit_option}", channel.name);
                return Err(InputError::at(place, expected, format!("{:?}", channel.unit)));
            }
        };
        if !fits(kind) {
            let role = if unit_option.starts_with("--force") { "a force" } else { "a motion" };
            let expected = format!("{:?} to be {role}", channel.name);
            return Err(InputError::at(place, expected, kind.name()));
        }
        Ok(Sensor { name: channel.name.clone(), kind, scale, dof: dof.or(channel.dof), key: channel.dof })
    }
}
