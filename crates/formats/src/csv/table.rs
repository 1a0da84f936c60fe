//! The table: cells with their places.

use csv_core::{ReadFieldResult, Reader, ReaderBuilder, Terminator};

use crate::FormatError;
use crate::text::{FINITE, Line, Lines, number, quoted, whole};

/// A table with named columns. Rows and columns are counted from 0.
#[derive(Debug, Clone)]
pub struct Table {
    /// The cells' text, one after the other; the names of the columns first.
    text: String,
    cells: Vec<Place>,
    /// Line numbers: of the names, then of each row.
    lines: Vec<usize>,
    /// Number of columns.
    width: usize,
    /// Whether numbers have a decimal comma.
    has_decimal_comma: bool,
}

/// Where a cell ends in the table's text, and in which column of its line it begins (in characters, from 1).
#[derive(Debug, Clone, Copy)]
struct Place {
    end: u32,
    column: u32,
}

impl Table {
    /// Reads a table. Blank lines and lines that begin with `#` are skipped, blanks around cells removed.
    ///
    /// # Errors
    /// No line with names; a row with more or fewer cells than names; a quote that is not closed on its line;
    /// text that is not UTF-8.
    ///
    /// # Limits
    /// A cell is on one line. The file is smaller than 4 GiB.
    pub fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        Self::read_with(bytes, None)
    }

    /// The same of a table whose columns are named by the caller. A first line that is not all numbers is passed over: it has the table's own names.
    ///
    /// # Errors
    /// As [`Table::read`]; another number of columns than of names.
    pub fn read_named(bytes: &[u8], names: &[&str]) -> Result<Self, FormatError> {
        Self::read_with(bytes, Some(names))
    }

    fn read_with(bytes: &[u8], given: Option<&[&str]>) -> Result<Self, FormatError> {
        if u32::try_from(bytes.len()).is_err() {
            return Err(FormatError::whole("a table of less than 4 GiB", format!("{} bytes", bytes.len())));
        }
        let is_row = |line: &Line<'_>| !line.is_blank() && !line.bytes.trim_ascii_start().starts_with(b"#");
        let mut rows = Lines::new(bytes).filter(is_row).peekable();
        let Some(names) = rows.peek() else {
            return Err(FormatError::whole("a line with the names of the columns", "none"));
        };
        let delimiter = delimiter(names.bytes);
        // Room for every cell there can be: growing by doubling could take three times that.
        let lines = 1 + memchr::memchr_iter(b'\n', bytes).count();
        let delimiters = memchr::memchr_iter(delimiter, bytes).count();
        let mut table = Self {
            text: String::with_capacity(bytes.len()),
            cells: Vec::with_capacity(lines + delimiters),
            lines: Vec::with_capacity(lines),
            width: 0,
            has_decimal_comma: false,
        };
        for name in given.unwrap_or_default() {
            table.text.push_str(name);
            table.cells.push(Place { end: table.text.len() as u32, column: 1 });
        }
        let given_text = table.text.len();
        // Lines are cut before: to the tokeniser no byte ends a row.
        let mut reader = ReaderBuilder::new().delimiter(delimiter).terminator(Terminator::Any(b'\n')).build();
        for line in rows {
            let before = table.cells.len();
            table.push_row(&mut reader, line)?;
            let width = table.cells.len() - before;
            if let (Some(given), true) = (given, table.lines.is_empty()) {
                table.width = given.len();
                table.lines.push(line.number);
                if width != given.len() {
                    let expected = format!("{} columns, one for each name", given.len());
                    return Err(FormatError::line(line.number, expected, width.to_string()));
                }
                let own: Vec<&str> = (before..before + width).map(|k| table.cell(k)).collect();
                if own
                    .iter()
                    .any(|cell| number_with(cell, true).or_else(|| number_with(cell, false)).is_none())
                {
                    table.cells.truncate(before);
                    table.text.truncate(given_text);
                    continue;
                }
            }
            if table.lines.is_empty() {
                table.width = width;
            } else if width != table.width {
                return Err(FormatError::line(
                    line.number,
                    format!("{} cells", table.width),
                    ragged(width, line),
                ));
            }
            table.lines.push(line.number);
        }
        table.has_decimal_comma = delimiter != b',' && table.has_decimal_commas();
        Ok(table)
    }

    /// Whether some number below the names has a decimal comma, and none a decimal point.
    fn has_decimal_commas(&self) -> bool {
        let mut found = false;
        for k in self.width..self.cells.len() {
            let cell = self.cell(k);
            if cell.contains('.') && number_with(cell, false).is_some() {
                return false;
            }
            found |= cell.contains(',') && number_with(cell, true).is_some();
        }
        found
    }

    fn push_row(&mut self, reader: &mut Reader, line: Line<'_>) -> Result<(), FormatError> {
        if let Err(error) = std::str::from_utf8(line.bytes) {
            let at = error.valid_up_to();
            return Err(line.error(at, "text in UTF-8", format!("the byte 0x{:02X}", line.bytes[at])));
        }
        if let Some(at) = memchr::memchr(b'\r', line.bytes) {
            return Err(line.error(at, "lines that end with LF or CR LF", "a CR inside a line"));
        }
        reader.reset();
        let mut cell = vec![0; line.bytes.len()];
        let (mut at, mut column) = (0, 1);
        loop {
            let (result, taken, length) = reader.read_field(&line.bytes[at..], &mut cell);
            let raw = &line.bytes[at..at + taken];
            let is_last = match result {
                ReadFieldResult::Field { record_end } => record_end,
                // The line is used up: an empty input makes the reader end the field, unless in quotes.
                _ => true,
            };
            let is_quoted = raw.first() == Some(&b'"');
            if is_quoted && !is_closed(raw) {
                return Err(line.error(at, "a closing quote on the same line", "the end of the line"));
            }
            let text = String::from_utf8_lossy(&cell[..length]);
            self.text.push_str(if is_quoted { &text } else { text.trim() });
            let blanks = if is_quoted { 0 } else { leading_blanks(raw) };
            self.cells.push(Place { end: self.text.len() as u32, column: column + blanks });
            column += raw.iter().filter(|&&b| b & 0xC0 != 0x80).count() as u32;
            at += taken;
            if is_last {
                return Ok(());
            }
        }
    }

    /// Number of rows below the names.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.lines.len().saturating_sub(1)
    }

    /// The names of the columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        (0..self.width).map(|column| self.cell(column))
    }

    /// The text of a cell; nothing outside the table.
    #[must_use]
    pub fn text(&self, row: usize, column: usize) -> &str {
        if column < self.width { self.cell((row + 1) * self.width + column) } else { "" }
    }

    /// Whether a cell is empty.
    #[must_use]
    pub fn is_empty(&self, row: usize, column: usize) -> bool {
        self.text(row, column).is_empty()
    }

    fn cell(&self, k: usize) -> &str {
        let end = |k: usize| self.cells.get(k).map(|place| place.end as usize);
        let start = if k == 0 { Some(0) } else { end(k - 1) };
        start.zip(end(k)).and_then(|(start, end)| self.text.get(start..end)).unwrap_or("")
    }

    /// A cell as a number.
    ///
    /// # Errors
    /// A cell that is not a finite number with the decimal sign of the table.
    pub fn number(&self, row: usize, column: usize) -> Result<f64, FormatError> {
        let text = self.text(row, column);
        if let Some(value) = number_with(text, self.has_decimal_comma) {
            return Ok(value);
        }
        let with_point = text.replacen(',', ".", 1);
        Err(if with_point != text && number(with_point.as_bytes()).is_some() {
            let expected = format!("a decimal point as in other cells (write {with_point})");
            self.error(row, column, expected, format!("a decimal comma in {}", quoted(text.as_bytes())))
        } else {
            self.error(row, column, FINITE, self.shown(row, column))
        })
    }

    /// A cell as a whole number of at least `least`.
    ///
    /// # Errors
    /// A cell that holds no such number.
    pub fn whole(&self, row: usize, column: usize, least: u64) -> Result<u64, FormatError> {
        whole(self.text(row, column).as_bytes()).filter(|&n| n >= least).ok_or_else(|| {
            self.error(row, column, format!("a whole number from {least} on"), self.shown(row, column))
        })
    }

    /// A cell as an error shows it.
    pub(super) fn shown(&self, row: usize, column: usize) -> String {
        if self.is_empty(row, column) {
            "an empty cell".into()
        } else {
            quoted(self.text(row, column).as_bytes())
        }
    }

    /// An error at a cell: its line, its column in characters, and the name of its column.
    #[must_use]
    pub fn error(
        &self,
        row: usize,
        column: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> FormatError {
        let expected = format!("{} in column {}", expected.into(), quoted(self.cell(column).as_bytes()));
        match self.cells.get((row + 1) * self.width + column) {
            Some(place) => FormatError::column(self.line(row), place.column as usize, expected, found),
            None => FormatError::whole(expected, found),
        }
    }

    /// An error at the name of a column.
    pub(super) fn name_error(&self, column: usize, expected: String, found: String) -> FormatError {
        let column = self.cells.get(column).map_or(1, |place| place.column as usize);
        FormatError::column(self.lines.first().copied().unwrap_or(1), column, expected, found)
    }

    /// The line of a row, counted from 1.
    #[must_use]
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row + 1).copied().unwrap_or(0)
    }

    /// The line with the names, counted from 1.
    #[must_use]
    pub fn names_line(&self) -> usize {
        self.lines.first().copied().unwrap_or(0)
    }
}

