//! Laws of a complex factor over frequency, above all of Young's modulus E(ω) = E′(1 + iη), P-31.

use crate::c64;
use crate::frequency::laplace_per_s;
use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// How a term's factor depends on frequency.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// The same complex number at every frequency.
    Constant(c64),
    /// Fractional derivative, P-36: E(ω) = E₀ + E₁ (iω)^α.
    ///
    /// # Source
    /// R. L. Bagley, P. J. Torvik, J. Rheology 27 (1983) 201–210.
    Fractional {
        /// E₀, Pa.
        e0: f64,
        /// E₁, Pa·s^α.
        e1: f64,
        /// α, between 0 (elastic) and 1 (viscous).
        alpha: f64,
    },
    /// Zener's with a fractional derivative: E(ω) = (E₀ + E∞ (iωτ)^α)/(1 + (iωτ)^α).
    ///
    /// # Source
    /// T. Pritz, J. Sound Vib. 195 (1996) 103–115.
    FractionalZener {
        /// E₀, the relaxed modulus, Pa.
        e0: f64,
        /// E∞ > E₀, the unrelaxed modulus, Pa.
        e_infinity: f64,
        /// τ, s.
        tau_s: f64,
        /// α, above 0 and at most 1.
        alpha: f64,
    },
    /// Maxwell's, generalised (a Prony series): E(ω) = E₀ + Σ_k E_k iωτ_k/(1 + iωτ_k).
    Maxwell {
        /// E₀, the relaxed modulus, Pa.
        e0: f64,
        /// Spring and dashpot in series, side by side.
        branches: Vec<Branch>,
    },
    /// Values at given frequencies, interpolated linearly over log ω.
    Table(Table),
}

/// A branch of the generalised Maxwell law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// E_k, Pa.
    pub modulus: f64,
    /// τ_k, s.
    pub tau_s: f64,
}

/// (sτ)^α, in polar form: no logarithm of a complex number is taken.
pub(crate) fn fractional_power(s_tau: c64, alpha: f64) -> c64 {
    c64::from_polar(s_tau.norm().powf(alpha), alpha * s_tau.arg())
}

/// E at s = iω + α of a modulus that is known at iω: E (s/iω)^p with p = (2/π) arg E, the power law with that loss factor.
///
/// The modulus of a causal material is an analytic function of s, so that its slope over ln s is that over ln ω: about (2/π) arg E where the loss factor changes slowly. A real factor
/// stays what it is.
///
/// # Limits
/// What is left is of the order of (α/ω)², and of α/ω times the change of η within an octave.
///
/// # Source
/// R. H. T. O'Donnell, E. T. Jaynes, J. G. Miller, J. Acoust. Soc. Am. 69 (1981) 696–701.
fn continued(modulus: c64, s: c64) -> c64 {
    match over_real_frequency(s).filter(|_| modulus.re > 0.0) {
        Some(ratio) => modulus * ratio.powf(modulus.arg() / FRAC_PI_2),
        None => modulus,
    }
}

/// s/iω of s = iω + α; `None` without a window, and at 0 Hz.
pub(crate) fn over_real_frequency(s: c64) -> Option<c64> {
    (s.re != 0.0 && s.im != 0.0).then(|| s / c64::new(0.0, s.im))
}

/// E at iω of a modulus that is known at s = iω + α: the inverse of what [`Law::at_laplace`] does to a modulus that is known at one frequency.
pub(crate) fn at_real_frequency(modulus: c64, frequency_hz: f64, decay_per_s: f64) -> c64 {
    let s = laplace_per_s(frequency_hz, decay_per_s);
    match over_real_frequency(s).filter(|_| modulus.re > 0.0) {
        // A power law has the phase p arg s at s.
        Some(ratio) => modulus * ratio.powf(-modulus.arg() / s.arg()),
        None => modulus,
    }
}

/// z/(1 + z), written so that a large z does not overflow.
pub(crate) fn saturation(z: c64) -> c64 {
    if z.norm_sqr() > 1.0 { 1.0 / (1.0 + 1.0 / z) } else { z / (1.0 + z) }
}

