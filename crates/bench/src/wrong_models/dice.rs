//! Random numbers from a seed, the same on every machine.

use frfit::c64;
use std::f64::consts::TAU;

/// A generator of its own for each case of a seed.
///
/// # Source
/// splitmix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014, 453–472.
#[derive(Debug, Clone)]
pub struct Dice(u64);

/// The golden ratio's fraction, the step of splitmix64.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Dice {
    /// The generator of case `index` of a seed: neighbouring cases and seeds have nothing in common.
    pub fn new(seed: u64, index: u64) -> Self {
        Self(mixed(mixed(seed.wrapping_add(STEP)).wrapping_add(index.wrapping_mul(STEP))))
    }

    /// Another generator, whose numbers do not depend on how many are drawn from this one afterwards.
    pub fn fork(&mut self) -> Self {
        Self(mixed(self.next()))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mixed(self.0)
    }

    /// Uniform in 0 < x < 1.
    pub fn uniform(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Between two positive numbers, uniform in its logarithm.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// One of 0 … n − 1.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }

    /// One of low … high.
    pub fn count(&mut self, low: usize, high: usize) -> usize {
        low + self.below(high - low + 1)
    }

    /// One of some things.
    ///
    /// # Panics
    /// If `of` is empty.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// Heads or tails.
    pub fn coin(&mut self) -> bool {
        self.uniform() < 0.5
    }

    /// 1 + x or 1 − x with x between two numbers.
    pub fn off_by(&mut self, low: f64, high: f64) -> f64 {
        let by = self.between(low, high);
        if self.coin() { 1.0 + by } else { 1.0 - by }
    }

    /// A circular complex normal number z with E|z|² = 1.
    pub fn circular(&mut self) -> c64 {
        c64::from_polar((-self.uniform().ln()).sqrt(), TAU * self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_has_its_own_numbers_and_always_the_same() {
        let first = |seed, index| Dice::new(seed, index).uniform();
        assert_eq!(first(1, 2), first(1, 2));
        assert!(first(1, 2) != first(2, 1) && first(1, 2) != first(1, 3));
    }

    #[test]
    fn moments_of_the_noise() {
        // Mean and mean square of n circular numbers scatter by 1/√n about 0 and 1: five standard deviations.
        let (mut dice, n) = (Dice::new(7, 0), 20_000);
        let drawn: Vec<c64> = (0..n).map(|_| dice.circular()).collect();
        let limit = 5.0 / f64::from(n).sqrt();
        let mean = drawn.iter().sum::<c64>() / f64::from(n);
        let square = drawn.iter().map(|z| z.norm_sqr()).sum::<f64>() / f64::from(n);
        assert!(mean.norm() < limit && (square - 1.0).abs() < limit, "{mean} {square}");
    }
}
