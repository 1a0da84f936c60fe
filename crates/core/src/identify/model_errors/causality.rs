//! What causality makes of a smooth complex modulus: its phase is that of its slope (B-12).
//!
//! With u = ln ω, a modulus without zeros and poles in the half-plane of growing motion has
//! $$ \arg E(u) = \frac{1}{\pi} \int_{-\infty}^{\infty} \frac{d \ln|E|}{du'} \ln \coth \frac{|u - u'|}{2} \\, du' $$
//! Within the band the slope is that of a spline. Beyond it the slope goes on as at the end, or becomes another one within an e-fold.
//!
//! # Source
//! H. W. Bode, Network Analysis and Feedback Amplifier Design (1945), ch. 14.

use frfit_linalg::dense::Cholesky;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_4, PI};

/// The phase may be this part of itself more or less, the same all over the band: a loss factor that does not depend on frequency, as models of structural damping
/// have it, belongs to no slope.
const GAIN_STD: f64 = 0.5;

/// The same at each knot: what a spline leaves of a curve.
const KNOT_STD: f64 = 0.1;

/// By how much the slope beyond the band may be another one, over the slope that belongs to the phase.
const OUTER_SLOPE_RATIO: f64 = 1.0;

/// A slope d ln|E|/du for which no loss is needed that can be measured.
const MIN_SLOPE_STD: f64 = 0.001;

/// The phase that belongs to a natural cubic spline of ln|E| over ln ω.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Causality {
    /// What ln|E| at knot j has of the phase at knot k, `[k][j]`.
    phase: Vec<Vec<f64>>,
    /// What other slopes below and above the band have of it, `[side][k]`.
    outer: [Vec<f64>; 2],
}

/// Points of a knot's interval at which the integral is summed (Simpson).
const INTERVALS: usize = 40;

impl Causality {
    /// Of knots that are a step in ln ω apart; `bends[j]` are the second derivatives, in units of the step, of the spline that is one at knot j.
    pub(super) fn new(step: f64, bends: &[Vec<f64>]) -> Self {
        let n = bends.len();
        let at = |k: usize, j: usize| {
            let (on, bend) = (|i: usize| f64::from(u8::from(i == j)), |i: usize| bends[j][i]);
            let first = on(1) - on(0) - bend(1) / 6.0;
            let last = on(n - 1) - on(n - 2) + bend(n - 2) / 6.0;
            // By parts: slopes at both ends, and the bends in between.
            let of_bend = |x: f64| {
                let i = (x as usize).min(n - 2);
                let part = x - i as f64;
                ((1.0 - part) * bend(i) + part * bend(i + 1)) * odd(kernel_integral, (x - k as f64) * step)
            };
            let inside = simpson(of_bend, (n - 1) as f64, INTERVALS * (n - 1));
            ((first + last) * PI * FRAC_PI_4 - inside) / (PI * step)
        };
        let side =
            |distance: &dyn Fn(usize) -> f64| (0..n).map(|k| outer_phase(distance(k) * step)).collect();
        Self {
            phase: (0..n).map(|k| (0..n).map(|j| at(k, j)).collect()).collect(),
            outer: [side(&|k| k as f64), side(&|k| (n - 1 - k) as f64)],
        }
    }

    /// The precision of ln|E| at the n knots and of the phase there, 2n × 2n, by how far the phase is from that of ln|E|; `phase` is about what it is.
    pub(super) fn precision(&self, phase: f64) -> Option<Vec<f64>> {
        let n = self.phase.len();
        let phase = phase.abs();
        let least = MIN_SLOPE_STD / FRAC_2_PI;
        let gain = (GAIN_STD * phase).hypot(least);
        let knot = (KNOT_STD * phase).hypot(least);
        let outer = (OUTER_SLOPE_RATIO * FRAC_2_PI * phase).hypot(MIN_SLOPE_STD);
        let covariance = |k: usize, l: usize| {
            let of_outer: f64 = self.outer.iter().map(|side| side[k] * side[l]).sum();
            let own = if k == l { knot * knot } else { 0.0 };
            own + gain * gain + outer * outer * of_outer
        };
        let covariance: Vec<f64> = (0..n * n).map(|k| covariance(k / n, k % n)).collect();
        let inverse = Cholesky::new(n, &covariance).ok()?.inverse();
        let slope = |k: usize, i: usize| match i.checked_sub(n) {
            Some(of_phase) => f64::from(u8::from(of_phase == k)),
            None => -self.phase[k][i],
        };
        let times: Vec<f64> = (0..n * 2 * n)
            .map(|p| (0..n).map(|l| inverse[p / (2 * n) * n + l] * slope(l, p % (2 * n))).sum())
            .collect();
        let entry = |i: usize, j: usize| (0..n).map(|k| slope(k, i) * times[k * 2 * n + j]).sum::<f64>();
        Some((0..4 * n * n).map(|p| entry(p / (2 * n), p % (2 * n))).collect())
    }
}

