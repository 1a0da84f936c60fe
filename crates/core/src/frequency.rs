//! Hertz, radians per second, and the Laplace variable.

use crate::c64;
use std::f64::consts::TAU;

/// ω = 2π f, in rad/s.
pub fn omega_rad_s(frequency_hz: f64) -> f64 {
    TAU * frequency_hz
}

/// s = iω + α in 1/s, the Laplace variable of e^{+iωt} under a window e^{−αt}: ∫ x(t) e^{−αt} e^{−iωt} dt = X(s).
pub fn laplace_per_s(frequency_hz: f64, decay_per_s: f64) -> c64 {
    c64::new(decay_per_s, omega_rad_s(frequency_hz))
}

/// s² of [`laplace_per_s`]: exactly −ω² without a decay, with the sign of its zero at 0 Hz.
pub(crate) fn squared(s: c64) -> c64 {
    c64::new(-(s.im * s.im - s.re * s.re), 2.0 * s.re * s.im)
}

/// |s|/2π, the natural frequency that belongs to a pole s.
pub(crate) fn natural_frequency_hz(pole_per_s: c64) -> f64 {
    pole_per_s.norm() / omega_rad_s(1.0)
}

/// −Re s/|s|, the damping ratio of a pole s that is not zero.
pub(crate) fn damping_ratio(pole_per_s: c64) -> f64 {
    -pole_per_s.re / pole_per_s.norm()
}

/// `count` frequencies from `first_hz` to `last_hz`, both included, equally spaced.
pub fn linear_hz(first_hz: f64, last_hz: f64, count: usize) -> Vec<f64> {
    let step = if count > 1 { (last_hz - first_hz) / (count - 1) as f64 } else { 0.0 };
    (0..count)
        .map(|i| if i + 1 == count && count > 1 { last_hz } else { first_hz + step * i as f64 })
        .collect()
}

/// Neighbouring frequencies that share a property, as closed bands [first, last] in Hz.
///
/// `flagged` yields (frequency, whether it has the property) in ascending order; a band ends where the property does.
pub fn bands_hz(flagged: impl IntoIterator<Item = (f64, bool)>) -> Vec<[f64; 2]> {
    let mut bands: Vec<[f64; 2]> = Vec::new();
    let mut open = false;
    for (frequency_hz, flag) in flagged {
        match (flag, open) {
            (true, true) => {
                if let Some(band) = bands.last_mut() {
                    band[1] = frequency_hz;
                }
            }
            (true, false) => bands.push([frequency_hz; 2]),
            (false, _) => {}
        }
        open = flag;
    }
    bands
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_included() {
        assert_eq!(linear_hz(20.0, 4000.0, 3), [20.0, 2010.0, 4000.0]);
        assert_eq!(linear_hz(5.0, 9.0, 1), [5.0]);
        assert!(linear_hz(5.0, 9.0, 0).is_empty());
    }

    #[test]
    fn bands_break_where_the_property_does() {
        let flags = [(1.0, true), (2.0, true), (3.0, false), (4.0, true), (5.0, false)];
        assert_eq!(bands_hz(flags), [[1.0, 2.0], [4.0, 4.0]]);
        assert!(bands_hz([(1.0, false)]).is_empty());
    }
}
