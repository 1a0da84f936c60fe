//! The words that say how to identify.

use std::fmt;
use std::str::FromStr;

/// How the response's dependence on the parameter is represented.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// The paper's: truncated Neumann series, roots of a polynomial.
    Series,
    /// B-1 and B-2: rational response on the Neumann vectors, all roots of one small eigenproblem; converges through resonances and
    /// sees every solution within the bounds.
    #[default]
    Rational,
    /// A simplex search on direct solves, for comparison ([`crate::nelder_mead`]).
    NelderMead,
}

/// How one of several admissible roots is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Selection {
    /// All sensors and all frequencies together (B-4, B-5).
    #[default]
    Joint,
    /// The paper's: that of least |c|, each frequency alone.
    Smallest,
}

/// What answers at a frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Reduction {
    /// The band's subspace where that is cheaper than the full model: for the rational method, a handful of frequencies or more, and more than a
    /// handful of degrees of freedom. The paper's series and Nelder–Mead run on the full model, as the paper has them.
    #[default]
    Auto,
    /// The full model: a complex factorisation at every frequency.
    Full,
    /// One subspace for the band (B-3).
    Subspace,
}

/// A word that names no choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownChoice {
    /// The word.
    pub found: String,
    /// The choices.
    pub expected: &'static str,
}

impl fmt::Display for UnknownChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}, found {:?}", self.expected, self.found)
    }
}

impl std::error::Error for UnknownChoice {}

impl Method {
    /// The name that case files use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Series => "series",
            Self::Rational => "rational",
            Self::NelderMead => "nelder-mead",
        }
    }
}

impl FromStr for Method {
    type Err = UnknownChoice;

    fn from_str(name: &str) -> Result<Self, UnknownChoice> {
        match name {
            "series" => Ok(Self::Series),
            "rational" => Ok(Self::Rational),
            "nelder-mead" => Ok(Self::NelderMead),
            _ => Err(UnknownChoice {
                found: name.to_owned(),
                expected: "\"series\", \"rational\" or \"nelder-mead\"",
            }),
        }
    }
}

impl Selection {
    /// The name that case files use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Smallest => "smallest",
        }
    }
}

impl FromStr for Selection {
    type Err = UnknownChoice;

    fn from_str(name: &str) -> Result<Self, UnknownChoice> {
        match name {
            "joint" => Ok(Self::Joint),
            "smallest" => Ok(Self::Smallest),
            _ => Err(UnknownChoice { found: name.to_owned(), expected: "\"joint\" or \"smallest\"" }),
        }
    }
}

impl Reduction {
    /// The name that case files use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Full => "full",
            Self::Subspace => "subspace",
        }
    }

    /// Whether the subspace answers, for a model of so many degrees of freedom at so many frequencies.
    pub fn is_subspace(self, method: Method, dofs: usize, frequencies: usize) -> bool {
        match self {
            Self::Full => false,
            Self::Subspace => true,
            Self::Auto => {
                method == Method::Rational
                    && dofs > MAX_TINY_MODEL_DOFS
                    && frequencies >= MIN_SUBSPACE_FREQUENCIES
            }
        }
    }
}

impl FromStr for Reduction {
    type Err = UnknownChoice;

    fn from_str(name: &str) -> Result<Self, UnknownChoice> {
        match name {
            "auto" => Ok(Self::Auto),
            "full" => Ok(Self::Full),
            "subspace" => Ok(Self::Subspace),
            _ => {
                Err(UnknownChoice { found: name.to_owned(), expected: "\"auto\", \"full\" or \"subspace\"" })
            }
        }
    }
}

/// Degrees of freedom up to which a subspace is no smaller than the model.
pub(super) const MAX_TINY_MODEL_DOFS: usize = 64;

/// Frequencies from which on the subspace's solves (tens) cost less than theirs (two complex factorisations each).
const MIN_SUBSPACE_FREQUENCIES: usize = 4;
