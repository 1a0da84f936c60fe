//! What the user knows about the answer beforehand.

use crate::c64;
use crate::material::loss_factor;
use std::fmt;

/// So far beyond a bound, relative to it, a value is still at it: the rounding of a product and of an exponential.
const ROUNDING: f64 = 1e-12;

/// Closed intervals for the updated factor p̄ + c; `None` is no bound.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounds {
    /// For the real part: the storage modulus E′ in Pa, or a real factor.
    pub storage: Option<[f64; 2]>,
    /// For the loss factor η = Im/Re.
    pub loss_factor: Option<[f64; 2]>,
}

/// A bound [low, high] with low > high, or with a value that is not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BoundsError {
    /// Which: `storage` or `loss_factor`.
    pub name: &'static str,
    /// What it is.
    pub found: [f64; 2],
}

impl BoundsError {
    /// What a bound has to be.
    pub const EXPECTED: &'static str = "[low, high] with low <= high";
}

impl fmt::Display for BoundsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, found: [low, high] } = self;
        write!(f, "bounds.{name}: expected {}, found [{low}, {high}]", Self::EXPECTED)
    }
}

impl std::error::Error for BoundsError {}

impl Bounds {
    /// Checks what types cannot.
    ///
    /// # Errors
    /// [`BoundsError`], the first of them.
    pub fn validate(&self) -> Result<(), BoundsError> {
        for (name, bound) in [("storage", self.storage), ("loss_factor", self.loss_factor)] {
            if let Some(found) = bound
                && !(found[0] <= found[1] && found.iter().all(|value| value.is_finite()))
            {
                return Err(BoundsError { name, found });
            }
        }
        Ok(())
    }

    /// Which bound a factor breaks, in words; `None` if it breaks none.
    ///
    /// A value at its bound is within it, whatever rounding does: 10⁻¹² of it beyond counts as none.
    pub fn broken_by(&self, factor: c64) -> Option<&'static str> {
        let outside = |value: f64, bound: Option<[f64; 2]>, least: f64| {
            bound.is_some_and(|[low, high]| {
                let beyond = |bound: f64| ROUNDING * bound.abs().max(least);
                // Not `!contains` on NaN by accident: NaN is outside.
                !(low - beyond(low) <= value && value <= high + beyond(high))
            })
        };
        if outside(factor.re, self.storage, 0.0) {
            Some("storage")
        // A loss factor is a share of the storage part, and rounds as that.
        } else if outside(loss_factor(factor), self.loss_factor, 1.0) {
            Some("loss_factor")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_that_bounds_nothing_is_refused() {
        let of = |loss_factor| Bounds { storage: None, loss_factor };
        assert_eq!(of(Some([0.0, 0.0])).validate(), Ok(()));
        assert_eq!(
            of(Some([1.0, 0.0])).validate().unwrap_err().to_string(),
            "bounds.loss_factor: expected [low, high] with low <= high, found [1, 0]"
        );
        assert!(
            of(Some([0.0, f64::INFINITY])).validate().is_err() && of(Some([f64::NAN; 2])).validate().is_err()
        );
    }

    #[test]
    fn names_the_bound_that_is_broken() {
        let bounds = Bounds { storage: Some([1.0, 2.0]), loss_factor: Some([0.0, 0.5]) };
        assert_eq!(bounds.broken_by(c64::new(1.5, 0.3)), None);
        assert_eq!(bounds.broken_by(c64::new(2.5, 0.3)), Some("storage"));
        assert_eq!(bounds.broken_by(c64::new(1.5, -0.3)), Some("loss_factor"));
        assert_eq!(bounds.broken_by(c64::new(f64::NAN, 0.0)), Some("storage"));
        assert_eq!(Bounds::default().broken_by(c64::new(-1.0, 9.0)), None);
        // A constant that a fit holds at its bounds: 0.1 · 2.293e8 / 2.293e8 is 0.1 but for rounding.
        let at_bound = Bounds { storage: Some([3.0, 4.0]), loss_factor: Some([0.0, 0.1]) };
        for factor in [c64::new(3.0 - 1e-15, 0.3 + 1e-15), c64::new(4.0 + 1e-15, -1e-16)] {
            assert_eq!(at_bound.broken_by(factor), None);
        }
        assert_eq!(at_bound.broken_by(c64::new(3.0, 0.3 + 1e-9)), Some("loss_factor"));
    }
}
