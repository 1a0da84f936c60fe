//! Fields at fixed columns of a header line.

use std::str::FromStr;

use crate::FormatError;

use super::number;

/// A field of a line: its text without blanks around it, and where it is.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Field<'a> {
    text: &'a str,
    line: usize,
    column: usize,
}

/// The fields of these widths, one after the other, in characters. What a short line lacks is blank.
pub(super) fn fields<'a, const N: usize>(text: &'a str, line: usize, widths: [usize; N]) -> [Field<'a>; N] {
    let mut rest = text;
    let mut column = 1;
    widths.map(|width| {
        let end = rest.char_indices().nth(width).map_or(rest.len(), |(end, _)| end);
        let (field, after) = rest.split_at(end);
        let found = Field { text: field.trim(), line, column };
        (rest, column) = (after, column + width);
        found
    })
}

/// Reads a line by its columns and, where they hold something else, word by word.
pub(super) fn fixed_or_free<T, const N: usize>(
    text: &str,
    line: usize,
    widths: [usize; N],
    read: impl Fn([Field<'_>; N]) -> Result<T, FormatError>,
) -> Result<T, FormatError> {
    read(fields(text, line, widths)).or_else(|error| {
        let free = words(text, line, widths).ok_or_else(|| error.clone())?;
        read(free).map_err(|_| error)
    })
}

/// The words of a line that keeps the order of the fields but not their columns; `None` where there are not
/// as many words as fields or a word is wider than its field.
fn words<'a, const N: usize>(text: &'a str, line: usize, widths: [usize; N]) -> Option<[Field<'a>; N]> {
    let mut words = text.split_whitespace();
    let found = widths.map(|width| {
        let word = words.next().filter(|word| word.chars().count() <= width)?;
        Some(Field { text: word, line, column: 1 })
    });
    let fits = words.next().is_none() && found.iter().all(Option::is_some);
    fits.then(|| found.map(Option::unwrap_or_default))
}

impl Field<'_> {
    /// Whether there is nothing in the field.
    pub(super) fn is_blank(&self) -> bool {
        self.text.is_empty()
    }

    /// The text; empty for `NONE`.
    pub(super) fn text(&self) -> String {
        if self.text == "NONE" { String::new() } else { self.text.to_owned() }
    }

    /// The integer; 0 for a blank field.
    pub(super) fn integer<T: FromStr + Default>(&self, what: &str) -> Result<T, FormatError> {
        self.parse(what, |text| text.parse().ok())
    }

    /// The integer in a field that must not be blank.
    pub(super) fn required<T: FromStr + Default>(&self, what: &str) -> Result<T, FormatError> {
        self.filled(what)?.integer(what)
    }

    /// The field, which must not be blank.
    pub(super) fn filled(&self, what: &str) -> Result<&Self, FormatError> {
        if self.is_blank() { Err(self.error(what)) } else { Ok(self) }
    }

    /// The finite real number; 0 for a blank field.
    pub(super) fn real(&self, what: &str) -> Result<f64, FormatError> {
        self.parse(what, |text| number::real(text.as_bytes()).filter(|value| value.is_finite()))
    }

    /// The field read by `read`, or what was expected and found at its place.
    fn parse<T: Default>(&self, what: &str, read: impl Fn(&str) -> Option<T>) -> Result<T, FormatError> {
        if self.is_blank() {
            return Ok(T::default());
        }
        read(self.text).ok_or_else(|| self.error(what))
    }

    /// The error that something else was expected in this field.
    pub(super) fn error(&self, what: &str) -> FormatError {
        let found = if self.is_blank() { "blanks".to_owned() } else { format!("{:?}", self.text) };
        FormatError::column(self.line, self.column, what, found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glued_integers_are_told_apart_by_their_columns() {
        let [a, b, c] = fields("12345678901234567890 -1", 3, [10, 10, 10]);
        assert_eq!(a.integer("a"), Ok(1_234_567_890_i64));
        assert_eq!(b.integer("b"), Ok(1_234_567_890_i64));
        assert_eq!(c.integer("c"), Ok(-1));
    }

    #[test]
    fn columns_are_characters_and_missing_ones_are_blank() {
        let [name, number, none] = fields("Δx²  17", 1, [4, 4, 5]);
        assert_eq!(name.text(), "Δx²");
        assert_eq!(number.integer("n"), Ok(17));
        assert_eq!(none.integer("n"), Ok(0));
        assert!(none.is_blank());
    }

    #[test]
    fn an_error_names_line_and_column() {
        let [_, b] = fields("    1  x 2", 9, [5, 5]);
        assert_eq!(b.integer::<i32>("an integer"), Err(FormatError::column(9, 6, "an integer", "\"x 2\"")));
        let [nan] = fields("NaN", 9, [13]);
        assert!(nan.real("a finite number").is_err());
    }

    #[test]
    fn words_must_fit_their_fields() {
        assert!(words("1 2 3", 1, [2, 2]).is_none());
        assert!(words("100 2", 1, [2, 2]).is_none());
        assert!(words("10", 1, [2, 2]).is_none());
        let [a, b] = words("10 -2", 1, [2, 2]).expect("two words");
        assert_eq!((a.integer("a"), b.integer("b")), (Ok(10), Ok(-2)));
    }
}
