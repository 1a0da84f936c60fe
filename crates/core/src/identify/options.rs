//! How to identify.

use crate::roots::{Bounds, RootOptions};
use std::fmt;
use std::str::FromStr;

/// How the response's dependence on the parameter is represented.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The paper's: truncated Neumann series, roots of a polynomial.
    #[default]
    Series,
    /// B-1 and B-2: rational response on the Neumann vectors, all roots of one small eigenproblem; converges through resonances and
    /// sees every solution within the bounds.
    Rational,
    /// A simplex search on direct solves, for comparison ([`crate::nelder_mead`]).
    NelderMead,
}

/// How one of several admissible roots is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Selection {
    /// The paper's: that of least |c|.
    #[default]
    Smallest,
}

/// A word that is none of the choices there are.
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
            Self::Smallest => "smallest",
        }
    }
}

impl FromStr for Selection {
    type Err = UnknownChoice;

    fn from_str(name: &str) -> Result<Self, UnknownChoice> {
        match name {
            "smallest" => Ok(Self::Smallest),
            _ => Err(UnknownChoice { found: name.to_owned(), expected: "\"smallest\"" }),
        }
    }
}

/// Options of an identification; all have defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Series (default), rational or Nelder–Mead.
    pub method: Method,
    /// Order n of the series, upper bound of it for the rational response, or iterations of Nelder–Mead. Default 30, the paper's.
    pub order: usize,
    /// Smallest |c| (default).
    pub selection: Selection,
    /// Bounds on the updated factor. Default none.
    pub bounds: Bounds,
    /// Whether the parameter is real. Default false.
    pub real: bool,
    /// Largest ε (P-40) at the sensor that gave the root, from a fresh direct solve, for status `ok`. Default 1e-2, the error
    /// that the paper reports for a measurement at n = 30.
    pub error: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            order: 30,
            selection: Selection::default(),
            bounds: Bounds::default(),
            real: false,
            error: 1e-2,
        }
    }
}

/// The largest order: beyond it double precision has no digit left to add.
pub const MAX_ORDER: usize = 200;

/// What is wrong with options.
#[derive(Debug, Clone, PartialEq)]
pub enum OptionsError {
    /// Order 0, or above [`MAX_ORDER`].
    Order(usize),
    /// A bound [low, high] of this name with low > high or a value that is not finite.
    Bounds(&'static str, [f64; 2]),
    /// An error limit that is not positive.
    Error(f64),
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order(order) => write!(f, "order: expected 1 to {MAX_ORDER}, found {order}"),
            Self::Bounds(name, [low, high]) => {
                write!(f, "bounds.{name}: expected [low, high] with low <= high, found [{low}, {high}]")
            }
            Self::Error(error) => write!(f, "error: expected a positive number, found {error}"),
        }
    }
}

impl std::error::Error for OptionsError {}

impl Options {
    /// Checks what types cannot.
    ///
    /// # Errors
    /// [`OptionsError`] with the option's name, what was expected, and what was found.
    pub fn validate(&self) -> Result<(), OptionsError> {
        if !(1..=MAX_ORDER).contains(&self.order) {
            return Err(OptionsError::Order(self.order));
        }
        for (name, bound) in [("storage", self.bounds.storage), ("loss_factor", self.bounds.loss_factor)] {
            if let Some([low, high]) = bound
                && !(low <= high && low.is_finite() && high.is_finite())
            {
                return Err(OptionsError::Bounds(name, [low, high]));
            }
        }
        if self.error <= 0.0 || self.error.is_nan() {
            return Err(OptionsError::Error(self.error));
        }
        Ok(())
    }

    /// The part that concerns roots.
    pub fn roots(&self) -> RootOptions {
        RootOptions { bounds: self.bounds, real: self.real, ..RootOptions::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_the_papers_and_valid() {
        let options = Options::default();
        assert_eq!((options.order, options.selection), (30, Selection::Smallest));
        assert_eq!(options.validate(), Ok(()));
    }

    #[test]
    fn invalid_options_name_themselves() {
        let order = Options { order: 0, ..Options::default() };
        assert_eq!(order.validate().unwrap_err().to_string(), "order: expected 1 to 200, found 0");
        let bounds = Bounds { loss_factor: Some([1.0, 0.0]), ..Bounds::default() };
        assert_eq!(
            Options { bounds, ..Options::default() }.validate().unwrap_err().to_string(),
            "bounds.loss_factor: expected [low, high] with low <= high, found [1, 0]"
        );
        assert!(Options { error: f64::NAN, ..Options::default() }.validate().is_err());
    }
}
