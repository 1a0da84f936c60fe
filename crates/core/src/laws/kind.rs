//! Which laws there are, their parameters, and how the modulus depends on them.

use crate::c64;
use crate::material::{Branch, Law, fractional_power, saturation};
use std::f64::consts::FRAC_PI_2;
use std::fmt;
use std::str::FromStr;

/// A law of the complex modulus with parameters to be found.
///
/// | family | E(ω) | parameters p |
/// |---|---|---|
/// | constant | E′(1 + iη) | E′, η |
/// | fractional | E₀ + E₁ (iω)^α, P-36 | E₀, E₁, α |
/// | zener | (E₀ + E∞ (iωτ)^α)/(1 + (iωτ)^α) | E₀, E∞, τ, α |
/// | maxwell:N | E₀ + Σ_k E_k iωτ_k/(1 + iωτ_k) | E₀, E_1, τ_1 … E_N, τ_N |
///
/// # Source
/// R. L. Bagley, P. J. Torvik, J. Rheology 27 (1983) 201–210 (fractional); T. Pritz, J. Sound Vib. 195 (1996) 103–115 (fractional Zener);
/// J. D. Ferry, *Viscoelastic Properties of Polymers*, Wiley 1980 (generalised Maxwell).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LawKind {
    /// E′(1 + iη).
    Constant,
    /// E₀ + E₁ (iω)^α.
    Fractional,
    /// (E₀ + E∞ (iωτ)^α)/(1 + (iωτ)^α).
    FractionalZener,
    /// E₀ + Σ_k E_k iωτ_k/(1 + iωτ_k).
    Maxwell {
        /// Number of branches N, from 1 to [`MAX_BRANCHES`].
        branches: usize,
    },
}

/// Branches at most. Measured moduli tell about one relaxation time a decade apart.
pub const MAX_BRANCHES: usize = 20;

/// Branches where no number is given.
pub const USUAL_BRANCHES: usize = 3;

/// A parameter's name, as case files write it, and its unit; `E` stands for the unit of the modulus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterName {
    /// Such as `e0`, `tau_1`.
    pub name: String,
    /// Such as `Pa`, `s`; empty without one.
    pub unit: &'static str,
}

impl LawKind {
    /// The kinds that are compared where none is named.
    pub const ALL: [Self; 7] = [
        Self::Constant,
        Self::Fractional,
        Self::FractionalZener,
        Self::Maxwell { branches: 1 },
        Self::Maxwell { branches: 2 },
        Self::Maxwell { branches: 3 },
        Self::Maxwell { branches: 4 },
    ];

    /// Number of parameters.
    pub fn count(self) -> usize {
        match self {
            Self::Constant => 2,
            Self::Fractional => 3,
            Self::FractionalZener => 4,
            Self::Maxwell { branches } => 1 + 2 * branches,
        }
    }

