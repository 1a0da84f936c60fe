//! Simulated measurements for tests: random numbers, the same for the same seed, and responses.

use crate::c64;

/// Complex numbers whose parts are normal with a standard deviation of one.
pub(super) fn normal_numbers(seed: u64) -> impl FnMut() -> c64 {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut normal = move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
    move || c64::new(normal(), normal())
}

/// The response of a structure of five modes with a loss factor, at a frequency, where the second share of each mode counts so much.
pub(super) fn five_modes(loss_factor: f64) -> impl Fn(f64, f64) -> c64 {
    let modes = [(47.0, 1.0), (130.0, -0.7), (210.0, 0.4), (330.0, -1.0), (433.0, 1.0)];
    move |frequency_hz, second| {
        let one = |&(own, share): &(f64, f64)| {
            (1.0 + second * share) / (own * own * c64::new(1.0, loss_factor) - frequency_hz * frequency_hz)
        };
        modes.iter().map(one).sum()
    }
}
