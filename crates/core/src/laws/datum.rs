//! A modulus at one frequency, and how well it is known.

use crate::c64;
use crate::frequency::omega_rad_s;
use crate::material::loss_factor;

/// E at one frequency with the covariance of what was measured of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// ω.
    pub omega_rad_s: f64,
    /// E′ + iE″.
    pub modulus: c64,
    measured: Measured,
    /// W with WᵀW the inverse covariance of the two numbers that were measured: lower triangular, (w₁₁, w₂₁, w₂₂).
    whitening: [f64; 3],
}

/// Which two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measured {
    /// E′ and E″.
    Parts,
    /// E′ and η.
    StorageAndLossFactor,
}

impl Datum {
    /// Known to a share of itself, unknown but the same for all data.
    pub fn relative(omega_rad_s: f64, modulus: c64) -> Self {
        Self::circular(omega_rad_s, modulus, modulus.norm())
    }

    /// Known to a standard deviation of the real and of the imaginary part each, independent of each other.
    pub fn circular(omega_rad_s: f64, modulus: c64, part_std: f64) -> Self {
        let whitening = [1.0 / part_std, 0.0, 1.0 / part_std];
        Self { omega_rad_s, modulus, measured: Measured::Parts, whitening }
    }

    /// Storage modulus and loss factor with a standard deviation each and their correlation.
    ///
    /// # Panics
    /// Where a storage modulus or a standard deviation is not positive, or the correlation not between −1 and 1.
    pub fn storage_and_loss(frequency_hz: f64, value: [f64; 2], std: [f64; 2], correlation: f64) -> Self {
        let ([storage, eta], [s, t]) = (value, std);
        assert!(storage > 0.0 && s > 0.0 && t > 0.0 && correlation.abs() < 1.0);
        let rest = (1.0 - correlation * correlation).sqrt();
        Self {
            omega_rad_s: omega_rad_s(frequency_hz),
            modulus: c64::new(storage, storage * eta),
            measured: Measured::StorageAndLossFactor,
            whitening: [1.0 / s, -correlation / (s * rest), 1.0 / (t * rest)],
        }
    }

    /// W times what is measured of a modulus less what was.
    pub(crate) fn residual(&self, modulus: c64) -> [f64; 2] {
        let second = match self.measured {
            Measured::Parts => modulus.im - self.modulus.im,
            // E″ is not fitted in its place: a product of two noisy numbers is biased.
            Measured::StorageAndLossFactor => loss_factor(modulus) - loss_factor(self.modulus),
        };
        self.times([modulus.re - self.modulus.re, second])
    }

    /// The change of [`Datum::residual`] with a change of the modulus.
    pub(crate) fn slope(&self, modulus: c64, change: c64) -> [f64; 2] {
        let second = match self.measured {
            Measured::Parts => change.im,
            Measured::StorageAndLossFactor => (change.im - loss_factor(modulus) * change.re) / modulus.re,
        };
        self.times([change.re, second])
    }

    /// A part of a modulus as [`Datum::slope`] weighs it at the measured one: linear, with which a start is found.
    pub(crate) fn whitened(&self, part: c64) -> [f64; 2] {
        self.slope(self.modulus, part)
    }

    fn times(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let [w11, w21, w22] = self.whitening;
        [w11 * a, w21 * a + w22 * b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn storage_and_loss_factor_are_whitened_with_their_correlation() {
        let (s, t, rho) = (4e4, 0.02, -0.4);
        let datum = Datum::storage_and_loss(1.0, [2e6, 0.3], [s, t], rho);
        let [a, b, c] = datum.whitening;
        // (WᵀW)⁻¹ = W⁻¹W⁻ᵀ of a lower triangle.
        let (p, q, r) = (1.0 / a, -b / (a * c), 1.0 / c);
        for (found, expected) in [p * p, p * q, q * q + r * r].iter().zip([s * s, rho * s * t, t * t]) {
            assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} {expected}");
        }
        // Two standard deviations of η, and none of E′.
        let [first, second] = datum.residual(2e6 * c64::new(1.0, 0.3 + 2.0 * t));
        assert!(first.abs() < 1e-9 && (second - 2.0 / (1.0 - rho * rho).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn slopes_are_those_of_the_residual() {
        for datum in [
            Datum::storage_and_loss(1.0, [2.0, 0.3], [0.1, 0.2], 0.5),
            Datum::circular(1.0, c64::new(2.0, 0.6), 0.1),
        ] {
            let (at, change) = (c64::new(2.5, 0.9), c64::new(0.3, -0.7));
            // Central differences: h² times a third derivative of order ten, and ε/h.
            let h = 1e-4;
            let (up, down) = (datum.residual(at + h * change), datum.residual(at - h * change));
            for k in 0..2 {
                let difference = (up[k] - down[k]) / (2.0 * h);
                assert!((difference - datum.slope(at, change)[k]).abs() < 1e-6, "{datum:?}");
            }
        }
    }

    #[test]
    fn independent_parts_are_each_divided_by_their_deviation() {
        let datum = Datum::circular(1.0, c64::new(3.0, 4.0), 2.0);
        assert_eq!(datum.whitened(datum.modulus), [1.5, 2.0]);
        let [re, im] = Datum::relative(1.0, datum.modulus).whitened(datum.modulus);
        assert!((re - 0.6).abs() < 1e-15 && (im - 0.8).abs() < 1e-15);
    }
}