impl Law {
    /// E′(1 + iη) at every frequency, P-31.
    pub fn complex_modulus(storage: f64, loss_factor: f64) -> Self {
        Self::Constant(c64::new(storage, storage * loss_factor))
    }

    /// The law times a number.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(by * value),
            Self::Fractional { e0, e1, alpha } => {
                Self::Fractional { e0: by * e0, e1: by * e1, alpha: *alpha }
            }
            Self::FractionalZener { e0, e_infinity, tau_s, alpha } => Self::FractionalZener {
                e0: by * e0,
                e_infinity: by * e_infinity,
                tau_s: *tau_s,
                alpha: *alpha,
            },
            Self::Maxwell { e0, branches } => {
                let branch = |b: &Branch| Branch { modulus: by * b.modulus, ..*b };
                Self::Maxwell { e0: by * e0, branches: branches.iter().map(branch).collect() }
            }
            Self::Table(Table { frequency_hz, values }) => {
                let values = values.iter().map(|value| by * value).collect();
                Self::Table(Table { frequency_hz: frequency_hz.clone(), values })
            }
        }
    }

    /// The factor at a frequency.
    ///
    /// # Errors
    /// [`OutsideTable`] for a table that does not reach this frequency: no law extrapolates.
    pub fn at(&self, frequency_hz: f64) -> Result<c64, OutsideTable> {
        self.at_laplace(frequency_hz, 0.0)
    }

    /// The factor at s = iω + α, as records with a window e^{−αt} show it ([`crate::model::DynamicStiffness::with_decay_per_s`]).
    ///
    /// A law is a function of iω, and has its value at s. Of a constant or a table the loss factor is taken to be that of a power law, E (s/iω)^{(2/π) arg E}.
    ///
    /// # Errors
    /// As [`Self::at`].
    pub fn at_laplace(&self, frequency_hz: f64, decay_per_s: f64) -> Result<c64, OutsideTable> {
        let s = laplace_per_s(frequency_hz, decay_per_s);
        match self {
            Self::Constant(value) => Ok(continued(*value, s)),
            Self::Fractional { e0, e1, alpha } => Ok(e0 + e1 * fractional_power(s, *alpha)),
            Self::FractionalZener { e0, e_infinity, tau_s, alpha } => {
                let z = fractional_power(s * tau_s, *alpha);
                Ok(e0 + (e_infinity - e0) * saturation(z))
            }
            Self::Maxwell { e0, branches } => {
                let branch = |b: &Branch| b.modulus * saturation(s * b.tau_s);
                Ok(e0 + branches.iter().map(branch).sum::<c64>())
            }
            Self::Table(table) => Ok(continued(table.at(frequency_hz)?, s)),
        }
    }
}

/// Loss factor η = E″/E′ of a complex modulus, P-31.
pub fn loss_factor(modulus: c64) -> f64 {
    modulus.im / modulus.re
}

/// A factor known at some frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    frequency_hz: Vec<f64>,
    values: Vec<c64>,
}

/// A frequency that a table does not reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutsideTable {
    /// The frequency that was asked for.
    pub frequency_hz: f64,
    /// First and last frequency of the table.
    pub table_hz: [f64; 2],
}

impl fmt::Display for OutsideTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frequency_hz, table_hz: [first, last] } = self;
        write!(f, "the table covers {first} Hz to {last} Hz, and {frequency_hz} Hz was asked for")
    }
}

impl std::error::Error for OutsideTable {}

/// What is wrong with a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TableError {
    /// No row, or different numbers of frequencies and values.
    Shape,
    /// Frequencies that are not positive and strictly ascending, at this row (from 0).
    NotAscending(usize),
    /// A value that is not finite, at this row (from 0).
    NotFinite(usize),
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape => write!(f, "a table needs at least one row, and one value for each frequency"),
            Self::NotAscending(row) => {
                write!(f, "row {}: frequencies must be positive and strictly ascending", row + 1)
            }
            Self::NotFinite(row) => write!(f, "row {}: the value is not finite", row + 1),
        }
    }
}

