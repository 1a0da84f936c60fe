//! The error that the loss factors of unknowns have in common, part of a reduced model with errors in it (B-11).

use crate::c64;

/// An unknown whose loss factor is in error: p becomes Re p + i(1 + ε) Im p. That is no analytic function of p, so where p has the loss factor η(f), its terms are multiplied by
/// (1 + i(1 + ε)η)/(1 + iη).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UnknownLoss {
    /// The terms that it enters.
    pub(crate) terms: Vec<usize>,
    /// η at ascending frequencies, Hz.
    pub(crate) loss_factors: Vec<(f64, f64)>,
}

impl UnknownLoss {
    /// (1 + i(1 + ε)η)/(1 + iη).
    pub(super) fn factor(&self, error: f64, frequency_hz: f64) -> c64 {
        1.0 + error * self.share(frequency_hz)
    }

    /// Its slope by ε, over itself.
    pub(super) fn slope_over_factor(&self, error: f64, frequency_hz: f64) -> c64 {
        self.share(frequency_hz) / self.factor(error, frequency_hz)
    }

    /// iη/(1 + iη), with η between two frequencies on a line, and beyond all of them that of the last one.
    fn share(&self, frequency_hz: f64) -> c64 {
        let all = &self.loss_factors;
        let above = all.partition_point(|(f, _)| *f < frequency_hz);
        let loss_factor = match (above.checked_sub(1).map(|below| all[below]), all.get(above)) {
            (Some((f, eta)), Some((next, eta_next))) => {
                eta + (eta_next - eta) * (frequency_hz - f) / (next - f)
            }
            (below, next) => below.or(next.copied()).map_or(0.0, |(_, eta)| eta),
        };
        c64::new(0.0, loss_factor) / c64::new(1.0, loss_factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loss factor, and it alone, is 1 + ε times as large where the unknown has the one that was given.
    #[test]
    fn the_loss_factor_is_in_error_and_the_storage_is_not() {
        let unknown = UnknownLoss { terms: vec![0], loss_factors: vec![(10.0, 0.2), (20.0, 0.6)] };
        for (frequency_hz, loss_factor) in [(5.0, 0.2), (10.0, 0.2), (12.5, 0.3), (20.0, 0.6), (30.0, 0.6)] {
            let value = 3.0 * c64::new(1.0, loss_factor);
            let moved = value * unknown.factor(0.1, frequency_hz);
            let expected = 3.0 * c64::new(1.0, 1.1 * loss_factor);
            assert!((moved - expected).norm() < 1e-12, "{frequency_hz}: {moved} {expected}");
        }
    }
}
