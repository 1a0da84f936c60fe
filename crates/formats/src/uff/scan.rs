//! Where the datasets of a file are.

use memchr::memchr_iter;

use crate::FormatError;

use super::binary;
use super::delimiter::{self, Delimiter, Run};
use super::entry::Entry;
use super::lines::Lines;
use super::read_header::{HEADER_RECORDS, function_header};
use super::title::Title;

/// Lists the datasets of a file without reading them.
///
/// A line `-1` *inside* a dataset does not end it: the closing one is followed by the end of the file or by
/// the opening one of the next dataset. Binary data are stepped over by their byte count; where that leads
/// to no closing line (some writers count wrongly), by the number of points, and at last by a search.
/// What stands between datasets is ignored. Time is linear in the length of the file.
///
/// # Errors
///
/// There is no dataset, one is not closed, or its number cannot be read.
pub fn scan(bytes: &[u8]) -> Result<Vec<Entry>, FormatError> {
    let mut entries = Vec::new();
    let mut line_count = LineCount { bytes, counted: 0, line: 1 };
    let mut from = 0;
    while let Some(Run { last: opening, next_line: Some(number_line), .. }) = delimiter::next_run(bytes, from)
    {
        let line = line_count.at(opening.start);
        let title_line = line_count.at(number_line);
        let title_bytes = delimiter::line_at(bytes, number_line);
        let title = Title::read(title_bytes).ok_or_else(|| not_a_number(title_bytes, title_line))?;
        let body_start = (number_line + title_bytes.len() + 1).min(bytes.len());
        let unclosed = || unclosed(line, title.dataset);
        let (body_end, closing) = match title.binary_length {
            None => closing_of_text(bytes, body_start).map(|c| (c.start, c)).ok_or_else(unclosed)?,
            Some(length) => closing_of_binary(bytes, body_start, length).ok_or_else(unclosed)?,
        };
        entries.push(Entry {
            dataset: title.dataset,
            line,
            bytes: opening.start..closing.end,
            body: body_start..body_end,
            binary: title.binary_form(),
        });
        from = closing.end;
    }
    entries.shrink_to_fit();
    if entries.is_empty() {
        return Err(FormatError::whole("a universal file: a line with -1 in columns 5-6", "none"));
    }
    Ok(entries)
}

/// The closing delimiter of a text dataset whose body begins at `from`.
fn closing_of_text(bytes: &[u8], mut from: usize) -> Option<Delimiter> {
    let mut lone = None;
    while let Some(run) = delimiter::next_run(bytes, from) {
        let opens = run.next_line.map(|line| Title::read(delimiter::line_at(bytes, line)).is_some());
        match (opens, run.before_last, lone) {
            (None, _, _) => return Some(run.last),
            (Some(true), Some(closing), _) => return Some(closing),
            // What is between the lone delimiter and this opening one belongs to no dataset.
            (Some(true), None, Some(closing)) => return Some(closing),
            _ => lone = Some(run.last),
        }
        from = run.last.end;
    }
    lone
}

/// Where the binary data end and the closing delimiter, for a body that begins at `from`.
fn closing_of_binary(bytes: &[u8], from: usize, length: u64) -> Option<(usize, Delimiter)> {
    let mut lines = Lines::new(bytes.get(from..)?, 1);
    lines.by_ref().take(HEADER_RECORDS).for_each(drop);
    let start = bytes.len() - lines.rest().len();
    let closed_after = |length: usize| {
        let end = start.checked_add(length)?;
        after_line_end(bytes, end).map(|closing| (end, closing))
    };
    let by_count = usize::try_from(length).ok().and_then(closed_after);
    let by_points = || {
        let header = function_header(&mut Lines::new(bytes.get(from..)?, 1)).ok()?;
        binary::lengths(&header).into_iter().flatten().find_map(closed_after)
    };
    let by_search = || {
        let closing = delimiter::search_in_binary(bytes, start)?;
        Some((closing.start, closing))
    };
    by_count.or_else(by_points).or_else(by_search)
}

/// The delimiter at this byte, or after the line end at this byte.
fn after_line_end(bytes: &[u8], end: usize) -> Option<Delimiter> {
    let line_end = bytes.get(end..)?.iter().take(2).take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
    delimiter::at(bytes, end + line_end)
}

/// Counts lines, each byte of the file once.
struct LineCount<'a> {
    bytes: &'a [u8],
    counted: usize,
    line: usize,
}

impl LineCount<'_> {
    /// The line in which this byte is; offsets have to be asked for in rising order.
    fn at(&mut self, offset: usize) -> usize {
        let between = self.bytes.get(self.counted..offset).unwrap_or_default();
        self.line += memchr_iter(b'\n', between).count();
        self.counted = offset;
        self.line
    }
}

fn unclosed(line: usize, dataset: u32) -> FormatError {
    FormatError::line(line, format!("dataset {dataset} closed by a line with -1"), "the end of the file")
}

fn not_a_number(title: &[u8], line: usize) -> FormatError {
    let shown: String = String::from_utf8_lossy(title).trim().chars().take(20).collect();
    FormatError::column(line, 1, "a dataset number", format!("{shown:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(bytes: &[u8]) -> Vec<(u32, usize, &[u8])> {
        let entries = scan(bytes).expect("a readable list");
        entries.into_iter().map(|e| (e.dataset, e.line, &bytes[e.body])).collect()
    }

    #[test]
    fn two_datasets_with_rubbish_around_them() {
        let bytes = b"rubbish\n    -1\n    15\na\n    -1\nrubbish\n    -1\n  2411\nb\n    -1\nrubbish\n";
        assert_eq!(listed(bytes), [(15, 2, &b"a\n"[..]), (2411, 7, b"b\n")]);
    }

    #[test]
    fn a_line_of_minus_one_inside_does_not_close() {
        let bytes = b"    -1\n   999\n     7\n    -1\n  8 9\n    -1\n  8 9\n    -1\n    -1\n    15\n    -1\n";
        assert_eq!(
            listed(bytes),
            [(999, 1, &b"     7\n    -1\n  8 9\n    -1\n  8 9\n"[..]), (15, 9, &b""[..])]
        );
    }

    #[test]
    fn a_missing_end_and_a_missing_number_are_errors() {
        assert_eq!(scan(b"    -1\n    15\n 1\n"), Err(unclosed(1, 15)));
        assert_eq!(
            scan(b"\n    -1\nabc\n    -1\n").map_err(|error| error.position),
            Err(crate::Position::Line { line: 3, column: Some(1) })
        );
        assert!(scan(b"").is_err());
        assert!(scan(b"0.1,0.2\n").is_err());
    }
}
