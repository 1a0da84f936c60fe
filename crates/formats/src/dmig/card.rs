//! From physical lines to the fields of DMIG cards.

use crate::FormatError;
use crate::text::{Line, Lines, quoted};

/// A field: its line, its start and its text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) line: Line<'a>,
    pub(super) start: usize,
    pub(super) text: &'a [u8],
}

impl Field<'_> {
    pub(super) fn is_blank(&self) -> bool {
        self.text.is_empty()
    }

    /// That something else was expected here.
    pub(super) fn refuse(&self, expected: impl Into<String>) -> FormatError {
        let found = if self.is_blank() { "a blank field".into() } else { quoted(self.text) };
        self.line.error(self.start, expected, found)
    }
}

/// What comes of a card: its first eight fields behind the word DMIG, then four at a time.
pub(super) enum Piece<'a> {
    Head([Field<'a>; 8]),
    Entry([Field<'a>; 4]),
}

/// Hands over all DMIG cards of a file, piece by piece.
pub(super) fn each_piece<'a>(
    bytes: &'a [u8],
    mut take: impl FnMut(Piece<'a>) -> Result<(), FormatError>,
) -> Result<(), FormatError> {
    let mut card: Option<Open<'a>> = None;
    for line in Lines::new(bytes) {
        match kind(line) {
            Kind::Nothing => {}
            Kind::Start => {
                if let Some(Open { head, is_whole: false }) = card.take() {
                    take(Piece::Head(head))?;
                }
                let (fields, count) = fields(line)?;
                let is_whole = count == 8;
                if is_whole {
                    take(Piece::Head(fields))?;
                }
                card = Some(Open { head: fields, is_whole });
            }
            Kind::Continuation => {
                let Some(open) = &mut card else { continue };
                let (fields, count) = fields(line)?;
                let rest = match open.is_whole {
                    true => &fields[..count],
                    // Of a card of large fields the head is on two lines.
                    false => {
                        open.head[4..].copy_from_slice(&fields[..4]);
                        open.is_whole = true;
                        take(Piece::Head(open.head))?;
                        &fields[4..count]
                    }
                };
                for entry in rest.chunks_exact(4) {
                    take(Piece::Entry([entry[0], entry[1], entry[2], entry[3]]))?;
                }
            }
            Kind::Other | Kind::End => {
                if let Some(Open { head, is_whole: false }) = card.take() {
                    take(Piece::Head(head))?;
                }
                card = None;
                if matches!(kind(line), Kind::End) {
                    return Ok(());
                }
            }
        }
    }
    match card {
        Some(Open { head, is_whole: false }) => take(Piece::Head(head)),
        _ => Ok(()),
    }
}

/// The card that continuation lines belong to.
struct Open<'a> {
    head: [Field<'a>; 8],
    /// Whether the head has been handed over; if not, only its first four fields are there.
    is_whole: bool,
}

enum Kind {
    /// Blank, or a comment.
    Nothing,
    Start,
    Continuation,
    Other,
    End,
}

fn kind(line: Line<'_>) -> Kind {
    let name = name(line.bytes);
    match name {
        _ if line.bytes.trim_ascii().is_empty() || line.bytes.trim_ascii_start().starts_with(b"$") => {
            Kind::Nothing
        }
        [] | [b'+' | b'*', ..] => Kind::Continuation,
        _ if is_dmig(name) => Kind::Start,
        _ if name.eq_ignore_ascii_case(b"ENDDATA") => Kind::End,
        _ => Kind::Other,
    }
}

/// The first field.
fn name(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().take(8).position(|&b| b == b',').unwrap_or(bytes.len().min(8));
    bytes[..end].trim_ascii()
}

fn is_dmig(name: &[u8]) -> bool {
    name.strip_suffix(b"*").unwrap_or(name).trim_ascii().eq_ignore_ascii_case(b"DMIG")
}

/// Whether a file has a DMIG card.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    let starts = [&b"DMIG"[..], b"dmig"].into_iter().flat_map(|word| memchr::memmem::find_iter(bytes, word));
    starts.into_iter().any(|at| {
        let begins_line = at == 0 || bytes[at - 1] == b'\n' || bytes[..at] == *b"\xEF\xBB\xBF";
        begins_line && bytes.get(at + 4).is_some_and(|b| b" *,".contains(b))
    })
}

/// The fields behind the first, blank where the card has no more, and how many of them count: eight, or four large ones.
fn fields(line: Line<'_>) -> Result<([Field<'_>; 8], usize), FormatError> {
    let end = memchr::memchr(b'$', line.bytes).unwrap_or(line.bytes.len());
    let bytes = &line.bytes[..end];
    let first = name(bytes);
    let is_large = first.starts_with(b"*") || first.ends_with(b"*");
    let count = if is_large { 4 } else { 8 };
    let mut fields = [Field { line, start: end, text: &[] }; 8];
    if let Some(comma) = memchr::memchr(b',', bytes) {
        let mut start = comma + 1;
        for (k, text) in bytes[start..].split(|&b| b == b',').enumerate() {
            let trimmed = text.trim_ascii();
            let field =
                Field { line, start: start + text.len() - text.trim_ascii_start().len(), text: trimmed };
            match fields[..count].get_mut(k) {
                Some(place) => *place = field,
                // The field after the last names the line that goes on, or is blank.
                None if k == count && matches!(trimmed, [] | [b'+' | b'*', ..]) => {}
                None => return Err(field.refuse(format!("at most {count} fields behind the first"))),
            }
            start += text.len() + 1;
        }
        return Ok((fields, count));
    }
    if let Some(tab) = memchr::memchr(b'\t', bytes) {
        return Err(line.error(tab, "blanks or commas between fields", "a tab"));
    }
    let width = 64 / count;
    for (k, field) in fields[..count].iter_mut().enumerate() {
        let from = (8 + k * width).min(bytes.len());
        let text = &bytes[from..(from + width).min(bytes.len())];
        let start = from + text.len() - text.trim_ascii_start().len();
        *field = Field { line, start, text: text.trim_ascii() };
    }
    Ok((fields, count))
}
