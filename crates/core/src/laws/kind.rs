//! Which laws there are, their parameters, and how the modulus depends on them.

use crate::c64;
use crate::material::{Branch, Law, fractional_power, loss_factor, over_real_frequency, saturation};
use std::borrow::Cow;
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

/// Branches at most. Measured moduli identify about one relaxation time in a decade.
pub const MAX_BRANCHES: usize = 20;

/// Branches where no number is given.
pub const USUAL_BRANCHES: usize = 3;

/// What a parameter is: its unit, its range, and the coordinate in which it is searched; ω₀ is in the middle of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ParameterKind {
    /// A modulus in Pa, by its logarithm.
    Modulus,
    /// A modulus in Pa above E₀, the first parameter, by the logarithm of what it is above.
    ModulusAboveFirst,
    /// A modulus times s^α in Pa s^α, α being the exponent of the law, by ln(E₁ ω₀^α).
    ModulusTimesPower,
    /// A time in s, above 0, by ln(τ ω₀).
    Time,
    /// An exponent from 0 to 1, by its logit.
    Exponent,
    /// A loss factor, of any sign, as it is.
    LossFactor,
}

impl ParameterKind {
    /// Such as `Pa`, `s`; empty without one. `Pa` stands for the unit of the modulus.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Modulus | Self::ModulusAboveFirst => "Pa",
            Self::ModulusTimesPower => "Pa s^alpha",
            Self::Time => "s",
            Self::Exponent | Self::LossFactor => "",
        }
    }

    /// Whether the law's modulus is in proportion to all parameters of such kinds.
    pub fn is_modulus(self) -> bool {
        matches!(self, Self::Modulus | Self::ModulusAboveFirst | Self::ModulusTimesPower)
    }

    /// Whether a law may have this value. What a fit ends in is narrower: its moduli are positive.
    pub fn allows(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Time => value > 0.0,
                Self::Exponent => (0.0..=1.0).contains(&value),
                _ => true,
            }
    }

    /// The values that it [allows](Self::allows), in words.
    pub fn expected(self) -> &'static str {
        match self {
            Self::Time => "a time above 0 s",
            Self::Exponent => "a number from 0 (elastic) to 1 (viscous)",
            _ => "a finite number",
        }
    }
}

/// A parameter of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// As case files write it: `e0`, `tau_1`.
    pub name: Cow<'static, str>,
    /// What it is.
    pub kind: ParameterKind,
    /// A value that rubber may have, for examples.
    pub example: f64,
    /// Its meaning, as a sentence.
    pub about: &'static str,
}

const fn parameter(name: &'static str, kind: ParameterKind, example: f64, about: &'static str) -> Parameter {
    Parameter { name: Cow::Borrowed(name), kind, example, about }
}

const CONSTANT: &[Parameter] = &[
    parameter("storage", ParameterKind::Modulus, 2.1e11, "E′."),
    parameter("loss_factor", ParameterKind::LossFactor, 1e-3, "η."),
];

const FRACTIONAL: &[Parameter] = &[
    parameter("e0", ParameterKind::Modulus, 8.14e5, "Modulus at rest."),
    parameter("e1", ParameterKind::ModulusTimesPower, 7.31e4, "Modulus times s^alpha."),
    parameter("alpha", ParameterKind::Exponent, 0.528, "From elastic to viscous."),
];

const FRACTIONAL_ZENER: &[Parameter] = &[
    parameter("e0", ParameterKind::Modulus, 1e6, "Modulus at rest."),
    parameter("e_infinity", ParameterKind::ModulusAboveFirst, 2e8, "Modulus at infinite frequency."),
    parameter("tau", ParameterKind::Time, 1e-5, "Relaxation time."),
    parameter("alpha", ParameterKind::Exponent, 0.6, "Width of the transition: 1 is Zener's model."),
];

/// Without the branches.
const MAXWELL: &[Parameter] = &[parameter("e0", ParameterKind::Modulus, 1e6, "Modulus at rest.")];

