//! How unlikely residuals are when their size is not known and some of them are wild.
//!
//! The residual of one value is ln(measured/model): its real part is the logarithm of the ratio of magnitudes, its imaginary part the difference of phase. It is taken
//! to have Student's circular distribution, whose scale σ is the likeliest: resonances that a constant modulus misses, and antiresonances in the noise, count for little.
//!
//! # Source
//! K. L. Lange, R. J. A. Little, J. M. G. Taylor, J. Am. Stat. Assoc. 84 (1989) 881–896.

use crate::c64;
use crate::median::median;
use std::f64::consts::{PI, TAU};

/// Degrees of freedom of Student's distribution, as Lange, Little and Taylor recommend: three to four.
const STUDENT_FREEDOM: f64 = 3.0;

/// No FRF agrees with a model better than this: a calibration is good to a per cent, and so is a constant law.
pub(super) const MIN_MISFIT: f64 = 0.01;

/// Rounds of reweighing; each brings σ nearer by a factor of about two, and a per cent of it is enough.
const REWEIGHING_ROUNDS: usize = 12;

/// The same beside known noise, with steps of twice the size: where noise is nearly all there is, each brings less.
const REWEIGHING_ROUNDS_BESIDE_NOISE: usize = 60;

/// The phase of a residual within ±π.
pub(super) fn wrapped(residual: c64) -> c64 {
    // Most are: rounding is a call of the library.
    match residual.im.abs() <= PI {
        true => residual,
        false => c64::new(residual.re, residual.im - TAU * (residual.im / TAU).round()),
    }
}

/// −ln of the likelihood, and the scale σ of real and imaginary part each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Misfit {
    /// Without the part that no hypothesis changes.
    pub(super) nats: f64,
    pub(super) sigma: f64,
}

/// The misfit of residuals at their likeliest scale σ, each beside the variance of its own noise n: σ² + n is that of its real and of its imaginary part.
///
/// Where σ is likeliest, Σ w|r|²/2v² = Σ 1/v with v = σ² + n and Student's weight w of r at v.
pub(super) fn misfit(residuals: &[c64], noise: &[f64]) -> Misfit {
    let squares: Vec<f64> = residuals.iter().map(|r| r.norm_sqr()).collect();
    let mut variance = (0.5 * median(squares.clone()).unwrap_or(0.0)).max(MIN_MISFIT * MIN_MISFIT);
    let has_noise = noise.iter().any(|n| *n > 0.0);
    let rounds = if has_noise { REWEIGHING_ROUNDS_BESIDE_NOISE } else { REWEIGHING_ROUNDS };
    for _ in 0..rounds {
        let (mut weighed, mut inverse) = (0.0, 0.0);
        for (r, n) in squares.iter().zip(noise) {
            let v = variance + n;
            weighed += (STUDENT_FREEDOM + 2.0) / (STUDENT_FREEDOM + r / v) * r / (v * v);
            inverse += 1.0 / v;
        }
        let ratio = if inverse > 0.0 { 0.5 * weighed / inverse } else { 0.0 };
        let step = if has_noise { ratio * ratio } else { ratio };
        variance = (variance * step).max(MIN_MISFIT * MIN_MISFIT);
    }
    let of_scale: f64 = noise.iter().map(|n| (variance + n).ln()).sum();
    let tails = squares.iter().zip(noise).map(|(r, n)| (r / (STUDENT_FREEDOM * (variance + n))).ln_1p());
    let nats = of_scale + 0.5 * (STUDENT_FREEDOM + 2.0) * tails.sum::<f64>();
    Misfit { nats, sigma: variance.sqrt() }
}

/// A residual as large at a scale without noise of its own as it is beside its noise.
pub(super) fn beside_noise(residual: c64, noise: f64, scale: f64) -> c64 {
    if noise > 0.0 { residual * (scale / scale.hypot(noise.sqrt())) } else { residual }
}

/// The misfit at a scale that is given, up to a constant: for comparing starts from afar.
pub(super) fn misfit_at(residuals: impl Iterator<Item = c64>, sigma: f64) -> f64 {
    let squares = residuals.map(|r| r.norm_sqr() / (STUDENT_FREEDOM * sigma * sigma));
    // A sum of logarithms is the logarithm of products: one in sixteen is cheaper.
    let (mut sum, mut product, mut count) = (0.0, 1.0, 0);
    for square in squares {
        product *= 1.0 + square;
        count += 1;
        if count == 16 {
            sum += f64::ln(product);
            (product, count) = (1.0, 0);
        }
    }
    0.5 * (STUDENT_FREEDOM + 2.0) * (sum + product.ln())
}

/// Scale at which starts are compared and searches begin: valleys of this width in ln H are wide enough to be found on a grid.
pub(super) const START_SCALE: f64 = 0.3;

/// A residual shortened so that its square is its share of −ln likelihood at a scale: sums of such squares are least at the likeliest model.
#[derive(Debug, Clone, Copy)]
pub(super) struct Robust {
    residual: c64,
    pub(super) value: c64,
    /// √(share/|r|²), and its slope by |r|².
    shrink: f64,
    of_square: f64,
}

