//! A curve ln E(ln ω) as far as some of its points determine it: level, slope, and their covariance (a Kalman filter).

use crate::c64;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Area of the plane of ln E in which solutions lie: passive, so arg E within π/2, and E′ within a range of a factor of 25.
const LN_MODULUS_AREA: f64 = 3.2 * FRAC_PI_2;

/// Standard deviation of d ln E/d ln ω before anything is known: glass transitions reach 0.6.
const LOG_SLOPE_STD: f64 = 0.5;

/// How far the slope may lie outside what the loss factor allows. The local relation is exact for a power law and misses by less
/// than this for the fractional laws of damping materials.
pub(crate) const SLOPE_TOLERANCE: f64 = 0.1;

/// Distance in ln ω over which two slopes of one curve are independent evidence: a third of a unit, as transitions take several units.
const SLOPE_LENGTH: f64 = 0.3;

/// The slope d ln E/d ln ω of a causal material nearest to some slope, at a level of ln E; see [`Trend::as_material`].
pub(crate) fn slope_of_material(level: c64, slope: c64) -> c64 {
    let steepest = (level.im / FRAC_PI_2).max(0.0);
    // The loss itself moves no faster than the storage in the transitions that there are.
    c64::new(slope.re.clamp(0.0, steepest), slope.im.clamp(-steepest, steepest))
}

/// Level and slope at one frequency. Real and imaginary part are known equally well, so one real covariance serves both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trend {
    level: c64,
    slope: c64,
    /// Variance of the level, covariance, variance of the slope.
    covariance: [f64; 3],
}

impl Trend {
    /// From one point.
    pub(super) fn start(point: c64, variance: f64) -> Self {
        Self {
            level: point,
            slope: c64::default(),
            covariance: [variance, 0.0, LOG_SLOPE_STD * LOG_SLOPE_STD],
        }
    }

    /// A step h in ln ω further, or back; meanwhile the curvature is some constant of the size of κ.
    pub(super) fn advanced(self, step: f64, curvature: f64) -> Self {
        let [a, b, c] = self.covariance;
        let (level, slope) = (0.5 * curvature * step * step, curvature * step);
        Self {
            level: self.level + step * self.slope,
            slope: self.slope,
            covariance: [
                a + step * (2.0 * b + step * c) + level * level,
                b + step * c + level * slope,
                c + slope * slope,
            ],
        }
    }

    /// How far a point is from the expected one, in nats.
    pub(super) fn surprise(&self, point: c64, variance: f64) -> f64 {
        (point - self.level).norm_sqr() / (2.0 * (self.covariance[0] + variance))
    }

    /// −ln of the density that is expected at a point's distance, relative to a point that may be anywhere.
    pub(super) fn spread(&self, variance: f64) -> f64 {
        (TAU * (self.covariance[0] + variance) / LN_MODULUS_AREA).ln()
    }

    /// With one more point.
    pub(super) fn joined(self, point: c64, variance: f64) -> Self {
        let [a, b, c] = self.covariance;
        let expected = a + variance;
        let off = point - self.level;
        let rest = variance / expected;
        Self {
            level: self.level + a / expected * off,
            slope: self.slope + b / expected * off,
            covariance: [a * rest, b * rest, c - b * b / expected],
        }
    }

    /// The slope made that of a material, and how far it was from one, in nats: causality ties it to the loss,
    /// $$ 0 \le \frac{\mathrm d \ln |E|}{\mathrm d \ln \omega} \le \frac 2 \pi \arg E, $$
    /// from a constant loss factor (left) to a power law (right). `step` is the part of the band that this is evidence for.
    ///
    /// # Source
    /// Local form of the Kramers–Kronig relation: H. C. Booij, G. P. J. M. Thoone, Rheologica Acta 21 (1982) 15–24.
    pub(super) fn as_material(self, step: f64) -> (f64, Self) {
        if step == 0.0 {
            return (0.0, self);
        }
        let target = slope_of_material(self.level, self.slope);
        let [a, b, c] = self.covariance;
        let variance = SLOPE_TOLERANCE * SLOPE_TOLERANCE * SLOPE_LENGTH / step.abs();
        let expected = c + variance;
        let off = target - self.slope;
        let trend = Self {
            level: self.level + b / expected * off,
            slope: self.slope + c / expected * off,
            covariance: [a - b * b / expected, b * variance / expected, c * variance / expected],
        };
        (off.norm_sqr() / (2.0 * expected), trend)
    }

    /// How far this curve, known from the points on one side, is from that one, known from those on the other, in nats.
    pub(super) fn apart(&self, other: &Self) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|i| self.covariance[i] + other.covariance[i]);
        // Positive but for rounding; a distance over it is then huge, as it should be for two curves known so well.
        let determinant = (a * c - b * b).max(f64::MIN_POSITIVE);
        let (level, slope) = (other.level - self.level, other.slope - self.slope);
        let square = c * level.norm_sqr() - 2.0 * b * (level * slope.conj()).re + a * slope.norm_sqr();
        square / (2.0 * determinant)
    }
}
