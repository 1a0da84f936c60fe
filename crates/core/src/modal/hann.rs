//! What a Hann window makes of a resonance.
//!
//! The cross spectrum of records of length T under a window w is that of the impulse response h(τ) times the autocorrelation of w. For a force whose spectrum
//! is flat across a resonance, the expected FRF (H1) is that of h(τ)ρ(τ/T), with the autocorrelation of the Hann window over its largest value
//! $$ \rho(u) = (1 - u)\Big(\tfrac23 + \tfrac13 \cos 2\pi u\Big) + \frac{1}{2\pi} \sin 2\pi u , \quad 0 \le u \le 1 . $$
//! A resonance 1/z of the structure, z = iω − s_r, is measured as
//! $$ g(z) = T \int_0^1 \rho(u)\, e^{-zTu}\, du . $$
//! With a half-power bandwidth of B lines its peak is lower by some 4/(3B²), and its damping seems larger.
//!
//! # Source
//! J. S. Bendat, A. G. Piersol, Random Data, 4th ed., Wiley 2010, 8.5 and 11.6 (bias of spectra by resolution); the closed form is ours.

use crate::c64;
use std::f64::consts::{PI, TAU};

/// g(z) and its slope by the pole, −g′(z), for records of this length. The real part of z is positive.
pub(super) fn hann_resonance(z: c64, record_s: f64) -> [c64; 2] {
    let a = z * record_s;
    // cos and sin are halves of e^{±2πiu}: the same integrals at a ± 2πi, where e^{−a} is the same.
    let end = (-a).exp();
    let [own, below, above] = [0.0, -TAU, TAU].map(|turn| moments(a + c64::new(0.0, turn), end));
    let part = |k: usize| {
        let [ramp, ramp_below, ramp_above] = [own, below, above].map(|moment| moment[k] - moment[k + 1]);
        let sine = c64::new(0.0, -1.0 / (4.0 * PI)) * (below[k] - above[k]);
        2.0 / 3.0 * ramp + (ramp_below + ramp_above) / 6.0 + sine
    };
    [record_s * part(0), record_s * record_s * part(1)]
}

/// ∫₀¹ u^k e^{−au} du for k = 0, 1, 2, with e^{−a} given: the one before times k, less e^{−a}, over a; near a = 0 its series.
fn moments(a: c64, end: c64) -> [c64; 3] {
    if a.norm() >= SERIES_BELOW {
        let inverse = a.inv();
        let first = (1.0 - end) * inverse;
        let second = (first - end) * inverse;
        return [first, second, (2.0 * second - end) * inverse];
    }
    let mut sums = [c64::default(); 3];
    let mut term = c64::new(1.0, 0.0);
    for j in 0..SERIES_TERMS {
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum += term / (j + k + 1) as f64;
        }
        term *= -a / (j + 1) as f64;
    }
    sums
}

/// Here the recursion, which divides rounding by a three times, has lost no digit that counts, and the series has all of them.
const SERIES_BELOW: f64 = 1.0;
const SERIES_TERMS: usize = 20;

#[cfg(test)]
mod tests {
    use super::*;

    /// ρ by its definition: the integral of two Hann windows, one of them shifted.
    fn autocorrelation(u: f64) -> f64 {
        let n = 1000;
        let hann = |t: f64| (PI * t).sin().powi(2);
        let of = |shift: f64| {
            let step = (1.0 - shift) / n as f64;
            let at = |k: usize| hann((k as f64 + 0.5) * step) * hann((k as f64 + 0.5) * step + shift);
            (0..n).map(at).sum::<f64>() * step
        };
        of(u) / of(0.0)
    }

    #[test]
    fn a_resonance_is_the_transform_under_the_autocorrelation_of_the_window() {
        let record_s = 0.8;
        let n = 2000;
        // Midpoints: their error is that of a smooth integrand, 1/n².
        let u: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5) / n as f64).collect();
        let rho: Vec<f64> = u.iter().map(|&u| autocorrelation(u)).collect();
        for (re, lines) in [(0.1, 0.0), (1.0, 0.4), (0.3, 1.0), (5.0, -1.0), (0.01, 2.6), (30.0, 7.0)] {
            let z = c64::new(re / record_s, TAU * lines / record_s);
            let part = |k: usize| rho[k] * (-z * record_s * u[k]).exp() * record_s / n as f64;
            let value: c64 = (0..n).map(part).sum();
            let slope: c64 = (0..n).map(|k| record_s * u[k] * part(k)).sum();
            let found = hann_resonance(z, record_s);
            for (found, exact) in found.into_iter().zip([value, slope]) {
                assert!((found - exact).norm() < 1e-4 * exact.norm(), "{z}: {found} {exact}");
            }
        }
    }

    /// A window that is long for a resonance lowers its peak by 4/(3B²), and does nothing else.
    #[test]
    fn the_peak_of_a_wide_resonance_is_lower_by_the_square_of_the_resolution() {
        for lines in [10.0, 30.0] {
            let z = c64::new(PI * lines, 0.0);
            let lower = 1.0 - (hann_resonance(z, 1.0)[0] * z).re;
            let expected = 4.0 / (3.0 * lines * lines);
            assert!((lower / expected - 1.0).abs() < 0.1, "{lines}: {lower} {expected}");
        }
    }
}
