//! Lengths of long vectors from short ones: a sparse random embedding with a fixed seed.
//!
//! # Source
//! O. Balabanov, A. Nouy, Adv. Comput. Math. 45 (2019) 2969–3019 (residuals of reduced models by sketching); K. L. Clarkson,
//! D. P. Woodruff, J. ACM 63 (2017) 54 (the embedding with one entry in a column).

use std::sync::Arc;

/// Entries of a sketch. The square of a length comes out with a standard deviation of √(2/k) = 18 %: an error estimate needs no more.
pub(super) const SKETCH_SIZE: usize = 64;

/// Θ: each of N entries goes, with a sign, to one of [`SKETCH_SIZE`] sums.
#[derive(Debug, Clone)]
pub(super) struct Sketch(Arc<[(u8, f64)]>);

impl Sketch {
    /// Θ diag(w)^{1/2}.
    pub(super) fn new(weights: impl IntoIterator<Item = f64>) -> Self {
        let mut state = 0x9e37_79b9_7f4a_7c15u64;
        let mut next = || {
            // splitmix64 (Steele, Lea, Flood 2014)
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        let entry = |weight: f64| {
            let bits = next();
            let sign = if bits >> 63 == 0 { 1.0 } else { -1.0 };
            ((bits % SKETCH_SIZE as u64) as u8, sign * weight.sqrt())
        };
        Self(weights.into_iter().map(entry).collect())
    }

    /// Θ x.
    pub(super) fn of<T: Copy + Default + std::ops::AddAssign + std::ops::Mul<f64, Output = T>>(
        &self,
        x: &[T],
    ) -> Vec<T> {
        let mut sums = vec![T::default(); SKETCH_SIZE];
        for (&x, &(bucket, weight)) in x.iter().zip(self.0.iter()) {
            sums[usize::from(bucket)] += x * weight;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_lengths() {
        // 40 vectors of three kinds: the mean of the squared ratio is one, each within five standard deviations (√(2/64) = 0.18).
        let sketch = Sketch::new(std::iter::repeat_n(4.0, 5000));
        let mut mean = 0.0;
        for kind in 0..40 {
            let x: Vec<f64> = (0..5000).map(|i| ((i * (kind + 3)) as f64 * 0.37).sin()).collect();
            let squared = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
            let ratio = squared(&sketch.of(&x)) / (4.0 * squared(&x));
            assert!((ratio - 1.0).abs() < 0.9, "{ratio}");
            mean += ratio / 40.0;
        }
        assert!((mean - 1.0).abs() < 0.2, "{mean}");
        // A vector with one entry keeps its length exactly.
        let mut spike = vec![0.0; 5000];
        spike[77] = -3.0;
        assert_eq!(sketch.of(&spike).iter().map(|x| x * x).sum::<f64>(), 36.0);
    }
}
