//! What a channel shows where nothing happens, and how much it trembles there.

use crate::median::median;

/// Fewest samples of which a mean is a baseline.
const MIN_BASELINE_SAMPLES: usize = 8;

/// Of a normal distribution, the standard deviation over the median of deviations from the median.
const SIGMA_PER_MAD: f64 = 1.4826;

/// The median of all samples and their standard deviation by the median of deviations: what an impact, which is short,
/// cannot move.
pub(super) fn quiet(samples: &[f64]) -> (f64, f64) {
    let middle = median(samples.to_vec()).unwrap_or(0.0);
    let distances = samples.iter().map(|x| (x - middle).abs()).collect();
    (middle, SIGMA_PER_MAD * median(distances).unwrap_or(0.0))
}

/// The mean before the impact, or, where a record has too little of that, over its last tenth, where the response has decayed.
pub(super) fn offset(record: &[f64], before: usize) -> f64 {
    mean(if before >= MIN_BASELINE_SAMPLES { &record[..before] } else { last_tenth(record) })
}

pub(super) fn last_tenth(record: &[f64]) -> &[f64] {
    &record[record.len() - record.len().div_ceil(10)..]
}

pub(super) fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len().max(1) as f64
}

/// √ of the mean square about the mean.
pub(super) fn rms(samples: &[f64]) -> f64 {
    let mean = mean(samples);
    (samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / samples.len().max(1) as f64).sqrt()
}

/// The largest deviation from an offset.
pub(super) fn peak(samples: &[f64], offset: f64) -> f64 {
    samples.iter().map(|x| (x - offset).abs()).fold(0.0, f64::max)
}
