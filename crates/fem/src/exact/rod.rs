//! Longitudinal vibration of a uniform rod, ρA ω² u + EA u″ = −p.
//!
//! # Source
//! S. S. Rao, *Vibration of Continuous Systems*, Wiley 2007, chapter 9; with the complex modulus of the
//! correspondence principle and so the complex wavenumber k = ω √(ρ/E).

use crate::Support;
use frfit_linalg::c64;
use std::f64::consts::PI;

/// A uniform rod over 0 ≤ x ≤ L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rod {
    /// Young's modulus E in Pa, complex where there is hysteretic damping.
    pub modulus: c64,
    /// Density ρ in kg/m³.
    pub density: f64,
    /// Area of the cross-section A in m².
    pub area: f64,
    /// Length L in m.
    pub length: f64,
}

impl Rod {
    /// k = ω √(ρ/E) in 1/m, for ω in rad/s.
    pub fn wavenumber(&self, omega_rad_s: f64) -> c64 {
        omega_rad_s * (self.density / self.modulus).sqrt()
    }

    /// Free–free, driven by a harmonic force F (N) at x = L: u(x) = −F cos kx / (EA k sin kL), in m.
    ///
    /// # Limits
    /// ω > 0: a free rod under a constant force has no steady state. |Im kL| < 700, where cosines overflow.
    pub fn free_free_end_force(&self, omega_rad_s: f64, force: f64, x: f64) -> c64 {
        let k = self.wavenumber(omega_rad_s);
        -force * (k * x).cos() / (self.modulus * self.area * k * (k * self.length).sin())
    }

    /// Free–free, under a uniform force p (N/m): u = −p / (ρA ω²) in m, rigid whatever the modulus.
    ///
    /// # Limits
    /// ω > 0.
    pub fn free_free_uniform_force(&self, omega_rad_s: f64, force_per_length: f64) -> f64 {
        -force_per_length / (self.density * self.area * omega_rad_s.powi(2))
    }

    /// Free–free, under the same force f (N) at each of n + 1 equidistant points, ends included, in the limit of
    /// many points: the uniform force p = n f / L, and f/2 more at either end.
    ///
    /// Only the end forces strain the rod: the response depends on the modulus through f/2 there.
    ///
    /// # Limits
    /// As [`Rod::free_free_end_force`].
    pub fn free_free_equal_forces(&self, omega_rad_s: f64, force: f64, intervals: usize, x: f64) -> c64 {
        let rigid = self.free_free_uniform_force(omega_rad_s, force * intervals as f64 / self.length);
        let from_end = |x| self.free_free_end_force(omega_rad_s, force / 2.0, x);
        rigid + from_end(x) + from_end(self.length - x)
    }

    /// Clamped at x = 0, driven by a harmonic force F (N) at x = L: u(x) = F sin kx / (EA k cos kL), in m.
    ///
    /// # Limits
    /// ω > 0; |Im kL| < 700.
    pub fn clamped_free_end_force(&self, omega_rad_s: f64, force: f64, x: f64) -> c64 {
        let k = self.wavenumber(omega_rad_s);
        force * (k * x).sin() / (self.modulus * self.area * k * (k * self.length).cos())
    }

    /// Clamped at x = 0, under a uniform force p (N/m): u(x) = p (cos k(L−x) / cos kL − 1) / (ρA ω²), in m.
    ///
    /// # Limits
    /// ω > 0; |Im kL| < 700.
    pub fn clamped_free_uniform_force(&self, omega_rad_s: f64, force_per_length: f64, x: f64) -> c64 {
        let k = self.wavenumber(omega_rad_s);
        let shape = (k * (self.length - x)).cos() / (k * self.length).cos() - 1.0;
        force_per_length / (self.density * self.area * omega_rad_s.powi(2)) * shape
    }

    /// The n-th natural frequency above zero (n from 1) of the undamped rod of modulus Re E, in rad/s:
    /// ωₙ = kₙ √(E/ρ), kₙL = nπ for like ends, (n − ½)π for a free and a held one.
    pub fn natural_frequency_rad_s(&self, ends: [Support; 2], n: usize) -> f64 {
        let like = (ends[0] == Support::Free) == (ends[1] == Support::Free);
        let half_waves = n as f64 - if like { 0.0 } else { 0.5 };
        half_waves * PI / self.length * (self.modulus.re / self.density).sqrt()
    }
}
