//! Aligned lines, numbers short enough to be read.

use crate::terminal::one_line;

/// Lines of a label and a value, which may be quoted of a file and cannot make lines of its own.
pub(super) fn aligned(lines: &[(&str, String)]) -> String {
    let width = lines.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    lines.iter().map(|(label, value)| format!("  {label:<width$}  {}\n", one_line(value))).collect()
}

/// Six significant digits.
pub(super) fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if size == 0.0 || (1e-3..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// A number and its noun: `1 node`, `2 nodes`.
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_size() {
        assert_eq!(short(0.0), "0");
        assert_eq!(short(6399.9), "6399.9");
        assert_eq!(short(-1.0 / 3.0), "-0.333333");
        assert_eq!(short(39_411_962.742_7), "3.9412e7");
        assert_eq!(short(4.12e-9), "4.12e-9");
        assert_eq!(short(f64::INFINITY), "inf");
    }
}
