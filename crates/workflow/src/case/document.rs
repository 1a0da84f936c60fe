//! The text of a case file as a TOML document, with lines and columns.

use crate::error::{InputError, Place};
use frfit_formats::Position;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

/// The text and whose it is.
#[derive(Debug)]
pub(super) struct Document<'a> {
    file: &'a Path,
    text: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
}

impl<'a> Document<'a> {
    /// The text of a file.
    ///
    /// # Errors
    /// Bytes that are not UTF-8.
    pub(super) fn new(file: &'a Path, bytes: &'a [u8]) -> Result<Self, InputError> {
        let newlines = bytes.iter().enumerate().filter(|&(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(newlines.map(|(at, _)| at + 1)).collect();
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self { file, text, lines }),
            Err(error) => {
                let (good, rest) = bytes.split_at(error.valid_up_to());
                let text = std::str::from_utf8(good).unwrap_or_default();
                let place = Self { file, text, lines }.place(good.len()..good.len(), None);
                let byte = rest.first().copied().unwrap_or_default();
                Err(InputError::at(&place, "text in UTF-8", format!("the byte 0x{byte:02X}")))
            }
        }
    }

    /// The document's tables.
    ///
    /// # Errors
    /// What is not TOML.
    pub(super) fn tables(&self) -> Result<Spanned<DeTable<'a>>, InputError> {
        DeTable::parse(self.text).map_err(|error| {
            let place = self.place(error.span().unwrap_or_default(), None);
            InputError::at(&place, "TOML", format!("a mistake in it ({})", error.message()))
        })
    }

    /// The place of a byte range: its line, and its column where the line is one that a person would count in.
    pub(super) fn place(&self, range: Range<usize>, key: Option<String>) -> Place {
        const LONGEST: usize = 4096;
        let line = self.lines.partition_point(|&start| start <= range.start);
        let start = self.lines.get(line.wrapping_sub(1)).copied().unwrap_or_default();
        let before = self.text.get(start..range.start).filter(|before| before.len() <= LONGEST);
        let column = before.map(|before| 1 + before.trim_start_matches('\u{feff}').chars().count());
        Place { file: Some(self.file.to_path_buf()), position: Position::Line { line, column }, key }
    }
}