/// A residual r at a scale.
pub(super) fn robust(residual: c64, scale: f64) -> Robust {
    let unit = STUDENT_FREEDOM * scale * scale;
    let share = 0.5 * (STUDENT_FREEDOM + 2.0);
    let ratio = residual.norm_sqr() / unit;
    // ln(1 + t)/t and its slope; both by their series near zero.
    let (part, slope) = match ratio < 1e-4 {
        true => (1.0 - 0.5 * ratio, -0.5 + 2.0 / 3.0 * ratio),
        false => {
            let part = ratio.ln_1p() / ratio;
            (part, (1.0 / (1.0 + ratio) - part) / ratio)
        }
    };
    let shrink = (share / unit * part).sqrt();
    Robust {
        residual,
        value: residual * shrink,
        shrink,
        of_square: 0.5 * share / unit * slope / (unit * shrink),
    }
}

impl Robust {
    /// The change of its value with that of the residual.
    pub(super) fn slope(&self, by: c64) -> c64 {
        by * self.shrink + self.residual * (self.of_square * 2.0 * (self.residual.conj() * by).re)
    }
}

/// The weight of a residual at a scale.
pub(super) fn weight(residual: c64, sigma: f64) -> f64 {
    (STUDENT_FREEDOM + 2.0) / (STUDENT_FREEDOM + residual.norm_sqr() / (sigma * sigma))
}

/// Half a turn.
pub(super) const HALF_TURN: f64 = PI;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_that_of_most() {
        // Nine of ten on a circle of radius 0.1 (√2 σ), one far away.
        let mut residuals: Vec<c64> = (0..18).map(|k| c64::from_polar(0.1, k as f64)).collect();
        let without = misfit(&residuals, &[0.0; 18]).sigma;
        residuals.extend([c64::new(5.0, 1.0); 2]);
        let with = misfit(&residuals, &[0.0; 20]).sigma;
        assert!(without > 0.05 && with < 2.0 * without, "{without} {with}");
        assert_eq!(misfit(&[c64::default(); 4], &[0.0; 4]).sigma, MIN_MISFIT);
        assert!(misfit(&[], &[]).nats.is_finite());
    }

    #[test]
    fn the_scale_is_what_known_noise_does_not_explain() {
        // Half of the values have a noise of ten times the scale: by Student's tails alone they would raise it.
        let of = |size: f64, k: usize| c64::from_polar(2f64.sqrt() * size, k as f64);
        let residuals: Vec<c64> = (0..40).map(|k| of(if k % 2 == 0 { 0.05 } else { 0.5 }, k)).collect();
        let noise: Vec<f64> = (0..40).map(|k| if k % 2 == 0 { 0.0 } else { 0.25 }).collect();
        let [with, without] = [&noise[..], &[0.0; 40]].map(|noise| misfit(&residuals, noise).sigma);
        let of_quiet = misfit(&residuals.iter().copied().step_by(2).collect::<Vec<_>>(), &[0.0; 20]).sigma;
        assert!(
            (with / of_quiet - 1.0).abs() < 0.1 && without > 1.5 * of_quiet,
            "{with} {without} {of_quiet}"
        );
        // The likelihood is largest there.
        let nats = |sigma: f64| -> f64 {
            let of = |(r, n): (&c64, &f64)| {
                let v = sigma * sigma + n;
                v.ln() + misfit_at(std::iter::once(*r), v.sqrt())
            };
            residuals.iter().zip(&noise).map(of).sum()
        };
        let least = misfit(&residuals, &noise);
        assert!((nats(least.sigma) - least.nats).abs() < 1e-9);
        assert!(nats(0.9 * with) > least.nats && nats(1.1 * with) > least.nats);
        // Noise alone leaves nothing.
        let noise: Vec<f64> = residuals.iter().map(|r| 0.6 * r.norm_sqr()).collect();
        assert_eq!(misfit(&residuals, &noise).sigma, MIN_MISFIT);
    }

    #[test]
    fn a_shortened_residual_has_its_share_of_the_likelihood_and_the_slope_of_differences() {
        for (r, scale) in [(c64::new(0.2, -0.1), 0.3), (c64::new(3.0, 1.0), 0.1), (c64::new(1e-4, 0.0), 0.3)]
        {
            let one = robust(r, scale);
            let share = misfit_at(std::iter::once(r), scale);
            assert!((one.value.norm_sqr() / share - 1.0).abs() < 1e-8, "{one:?} {share}");
            for by in [c64::new(1.0, 0.0), c64::new(0.3, -2.0)] {
                let step = 1e-7;
                let change =
                    (robust(r + by * step, scale).value - robust(r - by * step, scale).value) / (2.0 * step);
                assert!((one.slope(by) - change).norm() < 1e-6 * change.norm(), "{one:?} {change}");
            }
        }
    }

    #[test]
    fn phases_are_taken_the_short_way() {
        assert!((wrapped(c64::new(1.0, TAU - 0.1)).im + 0.1).abs() < 1e-12);
        assert!(wrapped(c64::new(0.0, 7.0 * PI)).im.abs() <= PI + 1e-12);
    }
}
