//! Abaqus's input: keyword lines with parameters, data lines below them.
//!
//! # Source
//! Abaqus Analysis User's Guide, "Input syntax rules": data are separated by commas, at most 256 characters a line; a real number has at most 20; comments begin with `**`.

use super::{comment as lines, finite, real};
use crate::FormatError;

/// Characters of a number.
const WIDTH: usize = 20;

/// A keyword line: `*NAME, PARAMETER=VALUE`.
///
/// # Errors
/// A value with a comma, a quote or a line break.
pub fn keyword(name: &str, parameters: &[(&str, &str)]) -> Result<String, FormatError> {
    let mut out = format!("*{name}");
    for (key, value) in parameters {
        if value.is_empty() || value.contains([',', '"', '\n', '\r']) {
            let expected = format!("a value of {key} without commas, quotes and line breaks");
            return Err(FormatError::whole(expected, format!("{value:?}")));
        }
        out += &format!(", {key}={value}");
    }
    out.push('\n');
    Ok(out)
}

/// A data line of numbers, each in at most 20 characters: 13 digits and more.
///
/// # Errors
/// A number that is not finite.
pub fn data(numbers: &[f64]) -> Result<String, FormatError> {
    let number = |&value: &f64| Ok(real(finite(value)?, WIDTH, "E").unwrap_or_default());
    let cells = numbers.iter().map(number).collect::<Result<Vec<String>, FormatError>>()?;
    Ok(cells.join(", ") + "\n")
}

/// Lines of a comment, at most 80 characters each.
#[must_use]
pub fn comment(text: &str) -> String {
    lines("**", 80, text)
}

/// Refuses what is no name: at most 80 letters, digits, `_` and `-`, beginning with a letter.
///
/// # Errors
/// Any other text.
pub fn check_name(name: &str) -> Result<(), FormatError> {
    super::word(name, "_-", 80)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_and_data() {
        assert_eq!(keyword("ELASTIC", &[("MODULI", "LONG TERM")]).unwrap(), "*ELASTIC, MODULI=LONG TERM\n");
        assert_eq!(data(&[2e6, -1.0 / 3e7, 0.0]).unwrap(), "2000000., -3.33333333333333E-8, 0.\n");
        assert!(keyword("MATERIAL", &[("NAME", "a,b")]).is_err());
        assert!(data(&[f64::NAN]).is_err());
        assert!(check_name("core-1").is_ok() && check_name("1").is_err());
    }
}
