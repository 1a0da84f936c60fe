//! Numbers as Fortran and its successors write them.

/// A real number: with exponent letter `E`, `D` (or small), or with a signed exponent and no letter, as Fortran
/// writes one that needs three digits (`1.5-123`). Not-a-number and infinities are numbers here.
pub(super) fn real(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| respelled(text)?.parse().ok())
}

/// The number with `E` before its exponent.
fn respelled(text: &str) -> Option<String> {
    const LONGEST: usize = 64;
    if text.len() > LONGEST {
        return None;
    }
    if let Some(letter) = text.find(['D', 'd']) {
        return Some(format!("{}E{}", &text[..letter], &text[letter + 1..]));
    }
    let sign = text.rfind(['+', '-']).filter(|&at| at > 0)?;
    Some(format!("{}E{}", &text[..sign], &text[sign..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_in_all_spellings() {
        for (text, value) in [
            ("1.5", 1.5),
            ("-1.5E+02", -150.0),
            ("1.5e2", 150.0),
            ("1.5D+02", 150.0),
            ("-1.5d-02", -0.015),
            ("1.5-123", 1.5e-123),
            ("-1.5+003", -1500.0),
            ("+.5", 0.5),
            ("3.", 3.0),
            ("1.0E-003", 1e-3),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
    }

    #[test]
    fn other_words_are_refused() {
        for text in ["", "-", "x", "1.0 2.0", "1.0-2.0", "1-2-3", "*****", "1.5E", "1D", "--1", "\u{b2}"] {
            assert_eq!(real(text.as_bytes()), None, "{text}");
        }
        assert_eq!(real(&[b'-'; 100]), None);
        assert_eq!(real(b"\xff"), None);
    }
}
