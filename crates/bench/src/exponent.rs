//! The power of N to which a cost is proportional.

/// b of the power a xᵇ that fits positive values best on logarithmic scales; NaN of fewer than two.
pub fn exponent(x: &[f64], y: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().map(|v| v.ln()).sum::<f64>() / values.len() as f64;
    let (mean_x, mean_y) = (mean(x), mean(y));
    let covariance: f64 = x.iter().zip(y).map(|(x, y)| (x.ln() - mean_x) * (y.ln() - mean_y)).sum();
    covariance / x.iter().map(|x| (x.ln() - mean_x).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::exponent;

    #[test]
    fn the_exponent_of_a_power_is_its_own() {
        let x = [1e4, 3e4, 1e5];
        let y = x.map(|x: f64| 7.0 * x.powf(1.25));
        assert!((exponent(&x, &y) - 1.25).abs() < 1e-12);
    }
}
