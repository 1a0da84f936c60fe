//! Numbers as people read them, and as the page's JSON has them.

use serde_json::{Value, json};

/// A number with so many significant digits; null where there is none, or it is not finite.
pub(crate) fn rounded(value: Option<f64>, digits: usize) -> Value {
    let Some(value) = value.filter(|value| value.is_finite()) else { return Value::Null };
    let value = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    // Whole numbers are shorter without a point. Below 2⁵³ they are exact.
    if value == f64::trunc(value) && value.abs() < 9e15 { json!(value as i64) } else { json!(value) }
}

/// Significant digits, without those that say nothing.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor();
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    if (-4.0..7.0).contains(&exponent) {
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

/// The largest power of 1000 of a prefix that leaves a value above one, and the prefix.
fn prefix(value: f64) -> (f64, &'static str) {
    let known = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")];
    known.into_iter().find(|(size, _)| value.abs() >= *size).unwrap_or((1.0, ""))
}

/// A value in a unit, with two standard deviations where they are known: `5.971 ± 0.012 MPa`. Units of Pa and of s take prefixes; others, as MPa and psi, take none.
pub(crate) fn with_bar(value: f64, std: Option<f64>, unit: &str) -> String {
    // Without a prefix long numbers take a power of ten, one for value and bar.
    let exponent = value.abs().log10().floor();
    if let (true, Some(std)) = (unit.is_empty() && value != 0.0 && !(-4.0..7.0).contains(&exponent), std)
        && std > 0.0
        && std.is_finite()
    {
        let size = 10.0_f64.powf(exponent);
        let power = superscript(&exponent.to_string());
        return format!("({})·10{power}", with_bar(value / size, Some(std / size), ""));
    }
    let (size, prefix) = if unit.starts_with("Pa") || unit == "s" { prefix(value) } else { (1.0, "") };
    let value = value / size;
    let space = if unit.is_empty() { "" } else { "\u{a0}" };
    let Some(bar) = std.map(|std| 2.0 * std / size).filter(|bar| bar.is_finite() && *bar > 0.0) else {
        return format!("{}{space}{prefix}{unit}", significant(value, 4));
    };
    // The bar has two digits, and the value as many places; seven digits of a value are enough for anyone.
    let first = |x: f64| if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    let places = 1 - first(bar);
    if places > 9 || places + first(value) > 6 {
        return format!("{} ± {}{space}{prefix}{unit}", significant(value, 7), significant(bar, 1));
    }
    let places = places.max(0) as usize;
    format!("{value:.places$} ± {bar:.places$}{space}{prefix}{unit}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn as_people_write_them() {
        assert_eq!(with_bar(5.9712e6, Some(6e3), "Pa"), "5.971 ± 0.012\u{a0}MPa");
        assert_eq!(with_bar(2e11, None, "Pa"), "200\u{a0}GPa");
        assert_eq!(with_bar(2e5, Some(50.0), "MPa"), "200000 ± 100\u{a0}MPa");
        assert_eq!(with_bar(0.31234, Some(0.001), ""), "0.3123 ± 0.0020");
        assert_eq!(with_bar(1.447604149, Some(1e-9), ""), "1.447604 ± 2·10⁻⁹");
        assert_eq!(with_bar(12.0, Some(30.0), ""), "12 ± 60");
        assert_eq!(with_bar(6.8999417e10, Some(9.4e5), ""), "(6.89994 ± 0.00019)·10¹⁰");
        assert_eq!(with_bar(-3.6e-5, Some(1e-7), ""), "(−3.600 ± 0.020)·10⁻⁵");
        assert_eq!(significant(1.0851997e-7, 3), "1.09·10⁻⁷");
        assert_eq!(significant(-0.25, 3), "−0.25");
        assert_eq!(significant(1e10, 3), "1·10¹⁰");
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
