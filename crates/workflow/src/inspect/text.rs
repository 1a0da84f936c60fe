//! Aligned lines, numbers short enough to be read.

use crate::terminal::one_line;

/// Lines of a label and a value, which may be quoted of a file and cannot make lines of its own.
pub(super) fn aligned(lines: &[(&str, String)]) -> String {
    let width = lines.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    lines.iter().map(|(label, value)| format!("  {label:<width$}  {}\n", one_line(value))).collect()
}

/// A number and its noun: `1 node`, `2 nodes`.
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}
