//! A modulus at one frequency, and how well it is known.

use crate::c64;
use crate::frequency::omega_rad_s;

/// E at one frequency with the covariance of its parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// ω.
    pub omega_rad_s: f64,
    /// E′ + iE″.
    pub modulus: c64,
    /// W with Wᵀ W the inverse covariance of (E′, E″): lower triangular, (w₁₁, w₂₁, w₂₂).
    whitening: [f64; 3],
}

impl Datum {
    /// Known to a share of itself that is not told: the same for all data.
    pub fn relative(omega_rad_s: f64, modulus: c64) -> Self {
        Self::circular(omega_rad_s, modulus, modulus.norm())
    }

    /// Known to a standard deviation of the real and of the imaginary part each, independent of each other.
    pub fn circular(omega_rad_s: f64, modulus: c64, part_std: f64) -> Self {
        Self { omega_rad_s, modulus, whitening: [1.0 / part_std, 0.0, 1.0 / part_std] }
    }

    /// Storage modulus and loss factor with a standard deviation each and their correlation, carried to E″ = ηE′ by the delta rule.
    ///
    /// # Panics
    /// Where a deviation is not positive, or the correlation not between −1 and 1.
    ///
    /// # Limits
    /// E″ = ηE′ is a product: where both are uncertain by tens of percent, its deviation is more than this.
    pub fn storage_and_loss(frequency_hz: f64, value: [f64; 2], std: [f64; 2], correlation: f64) -> Self {
        let ([storage, eta], [s, t]) = (value, std);
        assert!(s > 0.0 && t > 0.0 && correlation.abs() < 1.0);
        // In the coordinates E′ and q = E″ − ηE′ (η as given), Cov = [[s², ρ s E′t], [·, (E′t)²]]: whitened row after row.
        let t = storage.abs() * t;
        let rest = (1.0 - correlation * correlation).sqrt();
        let (w11, on_s, on_q) = (1.0 / s, -correlation / (s * rest), 1.0 / (t * rest));
        let whitening = [w11, on_s - on_q * eta, on_q];
        Self { omega_rad_s: omega_rad_s(frequency_hz), modulus: c64::new(storage, storage * eta), whitening }
    }

    /// W times the parts of a complex number.
    pub(crate) fn whitened(&self, value: c64) -> [f64; 2] {
        let [w11, w21, w22] = self.whitening;
        [w11 * value.re, w21 * value.re + w22 * value.im]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn storage_and_loss_factor_are_whitened_with_their_correlation() {
        let (storage, eta, s, t, rho) = (2e6, 0.3, 4e4, 0.02, -0.4);
        let datum = Datum::storage_and_loss(1.0, [storage, eta], [s, t], rho);
        // (WᵀW)⁻¹ by the delta rule: Cov(E′) = s², Cov(E′, E″) = ηs² + E′ρst, Cov(E″) = η²s² + 2ηE′ρst + E′²t².
        let [a, b, c] = datum.whitening;
        // W⁻¹ of a lower triangle, and W⁻¹W⁻ᵀ.
        let (p, q, r) = (1.0 / a, -b / (a * c), 1.0 / c);
        let found = [p * p, p * q, q * q + r * r];
        let cross = rho * s * t;
        let expected = [
            s * s,
            eta * s * s + storage * cross,
            eta * eta * s * s + 2.0 * eta * storage * cross + (storage * t).powi(2),
        ];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} {expected}");
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
