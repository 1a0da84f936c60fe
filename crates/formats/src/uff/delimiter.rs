//! The lines between datasets: `-1` in columns 5–6, nothing else.

use memchr::{memchr, memmem};

use super::lines::is_blank;

const MARK: &[u8] = b"    -1";

/// A delimiter line, as byte offsets in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Delimiter {
    /// Where the line begins.
    pub(super) start: usize,
    /// Where the next line begins.
    pub(super) end: usize,
}

/// Delimiters with nothing but blank lines between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    /// The last but one.
    pub(super) before_last: Option<Delimiter>,
    /// The last.
    pub(super) last: Delimiter,
    /// Where the first line with something else on it begins; `None` at the end of the file.
    pub(super) next_line: Option<usize>,
}

/// The first run of delimiters that begins at or after the byte `from`.
pub(super) fn next_run(bytes: &[u8], from: usize) -> Option<Run> {
    let tail = bytes.get(from..)?;
    let at_line_start = |&start: &usize| start == 0 || bytes.get(start - 1) == Some(&b'\n');
    let candidates = memmem::find_iter(tail, MARK).map(|at| from + at).filter(at_line_start);
    let mut last = candidates.filter_map(|start| at(bytes, start)).next()?;
    let mut before_last = None;
    loop {
        let next_line = next_filled_line(bytes, last.end);
        match next_line.and_then(|start| at(bytes, start)) {
            Some(next) => (before_last, last) = (Some(last), next),
            None => return Some(Run { before_last, last, next_line }),
        }
    }
}

/// The delimiter that begins at this byte, whatever is before it.
pub(super) fn at(bytes: &[u8], start: usize) -> Option<Delimiter> {
    let after = bytes.get(start..)?.strip_prefix(MARK)?;
    let end = bytes.len() - after.len();
    let line_length = after.iter().position(|&byte| byte == b'\n' || !is_blank(byte));
    match line_length {
        None => Some(Delimiter { start, end: bytes.len() }),
        Some(length) if after.get(length) == Some(&b'\n') => Some(Delimiter { start, end: end + length + 1 }),
        Some(_) => None,
    }
}

/// Where the first line at or after `from` begins that is not blank.
pub(super) fn next_filled_line(bytes: &[u8], from: usize) -> Option<usize> {
    let filled = from + bytes.get(from..)?.iter().position(|&byte| !is_blank(byte))?;
    let before = bytes.get(from..filled)?;
    Some(from + memchr::memrchr(b'\n', before).map_or(0, |newline| newline + 1))
}

/// Where the delimiter begins that a search in binary data finds: followed by another one, or by nothing.
pub(super) fn search_in_binary(bytes: &[u8], from: usize) -> Option<Delimiter> {
    let closes = |delimiter: &Delimiter| {
        next_filled_line(bytes, delimiter.end).is_none_or(|start| at(bytes, start).is_some())
    };
    let candidates = memmem::find_iter(bytes.get(from..)?, MARK).map(|at| from + at);
    candidates.filter_map(|start| at(bytes, start)).find(closes)
}

/// The line that begins at this byte, without its end.
pub(super) fn line_at(bytes: &[u8], start: usize) -> &[u8] {
    let tail = bytes.get(start..).unwrap_or_default();
    memchr(b'\n', tail).and_then(|end| tail.get(..end)).unwrap_or(tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_line_of_its_own_delimits() {
        assert!(next_run(b"NONE              -1   0\n", 0).is_none());
        assert!(next_run(b"        -1\n", 0).is_none());
        assert!(next_run(b"    -1    2\n", 0).is_none());
        assert!(next_run(b"    -1.5\n", 0).is_none());
        let run = next_run(b"x\n    -1 \t\r\n", 0).expect("a delimiter");
        assert_eq!((run.last, run.next_line), (Delimiter { start: 2, end: 12 }, None));
    }

    #[test]
    fn blank_lines_do_not_interrupt_a_run() {
        let run = next_run(b"    -1\n\r\n  \n    -1\n\n    58\n", 0).expect("a run");
        assert_eq!(run.before_last, Some(Delimiter { start: 0, end: 7 }));
        assert_eq!(run.last, Delimiter { start: 12, end: 19 });
        assert_eq!(run.next_line, Some(20));
    }

    #[test]
    fn in_binary_data_a_delimiter_needs_another_one_or_the_end() {
        let bytes = b"\x01\x02    -1\n\x03\x04    -1\n    -1\n    58\n";
        assert_eq!(search_in_binary(bytes, 0), Some(Delimiter { start: 11, end: 18 }));
    }
}
