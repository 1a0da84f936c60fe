//! Operation counts of the paper's Appendix A, for dense complex matrices.

/// Operations of one direct solve at a new parameter value, P-49: 16/3 N³ + 16 N².
pub fn direct_operations(dofs: f64) -> f64 {
    16.0 / 3.0 * dofs.powi(3) + 16.0 * dofs.powi(2)
}

/// Operations of the series of order n given the nominal factor, P-50: n (16 N² + 6 N).
pub fn series_operations(dofs: f64, order: f64) -> f64 {
    order * (16.0 * dofs.powi(2) + 6.0 * dofs)
}

/// How many times cheaper the series is than a direct solve, P-51.
///
/// # Limits
/// Dense counts: a sparse factorisation costs far less than 16/3 N³, so real speed-ups are smaller.
pub fn speedup(dofs: f64, order: f64) -> f64 {
    direct_operations(dofs) / series_operations(dofs, order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_two_figures() {
        // Four digits are what the paper prints.
        assert!((speedup(1e3, 50.0) - 6.684).abs() < 5e-4);
        assert!((speedup(1e6, 50.0) - 6.667e3).abs() < 0.5);
    }
}
