//! Receptance, mobility, accelerance: displacement, velocity or acceleration over force.

use crate::c64;
use crate::frequency::{laplace_per_s, squared};
use std::fmt;
use std::str::FromStr;

/// What a frequency response function is the response of, per unit force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quantity {
    /// Displacement over force x/F, m/N.
    #[default]
    Receptance,
    /// Velocity over force iωx/F, m/(s·N).
    Mobility,
    /// Acceleration over force −ω²x/F, m/(s²·N), P-39.
    Accelerance,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Receptance, Self::Mobility, Self::Accelerance];

    /// 1, iω or −ω²: this quantity over receptance.
    pub fn over_receptance(self, frequency_hz: f64) -> c64 {
        self.over_receptance_windowed(frequency_hz, 0.0)
    }

    /// 1, s or s² with s = iω + α: the same under a window e^{−αt} on force and response (α in 1/s), where what is windowed is the derivative.
    pub fn over_receptance_windowed(self, frequency_hz: f64, decay_per_s: f64) -> c64 {
        let s = laplace_per_s(frequency_hz, decay_per_s);
        match self {
            Self::Receptance => c64::new(1.0, 0.0),
            Self::Mobility => s,
            Self::Accelerance => squared(s),
        }
    }

    /// This quantity of a receptance.
    pub fn from_receptance(self, frequency_hz: f64, receptance: c64) -> c64 {
        self.over_receptance(frequency_hz) * receptance
    }

    /// The receptance of this quantity's value; infinite or NaN at 0 Hz, where mobility and accelerance say
    /// nothing about displacement.
    pub fn to_receptance(self, frequency_hz: f64, value: c64) -> c64 {
        value / self.over_receptance(frequency_hz)
    }

    /// The name that case files and tables use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Receptance => "receptance",
            Self::Mobility => "mobility",
            Self::Accelerance => "accelerance",
        }
    }

    /// The unit, SI.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Receptance => "m/N",
            Self::Mobility => "m/(s·N)",
            Self::Accelerance => "m/(s²·N)",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A word that names no [`Quantity`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownQuantity(pub String);

impl fmt::Display for UnknownQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected receptance, mobility or accelerance, found {:?}", self.0)
    }
}

impl std::error::Error for UnknownQuantity {}

impl FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(name: &str) -> Result<Self, UnknownQuantity> {
        Self::ALL.into_iter().find(|q| q.name() == name).ok_or_else(|| UnknownQuantity(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::omega_rad_s;

    #[test]
    fn conversions_are_derivatives_of_e_to_the_plus_i_omega_t() {
        let x = c64::new(1.0, 2.0);
        let omega = omega_rad_s(3.0);
        assert_eq!(Quantity::Mobility.from_receptance(3.0, x), c64::new(0.0, omega) * x);
        assert_eq!(Quantity::Accelerance.from_receptance(3.0, x), -omega * omega * x);
        for quantity in Quantity::ALL {
            let there = quantity.from_receptance(3.0, x);
            assert!((quantity.to_receptance(3.0, there) - x).norm() < 1e-15);
            assert_eq!(quantity.name().parse(), Ok(quantity));
        }
        assert!("inertance".parse::<Quantity>().is_err());
    }
}
