//! Numbers in fields of fixed width.

/// A number in at most `width` characters, with a decimal point, and as many significant digits as fit: all of them where the shortest text that reads back to the same bits
/// is short enough, else correctly rounded. `mark` stands between mantissa and exponent: `E`, or nothing, as Nastran allows.
///
/// Nothing where no digit fits, or the number is not finite.
///
/// # Limits
/// −0 is written as 0.
#[must_use]
pub fn real(value: f64, width: usize, mark: &str) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    if value == 0.0 {
        return (width >= 2).then(|| "0.".into());
    }
    // The shortest digits that read back: more would be none of the number's own.
    let most = format!("{value:e}").bytes().take_while(|&b| b != b'e').filter(u8::is_ascii_digit).count();
    (1..=most).rev().find_map(|digits| {
        let scientific = format!("{value:.*e}", digits - 1);
        let (mantissa, exponent) = scientific.split_once('e')?;
        let exponent: i32 = exponent.parse().ok()?;
        let fits = |text: &String| text.len() <= width;
        // Zeros before the point are the number's own only where all of its digits are there.
        let least = if digits == most { 0 } else { i32::MIN };
        let decimals = usize::try_from((digits as i32 - 1 - exponent).max(least)).ok();
        let fixed = decimals.map(|decimals| trimmed(&format!("{value:.decimals$}")));
        let scientific = format!("{}{mark}{exponent:+}", trimmed(mantissa));
        fixed.filter(fits).or(Some(scientific).filter(fits))
    })
}

/// With a decimal point, and without zeros at the end of the decimals.
fn trimmed(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').to_owned() } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn as_many_digits_as_fit() {
        for (value, width, mark, expected) in [
            (0.1, 16, "", "0.1"),
            (-0.0, 16, "", "0."),
            (312.5, 16, "", "312.5"),
            (2e6, 16, "", "2000000."),
            (2.9e11, 16, "", "290000000000."),
            (1.0 / 3.0, 16, "", "0.33333333333333"),
            (-1.0 / 3.0, 16, "", "-0.3333333333333"),
            (1.0 / 3e7, 16, "", "3.333333333333-8"),
            (1.0 / 3e7, 20, "E", "3.333333333333333E-8"),
            (-1.0 / 3e7, 20, "E", "-3.33333333333333E-8"),
            (9.999_999_999_999_999e5, 8, "", "1000000."),
            (1e-300, 8, "", "1.-300"),
            (1e300, 8, "E", "1.E+300"),
        ] {
            assert_eq!(real(value, width, mark).as_deref(), Some(expected), "{value:e} in {width}");
        }
        assert_eq!(real(f64::NAN, 16, ""), None);
        assert_eq!(real(-1e-300, 6, "E"), None);
    }

    /// Reads a number whose exponent may have no letter.
    fn read(text: &str) -> f64 {
        match text[1..].rfind(['+', '-']) {
            Some(at) => format!("{}e{}", text[..=at].trim_end_matches('E'), &text[at + 1..]).parse().unwrap(),
            None => text.parse().unwrap(),
        }
    }

    proptest! {
        #[test]
        fn what_is_written_is_the_number(value in prop::num::f64::NORMAL, mark in prop::sample::select(vec!["", "E"])) {
            let text = real(value, 16, mark).unwrap();
            prop_assert!(text.len() <= 16 && text.contains('.'));
            // A sign, a point, a mark, and an exponent of three digits with its sign leave nine digits: half a unit of the ninth.
            prop_assert!((read(&text) / value - 1.0).abs() <= 5e-9, "{value:e} {text}");
            // 17 digits with everything else need 24 characters.
            prop_assert_eq!(read(&real(value, 24, mark).unwrap()), value);
        }
    }
}
