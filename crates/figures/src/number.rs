//! Numbers as SVG reads them.

use std::fmt::{Display, Formatter};

/// A number as SVG reads it: two decimals, no exponent, no "NaN" or "inf".
#[derive(Clone, Copy)]
pub(crate) struct N(pub(crate) f64);

impl Display for N {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let hundredths = (self.0 * 100.0).round();
        // zero for what has no place, and never "-0"
        let value = if hundredths.is_finite() && hundredths != 0.0 { hundredths / 100.0 } else { 0.0 };
        write!(f, "{value}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        let got = [1.0, 2.504, -0.001, 1e-9, f64::NAN, f64::INFINITY].map(|v| N(v).to_string());
        assert_eq!(got, ["1", "2.5", "0", "0", "0", "0"].map(String::from));
    }
}
