//! Text on its way to a terminal: what files and names of files contain shall not steer it.

use std::borrow::Cow;
use std::fmt::Write;

/// Text without control characters but the ends of its lines: an escape (27) becomes `\x1b`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c != '\n', |c| format!("\\x{:02x}", c as u32))
}

/// The same for JSON, which stays JSON of the same meaning: it has control characters in its strings only.
pub fn printable_json(json: &str) -> Cow<'_, str> {
    escaped(json, |c| c != '\n', |c| format!("\\u{:04x}", c as u32))
}

/// Text that is part of a line, so that it cannot end it either.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    let code = |c| if c == '\n' { "\\n".to_owned() } else { format!("\\x{:02x}", c as u32) };
    escaped(text, |_| true, code)
}

/// A number for a sentence: six significant digits.
pub fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if size == 0.0 || (1e-3..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// Names in a sentence: the first `most`, and how many more there are.
pub fn listed(names: &[String], most: usize) -> String {
    let shown = names[..names.len().min(most)].join(", ");
    match names.len().saturating_sub(most) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

fn escaped(text: &str, which: impl Fn(char) -> bool, code: impl Fn(char) -> String) -> Cow<'_, str> {
    let is_escaped = |c: char| c.is_control() && which(c);
    if !text.contains(is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        // Writing to a string does not fail.
        let _ = if is_escaped(c) { out.write_str(&code(c)) } else { out.write_char(c) };
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_of_either_set_are_shown_and_lines_are_kept() {
        assert_eq!(printable("E′ = 2\nη\n"), "E′ = 2\nη\n");
        assert_eq!(printable("a\x1b[2Jb\r\x07\u{9b}31m\x7f\n"), "a\\x1b[2Jb\\x0d\\x07\\x9b31m\\x7f\n");
        assert_eq!(one_line("a\nb\tc"), "a\\nb\\x09c");
        let json = serde_json::json!({"title": "\x1b[2J\u{9b}31m\x7f"});
        let shown = printable_json(&format!("{json:#}\n")).into_owned();
        assert!(!shown.replace('\n', "").contains(char::is_control), "{shown}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).unwrap(), json);
    }

    #[test]
    fn a_list_ends_with_how_many_more_there_are() {
        let names = ["a", "b", "c"].map(String::from);
        assert_eq!([0, 1, 3].map(|count| listed(&names[..count], 2)), ["", "a", "a, b and 1 more"]);
        assert_eq!(listed(&names, 3), "a, b, c");
    }

    #[test]
    fn numbers_are_short_and_keep_their_size() {
        assert_eq!(short(0.0), "0");
        assert_eq!(short(6399.9), "6399.9");
        assert_eq!(short(-1.0 / 3.0), "-0.333333");
        assert_eq!(short(39_411_962.742_7), "3.9412e7");
        assert_eq!(short(4.12e-9), "4.12e-9");
        assert_eq!(short(f64::INFINITY), "inf");
    }
}
