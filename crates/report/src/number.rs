//! Numbers as people read them, and as the page's JSON has them.

use serde_json::{Value, json};

/// A number with so many significant digits; null without a number, or where it is not finite.
pub(crate) fn rounded(value: Option<f64>, digits: usize) -> Value {
    let Some(value) = value.filter(|value| value.is_finite()) else { return Value::Null };
    let value = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    // Whole numbers are shorter without a point. Below 2⁵³ they are exact.
    if value == f64::trunc(value) && value.abs() < 9e15 { json!(value as i64) } else { json!(value) }
}

/// Powers of ten of numbers that are written without one: 0.001 to 99999.
const PLAIN: std::ops::Range<f64> = -3.0..5.0;

/// Significant digits, without those that say nothing: `0.25`, `2·10⁶`.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    if PLAIN.contains(&rounded.abs().log10().floor()) {
        return rounded.to_string().replace('-', "−");
    }
    let text = format!("{rounded:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{mantissa}·10{}", superscript(exponent)).replace('-', "−")
}

fn superscript(digits: &str) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
        '0' => '⁰',
        c => c,
    };
    digits.chars().map(raised).collect()
}

/// A share in per cent: `98.2 %`, never 100 % or 0 % where that is not so.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p > 99.9 && share < 1.0 => "over 99.9 %".into(),
        p if p > 0.0 && p < 0.001 => format!("{} %", significant(p, 1)),
        p if p > 0.0 && p < 10.0 => format!("{} %", significant(p, 2)),
        p => format!("{} %", (10.0 * p).round() / 10.0),
    }
}

/// Frequency in hertz.
pub(crate) fn hertz(frequency_hz: f64) -> String {
    format!("{} Hz", significant(frequency_hz, 5))
}

/// A value in a unit, with two standard deviations where they are known: `(5.971 ± 0.012)·10⁶ Pa`.
pub(crate) fn with_bar(value: f64, std: Option<f64>, unit: &str) -> String {
    let space = if unit.is_empty() { "" } else { "\u{a0}" };
    let Some(bar) = std.map(|std| 2.0 * std).filter(|bar| bar.is_finite() && *bar > 0.0) else {
        return format!("{}{space}{unit}", significant(value, 4));
    };
    // Value and bar share one power of ten.
    let exponent = value.abs().log10().floor();
    if value != 0.0 && value.is_finite() && !PLAIN.contains(&exponent) {
        let size = 10.0_f64.powf(exponent);
        // A bar that is too small for the digits of the value has a power of its own.
        if bar < 1e-5 * size {
            return format!("{} ± {}{space}{unit}", significant(value, 7), significant(bar, 1));
        }
        let power = superscript(&exponent.to_string());
        return format!("({})·10{power}{space}{unit}", plain_with_bar(value / size, bar / size));
    }
    format!("{}{space}{unit}", plain_with_bar(value, bar))
}

/// The bar has two digits, and the value as many places; seven digits of a value are enough for anyone.
fn plain_with_bar(value: f64, bar: f64) -> String {
    let first = |x: f64| if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    let places = 1 - first(bar);
    if places > 9 || places + first(value) > 6 {
        return format!("{} ± {}", significant(value, 7), significant(bar, 1));
    }
    let places = places.max(0) as usize;
    format!("{value:.places$} ± {bar:.places$}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn as_people_write_them() {
        assert_eq!(with_bar(5.9712e6, Some(6e3), "Pa"), "(5.971 ± 0.012)·10⁶\u{a0}Pa");
        assert_eq!(with_bar(2e11, None, "Pa"), "2·10¹¹\u{a0}Pa");
        assert_eq!(with_bar(2e5, Some(50.0), "MPa"), "(2.0000 ± 0.0010)·10⁵\u{a0}MPa");
        assert_eq!(with_bar(0.31234, Some(0.001), ""), "0.3123 ± 0.0020");
        assert_eq!(with_bar(1.447604149, Some(1e-9), ""), "1.447604 ± 2·10⁻⁹");
        assert_eq!(with_bar(12.0, Some(30.0), ""), "12 ± 60");
        assert_eq!(with_bar(6.8999417e10, Some(9.4e5), ""), "(6.89994 ± 0.00019)·10¹⁰");
        assert_eq!(with_bar(-3.6e-5, Some(1e-7), ""), "(−3.600 ± 0.020)·10⁻⁵");
        assert_eq!(with_bar(2.95107e6, Some(4.5), "Pa"), "2.95107·10⁶ ± 9\u{a0}Pa");
        assert_eq!(significant(1.0851997e-7, 3), "1.09·10⁻⁷");
        assert_eq!(significant(-0.25, 3), "−0.25");
        assert_eq!(significant(1e10, 3), "1·10¹⁰");
        assert_eq!(
            [2e6, 99_996.0, 12_345.6, 0.001, 2e-4].map(|value| significant(value, 4)),
            ["2·10⁶", "1·10⁵", "12350", "0.001", "2·10⁻⁴"]
        );
        let shares = [0.0, 1e-9, 0.000123, 0.0123, 0.5, 0.9994, 0.99999, 1.0].map(percent);
        let written = ["0 %", "1·10⁻⁷ %", "0.012 %", "1.2 %", "50 %", "over 99.9 %", "over 99.9 %", "100 %"];
        assert_eq!(shares, written);
    }

    proptest! {
        #[test]
        fn json_is_the_number_to_its_digits_or_null(value in any::<f64>()) {
            match rounded(Some(value), 6) {
                Value::Null => prop_assert!(!value.is_finite()),
                number => {
                    let off = (number.as_f64().unwrap() - value).abs();
                    // Half a unit of the sixth digit; subnormal numbers have fewer digits themselves.
                    prop_assert!(off <= 5.1e-6 * value.abs() || value.abs() < 1e-300, "{value:e} {off:e}");
                }
            }
        }
    }
}
