//! Commands of Ansys Mechanical APDL: a name and arguments, separated by commas.
//!
//! # Source
//! Ansys Mechanical APDL Command Reference, "Command Characteristics": one command a line, comments behind `!`, numbers in double precision.

use super::{comment as lines, finite};
use crate::FormatError;

/// An argument of a command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Argument<'a> {
    /// Nothing: the default.
    Blank,
    /// A whole number.
    Integer(u32),
    /// A number, with the shortest digits that read back to the same bits.
    Real(f64),
    /// A word of at most eight characters.
    Word(&'a str),
}

/// One command.
///
/// # Errors
/// A word that does not fit; a number that is not finite.
pub fn command(name: &str, arguments: &[Argument<'_>]) -> Result<String, FormatError> {
    let mut out = name.to_owned();
    for argument in arguments {
        out.push(',');
        match *argument {
            Argument::Blank => {}
            Argument::Integer(number) => out += &number.to_string(),
            Argument::Real(value) => {
                let value = finite(value)?;
                let usual = value == 0.0 || (1e-4..1e12).contains(&value.abs());
                out += &if usual { format!("{value:?}") } else { format!("{value:E}") };
            }
            Argument::Word(text) => {
                super::word(text, "_", 8)?;
                out += text;
            }
        }
    }
    out.push('\n');
    Ok(out)
}

/// Lines of a comment, at most 72 characters each.
#[must_use]
pub fn comment(text: &str) -> String {
    lines("!", 72, text)
}

#[cfg(test)]
mod tests {
    use super::Argument::{Blank, Integer, Real, Word};
    use super::*;

    #[test]
    fn commands() {
        let text = command("TB", &[Word("SDAMP"), Integer(3), Blank, Blank, Word("STRU")]);
        assert_eq!(text.unwrap(), "TB,SDAMP,3,,,STRU\n");
        let text = command("TBDATA", &[Integer(1), Real(2.5e6), Real(7.85e-9), Real(1.0 / 3.0)]);
        assert_eq!(text.unwrap(), "TBDATA,1,2500000.0,7.85E-9,0.3333333333333333\n");
        assert!(command("TBDATA", &[Real(f64::NAN)]).is_err());
        assert!(command("TB", &[Word("a,b")]).is_err());
    }
}
