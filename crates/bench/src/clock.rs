//! CPU seconds, and what many of them say together.

use cpu_time::ThreadTime;
use std::hint::black_box;

/// CPU seconds that this thread spends on some work.
pub fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = ThreadTime::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Median CPU seconds of each of several works, run in turn so that what disturbs one disturbs all: from [`RUNS`] to 1000
/// rounds, as many as fit into a second, after one that warms up.
pub fn median_seconds(works: &[&dyn Fn()]) -> Vec<f64> {
    let round = || works.iter().map(seconds).collect::<Vec<f64>>();
    let rounds = ((1.0 / round().iter().sum::<f64>().max(1e-9)) as usize).clamp(RUNS, 1000);
    let rounds: Vec<Vec<f64>> = (0..rounds).map(|_| round()).collect();
    (0..works.len()).map(|work| median(rounds.iter().map(|round| round[work]).collect())).collect()
}

/// The fewest runs behind a median.
pub const RUNS: usize = 5;

/// The middle value, or the mean of the two in the middle; NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        even if even.is_multiple_of(2) => (values[middle - 1] + values[middle]) / 2.0,
        _ => values[middle],
    }
}

/// Mean and standard deviation of a sample; NaN where there are too few values.
pub fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_small_samples() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 3.0, 2.0]), 2.5);
        assert!(median(vec![]).is_nan());
        assert_eq!(mean_and_deviation(&[1.0, 3.0]), (2.0, 2f64.sqrt()));
    }
}