fn odd(function: impl Fn(f64) -> f64, x: f64) -> f64 {
    function(x.abs()).copysign(x)
}

/// ∫ ln coth(v/2) dv from 0 to x ≥ 0.
fn kernel_integral(x: f64) -> f64 {
    if x < 0.3 {
        return if x == 0.0 { 0.0 } else { x * (1.0 - (0.5 * x).ln()) + x.powi(3) / 36.0 };
    }
    let term = |n: i32| (-f64::from(n) * x).exp() / f64::from(n * n);
    PI * FRAC_PI_4 - 2.0 * (0..60).map(|k| term(2 * k + 1)).sum::<f64>()
}

/// The phase at a distance from the end of the band, of a slope that is 1 − exp(−x) another one at the distance x beyond it.
fn outer_phase(distance: f64) -> f64 {
    let term = |n: i32| (-f64::from(n) * distance).exp() / f64::from(n * n * (n + 1));
    FRAC_2_PI * (0..60).map(|k| term(2 * k + 1)).sum::<f64>()
}

/// ∫ f dx from 0 to some end, with an even number of parts.
fn simpson(f: impl Fn(f64) -> f64, end: f64, parts: usize) -> f64 {
    let step = end / parts as f64;
    let weight = |k: usize| match k {
        _ if k == 0 || k == parts => 1.0,
        _ if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=parts).map(|k| weight(k) * f(k as f64 * step)).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::c64;
    use crate::identify::model_errors::natural_spline::bends;

    /// Of n knots over a range of ln ω, and their distance.
    fn causality(n: usize, range: f64) -> (Causality, f64) {
        let step = range / (n - 1) as f64;
        (Causality::new(step, &(0..n).map(|k| bends(n, k)).collect::<Vec<_>>()), step)
    }

    /// A fractional Zener material over three decades about its transition: ln|E| has the phase, to a few per cent of it, but for what lies beyond the band.
    #[test]
    fn the_phase_of_a_material_is_that_of_its_modulus() {
        let modulus = |omega: f64| {
            let z = c64::new(0.0, omega).powf(0.7);
            ((1.0 + 4.0 * z) / (1.0 + z)).ln()
        };
        let n = 15;
        let (causality, step) = causality(n, 1e3f64.ln());
        let logs: Vec<c64> = (0..n).map(|k| modulus(10f64.powf(-1.5) * (step * k as f64).exp())).collect();
        let largest = logs.iter().fold(0.0f64, |most, log| most.max(log.im));
        for k in 0..n {
            let found: f64 = causality.phase[k].iter().zip(&logs).map(|(b, log)| b * log.re).sum();
            // What the slope beyond the band would have to be other than it is, is not known.
            let beyond: f64 = causality.outer.iter().map(|side| 0.1 * side[k]).sum();
            assert!((found - logs[k].im).abs() < 0.02 * largest + beyond, "{k}: {found} {}", logs[k].im);
        }
    }

    /// Of a constant slope it is π/2 times that; a slope beyond the band adds what the integral adds there.
    #[test]
    fn a_constant_slope_has_a_constant_phase() {
        let (causality, step) = causality(9, 50f64.ln());
        for (k, row) in causality.phase.iter().enumerate() {
            let found: f64 = row.iter().enumerate().map(|(j, b)| b * 0.2 * step * j as f64).sum();
            assert!((found - 0.2 / FRAC_2_PI).abs() < 1e-6, "{k}: {found}");
        }
        for distance in [0.0, 0.3, 1.0, 3.0] {
            let kernel = |v: f64| (1.0 / (0.5 * v).tanh()).ln();
            // Half an interval from the singularity, which is integrable.
            let part = |k: usize| {
                let x = (k as f64 + 0.5) * 1e-4;
                (1.0 - (-x).exp()) * kernel(x + distance) * 1e-4 / PI
            };
            let expected: f64 = (0..300_000).map(part).sum();
            assert!((outer_phase(distance) / expected - 1.0).abs() < 1e-3, "{distance}");
        }
    }
}
