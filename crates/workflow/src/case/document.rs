//! The text of a case file as a TOML document, with lines and columns.

use crate::error::{InputError, Place};
use frfit_formats::Position;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

/// The text and whose it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Document<'a> {
    file: &'a Path,
    text: &'a str,
}

impl<'a> Document<'a> {
    /// The text of a file.
    ///
    /// # Errors
    /// Bytes that are not UTF-8.
    pub(super) fn new(file: &'a Path, bytes: &'a [u8]) -> Result<Self, InputError> {
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self { file, text }),
            Err(error) => {
                let (text, byte) = (error.valid_up_to(), bytes[error.valid_up_to()]);
                let good = std::str::from_utf8(&bytes[..text]).unwrap_or_default();
                let place = Self { file, text: good }.place(text..text, None);
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

    /// The place of a byte range.
    pub(super) fn place(&self, range: Range<usize>, key: Option<String>) -> Place {
        let before = self.text.get(..range.start).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = 1 + before.bytes().filter(|&byte| byte == b'\n').count();
        let column = 1 + before[line_start..].trim_start_matches('\u{feff}').chars().count();
        let position = Position::Line { line, column: Some(column) };
        Place { file: Some(self.file.to_path_buf()), position, key }
    }
}
