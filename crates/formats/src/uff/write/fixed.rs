//! Numbers and texts in fields of fixed width.

use crate::FormatError;

/// FORMAT(Iw).
pub(super) fn integer(value: i64, width: usize, what: &str) -> Result<String, FormatError> {
    let text = format!("{value:>width$}");
    if text.len() > width {
        return Err(FormatError::whole(format!("{what} of at most {width} characters"), text));
    }
    Ok(text)
}

/// FORMAT(wA1), filled with blanks; `NONE` for an empty text.
pub(super) fn text(value: &str, width: usize, what: &str) -> Result<String, FormatError> {
    let value = if value.is_empty() { "NONE" } else { value };
    if value.chars().count() > width || value.contains(char::is_control) {
        let expected = format!("{what} of at most {width} characters on one line");
        return Err(FormatError::whole(expected, format!("{value:?}")));
    }
    Ok(format!("{value:<width$}"))
}

/// FORMAT(1X,wA1); a text that is one character too long takes the blank before it, where readers find it too.
pub(super) fn spaced_text(value: &str, width: usize, what: &str) -> Result<String, FormatError> {
    let text = text(value, width + 1, what)?;
    Ok(text.strip_suffix(' ').map_or_else(|| text.clone(), |shorter| format!(" {shorter}")))
}

/// FORMAT(1PEw.d): `-1.23456E+01`, and where the exponent has three digits `-1.23456E+101`. Not-a-number and
/// infinities are words.
pub(super) fn real(value: f64, width: usize, decimals: usize) -> String {
    if !value.is_finite() {
        return format!("{value:>width$}");
    }
    let text = format!("{value:.decimals$E}");
    let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{:>width$}", format!("{mantissa}E{sign}{digits:0>2}"))
}

/// FORMAT(E13.5) for a number that everything after it depends on, such as an increment: as it is where some
/// spelling in 13 columns is exact, otherwise with as many digits as leave a blank before it.
pub(super) fn exact_real(value: f64) -> String {
    const WIDTH: usize = 13;
    let scientific = point_before_exponent(&format!("{value:E}"));
    let spellings = [real(value, 0, 5), scientific, format!("{value:?}")];
    let is_exact = |text: &&String| text.contains('.') && text.parse() == Ok(value);
    let exact = |width: usize| spellings.iter().filter(is_exact).find(|text| text.len() <= width).cloned();
    // Rounded up, the largest numbers are infinite.
    let is_finite = |text: &String| text.len() < WIDTH && text.parse().is_ok_and(f64::is_finite);
    let rounded = || (4..WIDTH).rev().map(|decimals| real(value, 0, decimals)).find(is_finite);
    let text =
        exact(WIDTH - 1).or_else(|| exact(WIDTH)).or_else(rounded).unwrap_or_else(|| real(value, 0, 5));
    format!("{text:>WIDTH$}")
}

/// `1E-5` as `1.0E-5`: Fortran takes digits without a point for decimals.
fn point_before_exponent(text: &str) -> String {
    if text.contains('.') { text.to_owned() } else { text.replacen('E', ".0E", 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_have_two_digits_in_the_exponent_and_a_fixed_width() {
        assert_eq!(real(-12.34567, 13, 5), " -1.23457E+01");
        assert_eq!(real(0.0, 13, 5), "  0.00000E+00");
        assert_eq!(real(-1.5e-101, 13, 5), "-1.50000E-101");
        assert_eq!(real(-1.5e-101, 20, 12), "-1.500000000000E-101");
        assert_eq!(real(f64::NAN, 13, 5), "          NaN");
    }

    #[test]
    fn increments_keep_what_fits() {
        assert_eq!(exact_real(0.5), "  5.00000E-01");
        assert_eq!(exact_real(0.1953125), "  1.953125E-1");
        assert_eq!(exact_real(-123_456_789.5), " -123456789.5");
        assert_eq!(exact_real(1.220703125e-4), " 1.220703E-04");
        assert_eq!(exact_real(1.0 / 3.0), " 3.333333E-01");
        assert_eq!(exact_real(-1.0 / 3.0), " -3.33333E-01");
        assert_eq!(exact_real(1e-300), " 1.00000E-300");
        assert_eq!(exact_real(-f64::MAX / 3.0), " -5.9923E+307");
        assert_eq!(exact_real(-f64::MAX), "-1.79769E+308");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(integer(-1234, 5, "x"), Ok("-1234".to_owned()));
        assert!(integer(-12345, 5, "x").is_err());
        assert_eq!(text("", 6, "x"), Ok("NONE  ".to_owned()));
        assert!(text("two\nlines", 80, "x").is_err());
        assert!(text("longer", 5, "x").is_err());
        assert_eq!(spaced_text("abc", 3, "x"), Ok(" abc".to_owned()));
        assert_eq!(spaced_text("abcd", 3, "x"), Ok("abcd".to_owned()));
        assert_eq!(spaced_text("m²", 3, "x"), Ok(" m² ".to_owned()));
    }
}
