//! Lines of a text part, each with its number.

use memchr::memchr;

/// One line without its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    /// Line number in the file, from 1.
    pub(super) number: usize,
    /// The line without `\n` or `\r\n`.
    pub(super) bytes: &'a [u8],
}

/// The lines of a part of a file, in order.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    next_number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `text`, the first of which has this number in the file.
    pub(super) fn new(text: &'a [u8], first_number: usize) -> Self {
        Self { rest: text, next_number: first_number }
    }

    /// What has not been read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The number of the line that comes next.
    pub(super) fn next_number(&self) -> usize {
        self.next_number
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = match memchr(b'\n', self.rest) {
            Some(end) => (&self.rest[..end], &self.rest[end + 1..]),
            None => (self.rest, &self.rest[self.rest.len()..]),
        };
        let number = self.next_number;
        self.rest = rest;
        self.next_number += 1;
        Some(Line { number, bytes: line.strip_suffix(b"\r").unwrap_or(line) })
    }
}

impl Line<'_> {
    /// Whether nothing is on the line.
    pub(super) fn is_blank(&self) -> bool {
        self.bytes.iter().copied().all(is_blank)
    }

    /// The line as text: UTF-8 where it is that, otherwise Latin-1; control characters become blanks.
    pub(super) fn text(&self) -> String {
        let visible = |c: char| if c.is_control() { ' ' } else { c };
        match std::str::from_utf8(self.bytes) {
            Ok(text) => text.chars().map(visible).collect(),
            Err(_) => self.bytes.iter().map(|&byte| visible(char::from(byte))).collect(),
        }
    }
}

/// Blanks between fields and at line ends; NUL and SUB are what old systems fill and end text files with.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0 | 0x1A)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_of_both_kinds_and_none() {
        let lines: Vec<_> = Lines::new(b"a\r\n\nb", 7).map(|line| (line.number, line.bytes)).collect();
        assert_eq!(lines, [(7, &b"a"[..]), (8, b""), (9, b"b")]);
    }

    #[test]
    fn latin_1_and_utf_8_read_the_same() {
        let line = |bytes| Line { number: 1, bytes };
        assert_eq!(line(b"m/s\xb2\t.").text(), "m/s² .");
        assert_eq!(line("m/s²".as_bytes()).text(), "m/s²");
    }
}