    /// The word that case files use; the number of branches is not in it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Fractional => "fractional",
            Self::FractionalZener => "zener",
            Self::Maxwell { .. } => "maxwell",
        }
    }

    /// Names and units of the parameters, in their order.
    pub fn parameters(self) -> Vec<ParameterName> {
        let named = |name: &str, unit| ParameterName { name: name.to_owned(), unit };
        match self {
            Self::Constant => vec![named("storage", "Pa"), named("loss_factor", "")],
            Self::Fractional => vec![named("e0", "Pa"), named("e1", "Pa s^alpha"), named("alpha", "")],
            Self::FractionalZener => {
                vec![named("e0", "Pa"), named("e_infinity", "Pa"), named("tau", "s"), named("alpha", "")]
            }
            Self::Maxwell { branches } => {
                let branch = |k: usize| [named(&format!("e_{k}"), "Pa"), named(&format!("tau_{k}"), "s")];
                std::iter::once(named("e0", "Pa")).chain((1..=branches).flat_map(branch)).collect()
            }
        }
    }

    /// The law with these parameters.
    ///
    /// # Panics
    /// Where their number is not [`LawKind::count`].
    pub fn law(self, p: &[f64]) -> Law {
        assert_eq!(p.len(), self.count());
        match self {
            Self::Constant => Law::complex_modulus(p[0], p[1]),
            Self::Fractional => Law::Fractional { e0: p[0], e1: p[1], alpha: p[2] },
            Self::FractionalZener => {
                Law::FractionalZener { e0: p[0], e_infinity: p[1], tau_s: p[2], alpha: p[3] }
            }
            Self::Maxwell { .. } => {
                let branch = |b: &[f64]| Branch { modulus: b[0], tau_s: b[1] };
                Law::Maxwell { e0: p[0], branches: p[1..].chunks_exact(2).map(branch).collect() }
            }
        }
    }

    /// E(ω), and ∂E/∂p for each parameter.
    ///
    /// With s(z) = z/(1 + z), s′ = (1 − s)/(1 + z): ∂z/∂τ = αz/τ and ∂z/∂α = z ln(iωτ) for z = (iωτ)^α.
    ///
    /// # Panics
    /// Where the number of parameters is not [`LawKind::count`].
    pub fn with_slopes(self, p: &[f64], omega_rad_s: f64) -> (c64, Vec<c64>) {
        assert_eq!(p.len(), self.count());
        let one = c64::new(1.0, 0.0);
        // ln(iωτ) for ωτ > 0.
        let log = |omega_tau: f64| c64::new(omega_tau.ln(), FRAC_PI_2);
        match self {
            Self::Constant => {
                let per_storage = c64::new(1.0, p[1]);
                (p[0] * per_storage, vec![per_storage, c64::new(0.0, p[0])])
            }
            Self::Fractional => {
                let power = fractional_power(omega_rad_s, p[2]);
                (p[0] + p[1] * power, vec![one, power, p[1] * power * log(omega_rad_s)])
            }
            Self::FractionalZener => {
                let (e0, e_infinity, tau, alpha) = (p[0], p[1], p[2], p[3]);
                let z = fractional_power(omega_rad_s * tau, alpha);
                let s = saturation(z);
                // z s′ = s (1 − s): no z is left that could overflow.
                let turn = (e_infinity - e0) * s * (1.0 - s);
                let slopes = vec![1.0 - s, s, turn * alpha / tau, turn * log(omega_rad_s * tau)];
                (e0 + (e_infinity - e0) * s, slopes)
            }
            Self::Maxwell { .. } => {
                let (mut modulus, mut slopes) = (c64::new(p[0], 0.0), vec![one]);
                for branch in p[1..].chunks_exact(2) {
                    let s = saturation(c64::new(0.0, omega_rad_s * branch[1]));
                    modulus += branch[0] * s;
                    slopes.extend([s, branch[0] * s * (1.0 - s) / branch[1]]);
                }
                (modulus, slopes)
            }
        }
    }
}

impl fmt::Display for LawKind {
    /// As [`FromStr`] reads it: `fractional`, `maxwell:3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Maxwell { branches } => write!(f, "maxwell:{branches}"),
            _ => write!(f, "{}", self.word()),
        }
    }
}

/// A word that names no law.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownLawKind {
    /// The word.
    pub found: String,
}

impl UnknownLawKind {
    /// What would have been understood.
    pub const EXPECTED: &str =
        "\"constant\", \"fractional\", \"zener\" or \"maxwell\" (\"maxwell:N\" with N from 1 to 20 branches)";
}

impl fmt::Display for UnknownLawKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}, found {:?}", Self::EXPECTED, self.found)
    }
}

impl std::error::Error for UnknownLawKind {}

impl FromStr for LawKind {
    type Err = UnknownLawKind;

    fn from_str(text: &str) -> Result<Self, UnknownLawKind> {
        let unknown = || UnknownLawKind { found: text.to_owned() };
        match text {
            "constant" => Ok(Self::Constant),
            "fractional" => Ok(Self::Fractional),
            "zener" => Ok(Self::FractionalZener),
            "maxwell" => Ok(Self::Maxwell { branches: USUAL_BRANCHES }),
            _ => {
                let number = text.strip_prefix("maxwell:").ok_or_else(unknown)?;
                let branches = number.parse().ok().filter(|n| (1..=MAX_BRANCHES).contains(n));
                branches.map(|branches| Self::Maxwell { branches }).ok_or_else(unknown)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_branches_named_is_the_one_allowed() {
        assert!(UnknownLawKind::EXPECTED.contains(&format!("1 to {MAX_BRANCHES}")));
        assert_eq!("maxwell".parse(), Ok(LawKind::Maxwell { branches: USUAL_BRANCHES }));
        for kind in LawKind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        for word in ["maxwell:0", "maxwell:21", "maxwell:", "maxwell:x", "Zener", ""] {
            assert!(word.parse::<LawKind>().is_err(), "{word}");
        }
    }
}
