//! How an unknown that holds for the band hangs on the coordinates of a search.

use crate::c64;
use crate::laws::{LawKind, ParameterKind, Parametrization};

/// p(ω; θ).
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    /// p = e^θ.
    Logarithm,
    /// p = s θ, with s of the size of what is expected.
    Scaled(f64),
    /// A complex constant or a law.
    Law(Parametrization),
}

impl Form {
    /// How many coordinates.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Law(parametrization) => parametrization.kind.count(),
            Self::Logarithm | Self::Scaled(_) => 1,
        }
    }

    /// p at ω, and ∂p/∂θ; `None` where a number is not finite.
    pub(super) fn value(&self, theta: &[f64], omega_rad_s: f64) -> Option<(c64, Vec<c64>)> {
        let real = |value: f64, slope: f64| (c64::new(value, 0.0), vec![c64::new(slope, 0.0)]);
        let found = match self {
            Self::Logarithm => real(theta[0].exp(), theta[0].exp()),
            Self::Scaled(scale) => real(theta[0] * scale, *scale),
            Self::Law(parametrization) => return parametrization.modulus(theta, omega_rad_s),
        };
        found.0.is_finite().then_some(found)
    }

    /// The numbers that the coordinates stand for, with ∂(number)/∂θ, row by row.
    pub(super) fn numbers(&self, theta: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        match self {
            Self::Logarithm => (vec![theta[0].exp()], vec![vec![theta[0].exp()]]),
            Self::Scaled(scale) => (vec![theta[0] * scale], vec![vec![*scale]]),
            Self::Law(parametrization) => parametrization.parameters(theta),
        }
    }

    /// θ of this p times e^`by`.
    pub(super) fn scaled(&self, theta: &[f64], by: f64) -> Vec<f64> {
        match self {
            Self::Logarithm => vec![theta[0] + by],
            Self::Scaled(_) => vec![theta[0] * by.exp()],
            Self::Law(parametrization) => parametrization.scaled(theta, by),
        }
    }

    /// Which coordinate is its loss factor, of a complex constant.
    pub(super) fn of_loss_factor(&self) -> Option<usize> {
        self.kind()?.place_of(ParameterKind::LossFactor)
    }

    /// Its law, where it has one: a complex constant is one too.
    pub(super) fn kind(&self) -> Option<LawKind> {
        match self {
            Self::Law(parametrization) => Some(parametrization.kind),
            _ => None,
        }
    }
}
