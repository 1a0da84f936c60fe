//! Natural frequencies of a uniform Euler–Bernoulli beam, ωₙ = (βₙL)² √(EI / ρA) / L².
//!
//! # Source
//! R. D. Blevins, *Formulas for Natural Frequency and Mode Shape*, Van Nostrand Reinhold 1979, table 8-1.

use crate::Support;
use std::f64::consts::PI;

/// A uniform beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformBeam {
    /// Young's modulus E in Pa.
    pub modulus: f64,
    /// Density ρ in kg/m³.
    pub density: f64,
    /// Area of the cross-section A in m².
    pub area: f64,
    /// Second moment of area I in m⁴.
    pub inertia: f64,
    /// Length L in m.
    pub length: f64,
}

impl UniformBeam {
    /// The n-th natural frequency above zero (n from 1), in rad/s.
    pub fn natural_frequency_rad_s(&self, ends: [Support; 2], n: usize) -> f64 {
        let wave_speed = (self.modulus * self.inertia / (self.density * self.area)).sqrt();
        (wavenumber(ends, n) / self.length).powi(2) * wave_speed
    }
}

/// βₙL, the n-th root above zero (n from 1) of the characteristic equation, to the last digits.
///
/// | ends | equation |
/// |---|---|
/// | free–free, clamped–clamped | cos x cosh x = 1 |
/// | clamped–free | cos x cosh x = −1 |
/// | clamped–pinned, free–pinned | tan x = tanh x |
/// | pinned–pinned | sin x = 0 |
///
/// Newton from the asymptotic root, on the equations divided by cosh x, which are of the size of a cosine.
pub fn wavenumber(ends: [Support; 2], n: usize) -> f64 {
    use Support::{Clamped, Free, Pinned};
    let n = n as f64;
    let sech = |x: f64| x.cosh().recip();
    match ends {
        [Pinned, Pinned] => n * PI,
        [Free, Free] | [Clamped, Clamped] => {
            newton((n + 0.5) * PI, |x| (x.cos() - sech(x), -x.sin() + sech(x) * x.tanh()))
        }
        [Clamped, Free] | [Free, Clamped] => {
            newton((n - 0.5) * PI, |x| (x.cos() + sech(x), -x.sin() - sech(x) * x.tanh()))
        }
        [Pinned, _] | [_, Pinned] => newton((n + 0.25) * PI, |x| {
            (x.sin() - x.cos() * x.tanh(), x.cos() + x.sin() * x.tanh() - x.cos() * sech(x).powi(2))
        }),
    }
}

/// Newton's method on (f, f′); from the asymptotic roots, off by 0.31 at most, it takes six steps at most.
fn newton(start: f64, equation: impl Fn(f64) -> (f64, f64)) -> f64 {
    (0..8).fold(start, |x, _| {
        let (value, slope) = equation(x);
        x - value / slope
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use Support::{Clamped, Free, Pinned};

    /// The characteristic functions as they stand in the table, divided by cosh x.
    fn characteristic(ends: [Support; 2], x: f64) -> f64 {
        match ends {
            [Pinned, Pinned] => x.sin(),
            [Clamped, Free] => x.cos() + 1.0 / x.cosh(),
            [Clamped, Pinned] | [Free, Pinned] => x.sin() - x.cos() * x.tanh(),
            _ => x.cos() - 1.0 / x.cosh(),
        }
    }

    const ENDS: [[Support; 2]; 6] = [
        [Free, Free],
        [Clamped, Clamped],
        [Clamped, Free],
        [Clamped, Pinned],
        [Free, Pinned],
        [Pinned, Pinned],
    ];

    #[test]
    fn a_sign_changes_within_a_few_units_of_roundoff_of_each_root() {
        for ends in ENDS {
            for n in 1..=20 {
                let root = wavenumber(ends, n);
                // Near its zero a cosine is as uncertain as its argument.
                let width = 4.0 * f64::EPSILON * root;
                let signs = characteristic(ends, root - width) * characteristic(ends, root + width);
                assert!(signs < 0.0, "{ends:?} {n} {root}");
            }
        }
    }

    #[test]
    fn no_root_is_skipped() {
        for ends in ENDS {
            // From above the multiple root at zero, in steps of a hundredth of the distance of roots.
            let samples: Vec<f64> =
                (0..2000).map(|i| characteristic(ends, 0.2 + 0.03 * f64::from(i))).collect();
            let crossings = samples.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
            let below = |n: &usize| wavenumber(ends, *n) < 0.2 + 0.03 * 1999.0;
            assert_eq!(crossings, (1..100).take_while(below).count(), "{ends:?}");
        }
    }

    #[test]
    fn table_8_1() {
        for (ends, table) in [
            ([Free, Free], [4.730_040_74, 7.853_204_62, 10.995_607_8]),
            ([Clamped, Free], [1.875_104_07, 4.694_091_13, 7.854_757_44]),
            ([Pinned, Clamped], [3.926_602_31, 7.068_582_75, 10.210_176_1]),
        ] {
            for (n, value) in (1..).zip(table) {
                assert!((wavenumber(ends, n) - value).abs() < 1e-7, "rounded to nine digits");
            }
        }
    }

    #[test]
    fn symmetric_in_the_ends() {
        for [a, b] in ENDS {
            assert_eq!(wavenumber([a, b], 2), wavenumber([b, a], 2));
        }
    }
}