impl std::error::Error for TableError {}

impl Table {
    /// Values at positive, strictly ascending frequencies.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(frequency_hz: Vec<f64>, values: Vec<c64>) -> Result<Self, TableError> {
        if frequency_hz.is_empty() || frequency_hz.len() != values.len() {
            return Err(TableError::Shape);
        }
        let mut last = 0.0;
        for (row, (&f, value)) in frequency_hz.iter().zip(&values).enumerate() {
            // Written so that NaN fails too.
            if !(f > last && f.is_finite()) {
                return Err(TableError::NotAscending(row));
            }
            if !value.is_finite() {
                return Err(TableError::NotFinite(row));
            }
            last = f;
        }
        Ok(Self { frequency_hz, values })
    }

    /// The frequencies of its rows, ascending.
    pub fn frequency_hz(&self) -> &[f64] {
        &self.frequency_hz
    }

    /// The value at each of its frequencies.
    pub fn values(&self) -> &[c64] {
        &self.values
    }

    fn at(&self, frequency_hz: f64) -> Result<c64, OutsideTable> {
        let (first, last) = (self.frequency_hz[0], self.frequency_hz[self.frequency_hz.len() - 1]);
        if !(first..=last).contains(&frequency_hz) {
            return Err(OutsideTable { frequency_hz, table_hz: [first, last] });
        }
        let above = self.frequency_hz.partition_point(|&f| f < frequency_hz);
        if self.frequency_hz[above] == frequency_hz {
            return Ok(self.values[above]);
        }
        let (f0, f1) = (self.frequency_hz[above - 1], self.frequency_hz[above]);
        let weight = (frequency_hz / f0).ln() / (f1 / f0).ln();
        Ok(self.values[above - 1] * (1.0 - weight) + self.values[above] * weight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractional_law_of_polybutadiene() {
        // P-36 written out with the paper's constants: (iω)^α = ω^α (cos απ/2 + i sin απ/2).
        let law = Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 };
        let omega = 2.0 * std::f64::consts::PI * 1500.0;
        let (re, im) = (0.528f64 * std::f64::consts::FRAC_PI_2).sin_cos();
        let expected = c64::new(8.14e5 + 7.31e4 * omega.powf(0.528) * im, 7.31e4 * omega.powf(0.528) * re);
        assert!((law.at(1500.0).unwrap() - expected).norm() < 1e-15 * expected.norm());
        // At ω = 0 only E₀ is left.
        assert_eq!(law.at(0.0).unwrap(), c64::new(8.14e5, 0.0));
    }

    #[test]
    fn tables_interpolate_over_log_frequency_and_never_extrapolate() {
        let table = Table::new(vec![10.0, 1000.0], vec![c64::new(1.0, 0.0), c64::new(3.0, 2.0)]).unwrap();
        let law = Law::Table(table);
        assert!((law.at(100.0).unwrap() - c64::new(2.0, 1.0)).norm() < 1e-15);
        assert_eq!(law.at(10.0).unwrap(), c64::new(1.0, 0.0));
        assert_eq!(law.at(1000.0).unwrap(), c64::new(3.0, 2.0));
        assert_eq!(
            law.at(9.0).unwrap_err().to_string(),
            "the table covers 10 Hz to 1000 Hz, and 9 Hz was asked for"
        );
        assert!(law.at(f64::NAN).is_err());
    }

    #[test]
    fn broken_tables_are_refused() {
        let one = c64::new(1.0, 0.0);
        assert_eq!(Table::new(vec![], vec![]), Err(TableError::Shape));
        assert_eq!(Table::new(vec![2.0, 1.0], vec![one; 2]), Err(TableError::NotAscending(1)));
        assert_eq!(Table::new(vec![0.0], vec![one]), Err(TableError::NotAscending(0)));
        assert_eq!(Table::new(vec![1.0], vec![one * f64::NAN]), Err(TableError::NotFinite(0)));
    }
}
