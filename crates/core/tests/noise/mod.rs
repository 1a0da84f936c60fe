//! Normal random numbers from a seed, the same on every machine.

use frfit::c64;

/// A generator (S. Vigna's splitmix64) of pairs of normal numbers.
pub(crate) struct Noise(u64);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform above 0 and at most 1.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11).wrapping_add(1) as f64 / (1u64 << 53) as f64
    }

    /// Real and imaginary part each normal with standard deviation one (Box, Muller).
    pub(crate) fn complex(&mut self) -> c64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        c64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }
}
