//! Real numbers on text lines.

use crate::FormatError;

use super::lines::{Line, Lines, is_blank};
use super::number::real;

/// Reads at most `wanted` numbers from the lines; blank lines are stepped over. `widths` are those of the
/// fields on a line, over and over.
///
/// # Errors
///
/// A field is no number, or there is a further line after the last number wanted.
pub(super) fn numbers(lines: Lines<'_>, widths: &[usize], wanted: usize) -> Result<Vec<f64>, FormatError> {
    // A number takes at least one digit and a blank.
    let mut numbers = Vec::with_capacity(wanted.min(lines.rest().len() / 2 + 1));
    for line in lines.filter(|line| !line.is_blank()) {
        if numbers.len() == wanted {
            return Err(FormatError::line(
                line.number,
                format!("the end after {wanted} numbers"),
                "more data",
            ));
        }
        read_line(line, widths, wanted, &mut numbers)?;
    }
    Ok(numbers)
}

/// Appends the numbers of a line until `wanted` are there: word by word and, where a word is no number
/// (because two fields touch), by columns.
pub(super) fn read_line(
    line: Line<'_>,
    widths: &[usize],
    wanted: usize,
    numbers: &mut Vec<f64>,
) -> Result<(), FormatError> {
    let before = numbers.len();
    let words = line.bytes.split(|&byte| is_blank(byte)).filter(|word| !word.is_empty());
    for word in words.take(wanted.saturating_sub(before)) {
        match real(word) {
            Some(value) => numbers.push(value),
            None => {
                numbers.truncate(before);
                return read_columns(line, widths, wanted, numbers);
            }
        }
    }
    Ok(())
}

fn read_columns(
    line: Line<'_>,
    widths: &[usize],
    wanted: usize,
    numbers: &mut Vec<f64>,
) -> Result<(), FormatError> {
    let end = line.bytes.iter().rposition(|&byte| !is_blank(byte)).map_or(0, |last| last + 1);
    let text = &line.bytes[..end];
    let mut start = 0;
    for &width in widths.iter().cycle().take(wanted.saturating_sub(numbers.len())) {
        let Some(field) = text.get(start..end.min(start + width)).filter(|field| !field.is_empty()) else {
            break;
        };
        numbers.push(real(field.trim_ascii()).ok_or_else(|| {
            let found = String::from_utf8_lossy(field.trim_ascii()).into_owned();
            let expected = format!("a number in columns {}-{}", start + 1, start + width);
            FormatError::column(line.number, start + 1, expected, format!("{found:?}"))
        })?);
        start += width;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, widths: &[usize], wanted: usize) -> Result<Vec<f64>, FormatError> {
        numbers(Lines::new(text.as_bytes(), 14), widths, wanted)
    }

    #[test]
    fn fields_that_touch_are_told_apart_by_columns() {
        let text = "-1.00000E+100-2.00000E+100  3.00000E+00\n";
        assert_eq!(read(text, &[13], 6), Ok(vec![-1e100, -2e100, 3.0]));
        let text = "  1.00000E+00-2.000000000000E-100-3.000000000000E-100";
        assert_eq!(read(text, &[13, 20, 20], 6), Ok(vec![1.0, -2e-100, -3e-100]));
    }

    #[test]
    fn lines_need_not_be_full_and_may_be_padded() {
        assert_eq!(read("1 2\n\n3    \r\n", &[13], 3), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(read("1 2 3 0 0 0\n", &[13], 3), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(read("1 2\n", &[13], 3), Ok(vec![1.0, 2.0]));
    }

    #[test]
    fn a_line_too_many_and_a_word_are_errors() {
        assert_eq!(
            read("1 2\n3\n", &[13], 2),
            Err(FormatError::line(15, "the end after 2 numbers", "more data"))
        );
        let expected = FormatError::column(15, 14, "a number in columns 14-26", "\"x\"");
        assert_eq!(read("1 2\n            3            x\n", &[13], 9), Err(expected));
        assert!(read("1 2\n            3      \n  ****\n", &[13], 9).is_err());
    }

    #[test]
    fn a_promise_without_bytes_allocates_nothing() {
        assert_eq!(read("1 2\n", &[13], usize::MAX).map(|numbers| numbers.capacity() < 10), Ok(true));
    }
}
