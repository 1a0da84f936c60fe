//! What the user knows about the answer beforehand.

use crate::c64;
use crate::material::loss_factor;

/// Closed intervals for the updated factor p̄ + c; `None` is no bound.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounds {
    /// For the real part: the storage modulus E′ in Pa, or a real factor.
    pub storage: Option<[f64; 2]>,
    /// For the loss factor η = Im/Re.
    pub loss_factor: Option<[f64; 2]>,
}

impl Bounds {
    /// Which bound a factor breaks, in words; `None` if it breaks none.
    pub fn broken_by(&self, factor: c64) -> Option<&'static str> {
        let outside = |value: f64, bound: Option<[f64; 2]>| {
            // Not `!contains` on NaN by accident: NaN is outside.
            bound.is_some_and(|[low, high]| !(low <= value && value <= high))
        };
        if outside(factor.re, self.storage) {
            Some("storage")
        } else if outside(loss_factor(factor), self.loss_factor) {
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
    fn names_the_bound_that_is_broken() {
        let bounds = Bounds { storage: Some([1.0, 2.0]), loss_factor: Some([0.0, 0.5]) };
        assert_eq!(bounds.broken_by(c64::new(1.5, 0.3)), None);
        assert_eq!(bounds.broken_by(c64::new(2.5, 0.3)), Some("storage"));
        assert_eq!(bounds.broken_by(c64::new(1.5, -0.3)), Some("loss_factor"));
        assert_eq!(bounds.broken_by(c64::new(f64::NAN, 0.0)), Some("storage"));
        assert_eq!(Bounds::default().broken_by(c64::new(-1.0, 9.0)), None);
    }
}
