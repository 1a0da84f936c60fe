//! Units of measured channels, and the sensitivity of sensors.

use std::fmt;
use std::str::FromStr;

/// What a channel measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// N
    Force,
    /// m
    Displacement,
    /// m/s
    Velocity,
    /// m/s²
    Acceleration,
    /// V: what a sensor gives, of which its sensitivity makes one of the others.
    Voltage,
}

impl Kind {
    /// The unit, SI.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::Displacement => "m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
            Self::Voltage => "V",
        }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Voltage => "voltage",
        }
    }
}

/// A unit: what it measures, and how many SI units it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub kind: Kind,
    /// A value in SI units is this times the value in this unit.
    pub factor: f64,
}

/// Standard acceleration of free fall in m/s² (exact).
const STANDARD_GRAVITY: f64 = 9.80665;

/// The avoirdupois pound in kg (exact).
const POUND_KG: f64 = 0.453_592_37;

/// Every word for a unit. Case counts: mN is not MN.
const UNITS: [(&str, Kind, f64); 36] = [
    ("N", Kind::Force, 1.0),
    ("Newton", Kind::Force, 1.0),
    ("Newtons", Kind::Force, 1.0),
    ("newton", Kind::Force, 1.0),
    ("newtons", Kind::Force, 1.0),
    ("mN", Kind::Force, 1e-3),
    ("kN", Kind::Force, 1e3),
    ("lbf", Kind::Force, POUND_KG * STANDARD_GRAVITY),
    ("kgf", Kind::Force, STANDARD_GRAVITY),
    ("m/s^2", Kind::Acceleration, 1.0),
    ("m/s²", Kind::Acceleration, 1.0),
    ("m/s2", Kind::Acceleration, 1.0),
    ("m/s/s", Kind::Acceleration, 1.0),
    ("mm/s^2", Kind::Acceleration, 1e-3),
    ("mm/s²", Kind::Acceleration, 1e-3),
    ("in/s^2", Kind::Acceleration, 0.0254),
    ("g", Kind::Acceleration, STANDARD_GRAVITY),
    ("gn", Kind::Acceleration, STANDARD_GRAVITY),
    ("g_n", Kind::Acceleration, STANDARD_GRAVITY),
    ("mg", Kind::Acceleration, 1e-3 * STANDARD_GRAVITY),
    ("m/s", Kind::Velocity, 1.0),
    ("mm/s", Kind::Velocity, 1e-3),
    ("um/s", Kind::Velocity, 1e-6),
    ("µm/s", Kind::Velocity, 1e-6),
    ("in/s", Kind::Velocity, 0.0254),
    ("m", Kind::Displacement, 1.0),
    ("mm", Kind::Displacement, 1e-3),
    ("um", Kind::Displacement, 1e-6),
    ("µm", Kind::Displacement, 1e-6),
    ("in", Kind::Displacement, 0.0254),
    ("V", Kind::Voltage, 1.0),
    ("Volt", Kind::Voltage, 1.0),
    ("Volts", Kind::Voltage, 1.0),
    ("mV", Kind::Voltage, 1e-3),
    ("uV", Kind::Voltage, 1e-6),
    ("µV", Kind::Voltage, 1e-6),
];

/// A word that names no [`Unit`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownUnit(pub String);

impl fmt::Display for UnknownUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "expected a unit of force (N, kN, lbf, kgf), acceleration (m/s^2, g), velocity (m/s, mm/s), \
             displacement (m, mm, um) or voltage (V, mV), found {:?}",
            self.0
        )
    }
}

impl std::error::Error for UnknownUnit {}

impl FromStr for Unit {
    type Err = UnknownUnit;

    fn from_str(name: &str) -> Result<Self, UnknownUnit> {
        // Of the two signs for micro, one looks like the other.
        let wanted = name.trim().replace('\u{3bc}', "\u{b5}");
        let found = UNITS.iter().find(|(word, ..)| *word == wanted);
        found
            .map(|&(_, kind, factor)| Self { kind, factor })
            .ok_or_else(|| UnknownUnit(name.trim().to_owned()))
    }
}

/// What a sensor gives per unit of what it measures, as its certificate says: `22.4 mV/N`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitivity {
    /// V per SI unit.
    pub volts_per_unit: f64,
    /// The unit of the voltage as it was written: that of samples without a unit of their own.
    pub voltage: Unit,
    /// What it measures.
    pub kind: Kind,
}

impl Sensitivity {
    /// SI units a volt.
    pub fn units_per_volt(self) -> f64 {
        1.0 / self.volts_per_unit
    }
}

/// A text that is no [`Sensitivity`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SensitivityError(pub String);

impl fmt::Display for SensitivityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected a sensitivity such as 22.4mV/N or 0.1V/g, not zero, found {:?}", self.0)
    }
}

impl std::error::Error for SensitivityError {}

impl FromStr for Sensitivity {
    type Err = SensitivityError;

    fn from_str(text: &str) -> Result<Self, SensitivityError> {
        let refuse = || SensitivityError(text.to_owned());
        let (value, unit) = text.split_once('/').ok_or_else(refuse)?;
        let at =
            value.find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+' | 'e' | 'E')).ok_or_else(refuse)?;
        let number: f64 = value[..at].trim().parse().map_err(|_| refuse())?;
        let voltage: Unit = value[at..].parse().map_err(|_| refuse())?;
        let unit: Unit = unit.parse().map_err(|_| refuse())?;
        let volts_per_unit = number * voltage.factor / unit.factor;
        if voltage.kind != Kind::Voltage || unit.kind == Kind::Voltage {
            return Err(refuse());
        }
        // A negative one turns a sensor round that was mounted the other way.
        match volts_per_unit.is_normal() {
            true => Ok(Self { volts_per_unit, voltage, kind: unit.kind }),
            false => Err(refuse()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_si_units_times_a_factor() {
        let of = |word: &str| word.parse::<Unit>().unwrap();
        assert_eq!(of("g"), Unit { kind: Kind::Acceleration, factor: 9.80665 });
        // NIST SP 811: 1 lbf = 4.448 221 615 260 5 N exactly.
        assert!((of("lbf").factor - 4.448_221_615_260_5).abs() < 1e-15);
        assert_eq!(of(" Newtons "), of("N"));
        assert_eq!(of("\u{3bc}m/s"), of("\u{b5}m/s"));
        assert_eq!((of("mN").factor, of("mV").kind), (1e-3, Kind::Voltage));
        for word in ["", "G", "n", "MN", "lb", "Pa", "m/s^3"] {
            assert!(word.parse::<Unit>().is_err(), "{word}");
        }
    }

    #[test]
    fn sensitivities_are_voltages_per_unit() {
        let of = |text: &str| text.parse::<Sensitivity>().unwrap();
        assert_eq!((of("22.4mV/N").volts_per_unit, of("22.4 mV/N").kind), (0.0224, Kind::Force));
        // 100 mV/g is 10.197 mV/(m/s²).
        assert!((of("0.1 V/g").volts_per_unit - 0.1 / 9.80665).abs() < 1e-17);
        assert!((of("10 mV/m/s^2").units_per_volt() - 100.0).abs() < 1e-12);
        assert_eq!(of("-1e1mV/N").volts_per_unit, -0.01);
        for text in ["", "22.4", "mV/N", "0mV/N", "22.4N/mV", "22.4mV/mV", "22.4 mV", "nanmV/N"] {
            assert!(text.parse::<Sensitivity>().is_err(), "{text}");
        }
    }
}