/// Modulus and time of each branch of Maxwell's law.
const BRANCH: [Parameter; 2] = [
    parameter("e", ParameterKind::Modulus, 2e6, "Modulus of the branch."),
    parameter("tau", ParameterKind::Time, 1e-2, "Relaxation time of the branch."),
];

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

    /// One law of each family of [`Self::ALL`]: of the generalised Maxwell law that with the usual number of branches.
    pub fn families() -> impl Iterator<Item = Self> {
        let is_usual =
            |kind: &Self| !matches!(kind, Self::Maxwell { branches } if *branches != USUAL_BRANCHES);
        Self::ALL.into_iter().filter(is_usual)
    }

    /// The kind and the parameters of a law; `None` of a table.
    pub fn of(law: &Law) -> Option<(Self, Vec<f64>)> {
        Some(match law {
            Law::Constant(e) => (Self::Constant, vec![e.re, loss_factor(*e)]),
            Law::Fractional { e0, e1, alpha } => (Self::Fractional, vec![*e0, *e1, *alpha]),
            Law::FractionalZener { e0, e_infinity, tau_s, alpha } => {
                (Self::FractionalZener, vec![*e0, *e_infinity, *tau_s, *alpha])
            }
            Law::Maxwell { e0, branches } => {
                let pairs = branches.iter().flat_map(|branch| [branch.modulus, branch.tau_s]);
                (Self::Maxwell { branches: branches.len() }, std::iter::once(*e0).chain(pairs).collect())
            }
            Law::Table(_) => return None,
        })
    }

    /// The formula with the names of the parameters, as a sentence in Markdown.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Constant => "E = storage (1 + i loss_factor), P-31.",
            Self::Fractional => "E = e0 + e1 (iω)^alpha.",
            Self::FractionalZener => "E = (e0 + e_infinity (iω tau)^alpha) / (1 + (iω tau)^alpha).",
            Self::Maxwell { .. } => {
                "E = e0 + Σ modulus · iω time / (1 + iω time) over the branches (generalised Maxwell, Prony)."
            }
        }
    }

    /// The parameters that are not those of branches.
    fn own(self) -> &'static [Parameter] {
        match self {
            Self::Constant => CONSTANT,
            Self::Fractional => FRACTIONAL,
            Self::FractionalZener => FRACTIONAL_ZENER,
            Self::Maxwell { .. } => MAXWELL,
        }
    }

    fn branches(self) -> usize {
        if let Self::Maxwell { branches } = self { branches } else { 0 }
    }

    /// Number of parameters.
    pub fn count(self) -> usize {
        self.own().len() + BRANCH.len() * self.branches()
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

    /// Which parameter is the first of a kind.
    pub(crate) fn place_of(self, kind: ParameterKind) -> Option<usize> {
        (0..self.count()).find(|&i| self.parameter_kind(i) == kind)
    }

    /// What the parameter `i` is.
    pub(crate) fn parameter_kind(self, i: usize) -> ParameterKind {
        let own = self.own();
        own.get(i).map_or_else(|| BRANCH[(i - own.len()) % BRANCH.len()].kind, |parameter| parameter.kind)
    }

    /// The parameters in their order.
    pub fn parameters(self) -> Vec<Parameter> {
        // Times a decade apart: data resolve no closer ones.
        let example = |parameter: &Parameter, k: usize| match parameter.kind {
            ParameterKind::Time => parameter.example / 10_f64.powi(k as i32),
            _ => parameter.example,
        };
        let branch = |k: usize| {
            BRANCH.map(|parameter| Parameter {
                name: format!("{}_{}", parameter.name, k + 1).into(),
                example: example(&parameter, k),
                ..parameter
            })
        };
        self.own().iter().cloned().chain((0..self.branches()).flat_map(branch)).collect()
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

    /// E at s = iω + α ([`crate::frequency::laplace_per_s`]), without a window of decay α at iω, and ∂E/∂p for each parameter.
    ///
    /// With h(z) = z/(1 + z), h′ = (1 − h)/(1 + z): ∂z/∂τ = αz/τ and ∂z/∂α = z ln(sτ) for z = (sτ)^α. The constant one is E′(1 + iη)(s/iω)^p with p = (2/π) arctan η.
    ///
    /// # Panics
    /// Where the number of parameters is not [`LawKind::count`].
    pub fn with_slopes(self, p: &[f64], s: c64) -> (c64, Vec<c64>) {
        assert_eq!(p.len(), self.count());
        let one = c64::new(1.0, 0.0);
        // ln(sτ) for |sτ| > 0.
        let log = |s_tau: c64| c64::new(s_tau.norm().ln(), s_tau.arg());
        match self {
            Self::Constant => {
                let (per_storage, of_loss) = (c64::new(1.0, p[1]), c64::new(0.0, 1.0));
                let Some(ratio) = over_real_frequency(s) else {
                    return (p[0] * per_storage, vec![per_storage, p[0] * of_loss]);
                };
                let by_angle = log(ratio) / FRAC_PI_2;
                let power = (by_angle * p[1].atan()).exp();
                let of_loss = of_loss + per_storage * by_angle / (1.0 + p[1] * p[1]);
                (p[0] * power * per_storage, vec![power * per_storage, p[0] * power * of_loss])
            }
            Self::Fractional => {
                let power = fractional_power(s, p[2]);
                (p[0] + p[1] * power, vec![one, power, p[1] * power * log(s)])
            }
            Self::FractionalZener => {
                let (e0, e_infinity, tau, alpha) = (p[0], p[1], p[2], p[3]);
                let h = saturation(fractional_power(s * tau, alpha));
                // z h′ = h (1 − h): no z is left that could overflow.
                let turn = (e_infinity - e0) * h * (1.0 - h);
                let slopes = vec![1.0 - h, h, turn * alpha / tau, turn * log(s * tau)];
                (e0 + (e_infinity - e0) * h, slopes)
            }
            Self::Maxwell { .. } => {
                let (mut modulus, mut slopes) = (c64::new(p[0], 0.0), vec![one]);
                for branch in p[1..].chunks_exact(2) {
                    let h = saturation(s * branch[1]);
                    modulus += branch[0] * h;
                    slopes.extend([h, branch[0] * h * (1.0 - h) / branch[1]]);
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
        if let Some(kind) = Self::families().find(|kind| kind.word() == text) {
            return Ok(kind);
        }
        let number = text.strip_prefix("maxwell:").ok_or_else(unknown)?;
        let branches = number.parse().ok().filter(|n| (1..=MAX_BRANCHES).contains(n));
        branches.map(|branches| Self::Maxwell { branches }).ok_or_else(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_those_of_the_law() {
        for kind in LawKind::ALL {
            let parameters = kind.parameters();
            assert_eq!(parameters.len(), kind.count());
            for (i, parameter) in parameters.iter().enumerate() {
                assert!(parameter.kind.allows(parameter.example), "{parameter:?}");
                assert_eq!(parameter.kind, kind.parameter_kind(i));
            }
            let p: Vec<f64> = parameters.iter().map(|parameter| parameter.example).collect();
            let (same, back) = LawKind::of(&kind.law(&p)).unwrap();
            assert_eq!(same, kind);
            // The loss factor is a quotient of a product.
            assert!(p.iter().zip(&back).all(|(a, b)| (a - b).abs() <= 1e-15 * a), "{p:?} {back:?}");
            assert!(UnknownLawKind::EXPECTED.contains(&format!("{:?}", kind.word())), "{kind}");
        }
    }

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