/// A cell as a number with a decimal point, or with a decimal comma.
fn number_with(text: &str, has_comma: bool) -> Option<f64> {
    match has_comma && text.contains(',') {
        true if text.contains('.') => None,
        true => number(text.replacen(',', ".", 1).as_bytes()),
        false => number(text.as_bytes()),
    }
}

/// The delimiter that separates the names: a semicolon, else a tab, else a comma, outside quotes.
fn delimiter(names: &[u8]) -> u8 {
    let mut in_quotes = false;
    let mut found = [false; 2];
    for byte in names {
        match byte {
            b'"' => in_quotes = !in_quotes,
            b';' if !in_quotes => found[0] = true,
            b'\t' if !in_quotes => found[1] = true,
            _ => {}
        }
    }
    match found {
        [true, _] => b';',
        [false, true] => b'\t',
        [false, false] => b',',
    }
}

/// Whether a field that begins with a quote also ends with one, in the bytes up to its delimiter.
fn is_closed(raw: &[u8]) -> bool {
    raw.iter().filter(|&&b| b == b'"').count() % 2 == 0
}

fn leading_blanks(raw: &[u8]) -> u32 {
    raw.iter().take_while(|b| **b == b' ').count() as u32
}

/// How many cells a row has, with a guess at the reason.
fn ragged(width: usize, line: Line<'_>) -> String {
    let has_decimal_commas =
        line.bytes.windows(3).any(|w| w[1] == b',' && w[0].is_ascii_digit() && w[2].is_ascii_digit());
    let hint = if has_decimal_commas { " (a decimal comma? write 1.5)" } else { "" };
    format!("{width}{hint}")
}
