//! Entries of Nastran's bulk data, in large fields: four of sixteen columns a line, behind a name or a continuation of eight.
//!
//! # Source
//! MSC Nastran Quick Reference Guide, Bulk Data: "Format of Bulk Data Entries" (large field format; a real number needs a decimal point, and may have an exponent
//! without a letter).

use super::{comment as lines, finite, real, word};
use crate::FormatError;

/// A field of an entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Field<'a> {
    /// Nothing: the default.
    Blank,
    /// A whole number.
    Integer(u32),
    /// A number, of which as many digits are written as a field of sixteen columns holds: twelve and more, less one for a sign.
    Real(f64),
    /// A word of at most eight characters.
    Word(&'a str),
}

/// Columns of a large field.
const WIDTH: usize = 16;

/// An entry in large fields: its name (of at most seven characters) and the fields behind it, as the entry's description counts them; eight belong to each line of the
/// description, and to two lines here.
///
/// # Errors
/// A name or word that does not fit; a number that is not finite.
pub fn entry(name: &str, fields: &[Field<'_>]) -> Result<String, FormatError> {
    word(name, "", 7)?;
    let mut out = String::new();
    // Lines come in pairs, each pair being one of the description.
    let count = 8 * fields.len().div_ceil(8).max(1);
    for line in 0..count / 4 {
        let head = if line == 0 { format!("{name}*") } else { "*".into() };
        let mut text = format!("{head:<8}");
        for k in 4 * line..4 * line + 4 {
            let field = fields.get(k).copied().unwrap_or(Field::Blank);
            text += &format!("{:<WIDTH$}", written(field)?);
        }
        out += text.trim_end();
        out.push('\n');
    }
    Ok(out)
}

fn written(field: Field<'_>) -> Result<String, FormatError> {
    Ok(match field {
        Field::Blank => String::new(),
        Field::Integer(number) => number.to_string(),
        // Sixteen columns hold at least nine digits of any finite number.
        Field::Real(value) => real(finite(value)?, WIDTH, "").unwrap_or_default(),
        Field::Word(text) => {
            word(text, "", 8)?;
            text.to_owned()
        }
    })
}

/// Lines of a comment, at most 72 columns each.
#[must_use]
pub fn comment(text: &str) -> String {
    lines("$", 72, text)
}

#[cfg(test)]
mod tests {
    use super::Field::{Blank, Integer, Real, Word};
    use super::*;

    #[test]
    fn entries_in_large_fields() {
        let text = entry(
            "TABLED1",
            &[
                Integer(7),
                Word("LINEAR"),
                Word("LINEAR"),
                Blank,
                Blank,
                Blank,
                Blank,
                Blank,
                Real(1.0 / 3.0),
                Real(-2e6),
                Word("ENDT"),
            ],
        );
        assert_eq!(
            text.unwrap(),
            "TABLED1*7               LINEAR          LINEAR\n\
             *\n\
             *       0.33333333333333-2000000.       ENDT\n\
             *\n"
        );
        for line in entry("MAT1", &[Integer(1), Real(-1.0 / 3.0e-7)]).unwrap().lines() {
            assert!(line.len() <= 72, "{line}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |fields: &[Field<'_>]| entry("MAT1", fields).unwrap_err().to_string();
        assert_eq!(error(&[Real(f64::INFINITY)]), "input: expected a finite number, found inf");
        assert!(error(&[Word("NINECHARS")]).contains("\"NINECHARS\""));
        assert!(entry("TOOLONGA", &[]).is_err());
    }
}
