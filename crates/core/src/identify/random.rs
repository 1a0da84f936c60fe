//! Random numbers for tests: the same for the same seed.

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
