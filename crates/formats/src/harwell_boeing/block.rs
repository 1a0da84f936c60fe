//! A block of lines that one Fortran READ takes: so many fields by one format.

use super::fortran::{Field, Format};
use crate::FormatError;
use crate::text::{FINITE, Line, Lines, Tokens, quoted, whole};

/// The fields of a block, one after another; each block begins with a new line.
pub(super) struct Block<'f, 'l, 'a> {
    lines: &'l mut Lines<'a>,
    format: &'f Format,
    /// What the fields are, for errors: "row index".
    name: &'static str,
    count: u64,
    taken: u64,
    line: Line<'a>,
    /// The tokens of the line, where they do not stand in the columns of the format.
    out_of_place: Option<Tokens<'a>>,
}

impl<'f, 'l, 'a> Block<'f, 'l, 'a> {
    pub(super) fn new(lines: &'l mut Lines<'a>, format: &'f Format, name: &'static str, count: u64) -> Self {
        let line = Line { number: 0, bytes: &[] };
        Self { lines, format, name, count, taken: 0, line, out_of_place: None }
    }

    /// The characters of the next field without the blanks around them, and where they start.
    fn next(&mut self) -> Result<(Field, usize, &'a [u8]), FormatError> {
        let in_line = (self.taken % self.format.fields.len() as u64) as usize;
        if in_line == 0 {
            self.next_line()?;
        }
        self.taken += 1;
        let field = self.format.fields[in_line];
        if let Some(tokens) = &mut self.out_of_place {
            let (start, token) = tokens.take();
            return Ok((field, start, token));
        }
        let rest = self.line.bytes.get(field.start..).unwrap_or(&[]);
        let characters = &rest[..rest.len().min(field.width)];
        let blanks = characters.iter().take_while(|&&b| b == b' ').count();
        Ok((field, field.start + blanks, characters.trim_ascii_end().get(blanks..).unwrap_or(&[])))
    }

    fn next_line(&mut self) -> Result<(), FormatError> {
        self.line = self.lines.next().ok_or_else(|| {
            let expected = format!("{} {} fields", self.count, self.name);
            let found = format!("the end of the file after {}", self.taken);
            FormatError::line(self.lines.taken, expected, found)
        })?;
        // Some writers (SciPy's among them) do not keep to the columns that their format says. Where a line
        // has as many tokens as it should have fields, but not in their columns, the tokens are the fields.
        let fields = &self.format.fields;
        let due = fields.len().min(usize::try_from(self.count - self.taken).unwrap_or(usize::MAX));
        let (mut tokens, mut count, mut is_in_place) = (Tokens::new(self.line), 0, true);
        while let (start, token @ [_, ..]) = tokens.take() {
            is_in_place &= fields.get(count).is_some_and(|f| f.holds(start, token.len()));
            count += 1;
        }
        self.out_of_place = (count == due && !is_in_place).then(|| Tokens::new(self.line));
        Ok(())
    }

    /// A whole number from `least` to `most`.
    pub(super) fn whole(&mut self, least: u64, most: u64) -> Result<u64, FormatError> {
        let (field, start, characters) = self.next()?;
        match whole(characters) {
            Some(n) if (least..=most).contains(&n) => Ok(n),
            _ => {
                let expected = format!("a {} from {least} to {most}", self.name);
                Err(self.error(field, start, characters, &expected))
            }
        }
    }

    pub(super) fn number(&mut self) -> Result<f64, FormatError> {
        let (field, start, characters) = self.next()?;
        self.format
            .number(field, characters)
            .ok_or_else(|| self.error(field, start, characters, &format!("{FINITE} as {}", self.name)))
    }

    /// An error about a field, with the columns it is cut from.
    fn error(&self, field: Field, start: usize, characters: &[u8], expected: &str) -> FormatError {
        let (first, last) = (field.start + 1, field.start + field.width);
        let (start, found) = match characters {
            [] => (field.start, "a blank field".into()),
            _ if characters.contains(&b'\t') => (start, "a tab (fields are cut by column)".into()),
            _ => (start, quoted(characters)),
        };
        self.line.error(start, format!("{expected} in columns {first} to {last}"), found)
    }

    /// Number of the line that the last field was in.
    pub(super) fn line_number(&self) -> usize {
        self.line.number
    }
}
