//! Input decks of solvers, as text: cards, keywords, commands, and the numbers in them. What they mean is the caller's to know.
//!
//! | solver | module | what is written |
//! |---|---|---|
//! | Nastran | [`bulk`] | entries of the bulk data in large fields |
//! | Abaqus | [`keyword`] | keyword lines and data lines |
//! | Ansys Mechanical APDL | [`command`] | commands |
//!
//! Every writer refuses what the solver could not read: a number that is not finite, text that does not fit its field.

pub mod bulk;
pub mod command;
pub mod keyword;
mod real;

pub use real::real;

use crate::FormatError;

/// Lines of a comment, each with its mark, broken between words so that none is longer than `width` characters where its words allow.
fn comment(mark: &str, width: usize, text: &str) -> String {
    let mut out = String::new();
    for paragraph in text.lines() {
        let mut line = mark.to_owned();
        for word in paragraph.split_whitespace() {
            if line.len() > mark.len() && line.chars().count() + 1 + word.chars().count() > width {
                out += &line;
                out.push('\n');
                line = mark.to_owned();
            }
            line.push(' ');
            line += word;
        }
        out += &line;
        out.push('\n');
    }
    out
}

/// A number that a deck can hold.
fn finite(value: f64) -> Result<f64, FormatError> {
    if value.is_finite() { Ok(value) } else { Err(FormatError::whole("a finite number", value.to_string())) }
}

/// A word of letters, digits and the listed signs, of at most `longest` characters, beginning with a letter.
fn word(text: &str, signs: &str, longest: usize) -> Result<(), FormatError> {
    let known = |c: char| c.is_ascii_alphanumeric() || signs.contains(c);
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic());
    match begins && text.len() <= longest && text.chars().all(known) {
        true => Ok(()),
        false => {
            let among: Vec<String> = signs.chars().map(|sign| format!("{sign:?}")).collect();
            let also = if among.is_empty() { String::new() } else { format!(" and {}", among.join(", ")) };
            let expected =
                format!("a word of at most {longest} letters, digits{also}, beginning with a letter");
            Err(FormatError::whole(expected, format!("{text:?}")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_broken_between_words() {
        assert_eq!(comment("$", 12, "one two three\n\nsix"), "$ one two\n$ three\n$\n$ six\n");
        assert_eq!(comment("**", 6, "unbreakable a"), "** unbreakable\n** a\n");
    }

    #[test]
    fn words_are_checked() {
        assert!(word("CORE_1", "_-", 8).is_ok());
        for wrong in ["", "1core", "a,b", "a b", "toolongword", "é"] {
            assert!(word(wrong, "_-", 8).is_err(), "{wrong:?}");
        }
        let error = word("a b", "_", 8).unwrap_err().to_string();
        assert_eq!(
            error,
            "input: expected a word of at most 8 letters, digits and '_', beginning with a letter, found \"a b\""
        );
    }
}
