//! Gauss–Legendre points and weights on (−1, 1).

/// Two points, exact up to degree 3: 1/√3.
pub(crate) const GAUSS_2: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];

/// Four points, exact up to degree 7: √(3/7 ∓ 2/7 √(6/5)), weights (18 ± √30)/36.
pub(crate) const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Both rules integrate every power of x up to their degree, and not the next even one.
    #[test]
    fn degree() {
        for (rule, degree) in [(&GAUSS_2[..], 3), (&GAUSS_4[..], 7)] {
            let error = |power: i32| {
                let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
                rule.iter().map(|(x, weight)| weight * x.powi(power)).sum::<f64>() - exact
            };
            // A few units of roundoff of numbers below 2.
            assert!((0..=degree).all(|power| error(power).abs() < 1e-15));
            assert!(error(degree + 1).abs() > 1e-3);
        }
    }
}
