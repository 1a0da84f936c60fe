//! What the factor of a matrix is: a modulus, or a number relative to the one that the matrix was made with.

use super::UnitSystem;
use frfit::c64;
use frfit::material::Law;
use frfit::model::Role;

/// What an unknown factor is a number of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FactorUnit {
    /// A modulus in the unit of this system.
    Modulus(UnitSystem),
    /// Of a stiffness that has its modulus in it: no unit.
    Relative,
    /// Of a mass, a damping or a geometric parameter: what it multiplies says which.
    Other,
}

/// A factor of a stiffness below this counts as relative where the case does not say what it is. No solid that vibrates has a modulus of 100 Pa; in systems with
/// larger units of stress a number like this can be either, and is given no unit rather than a wrong one.
const RELATIVE: f64 = 100.0;

impl FactorUnit {
    /// Of a factor with this law at these frequencies. `is_modulus` is what the case says.
    pub(crate) fn of(
        role: Role,
        is_modulus: Option<bool>,
        nominal: &Law,
        frequency_hz: &[f64],
        units: UnitSystem,
    ) -> Self {
        let size = |f: &f64| nominal.at(*f).map_or(0.0, c64::norm);
        let large = || frequency_hz.iter().map(size).fold(0.0, f64::max) >= RELATIVE;
        match role {
            Role::Mass | Role::Viscous => Self::Other,
            Role::Stiffness if is_modulus.unwrap_or_else(large) => Self::Modulus(units),
            Role::Stiffness => Self::Relative,
        }
    }

    /// `Pa`, `MPa` …; nothing where it has no unit, or none that is known.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Modulus(units) => units.modulus_unit(),
            Self::Relative | Self::Other => "",
        }
    }

    /// The same for programs: `1` of a relative factor, `None` where none is known.
    pub fn word(self) -> Option<&'static str> {
        match self {
            Self::Modulus(units) => Some(units.modulus_unit()),
            Self::Relative => Some("1"),
            Self::Other => None,
        }
    }

    /// The axis of the real part of a complex factor.
    pub(crate) fn storage_label(self) -> String {
        match self {
            Self::Modulus(units) => format!("Storage modulus E′ ({})", units.modulus_unit()),
            Self::Relative => "Storage modulus E′ (× that of the matrix)".into(),
            Self::Other => "Real part of the factor".into(),
        }
    }

    /// The unit of a law's parameter whose modulus is in Pa.
    pub(crate) fn of_parameter(self, unit: &str) -> String {
        match self {
            Self::Modulus(units) => unit.replace("Pa", units.modulus_unit()),
            Self::Relative | Self::Other => unit.replace("Pa", "").trim().to_owned(),
        }
    }
}
