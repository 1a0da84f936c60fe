//! Dataset 82: a line drawn through nodes.

use crate::FormatError;

use super::columns::{fields, fixed_or_free};
use super::lines::{Line, Lines};

/// A trace line: the nodes that a plot of the structure connects.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TraceLine {
    /// Trace line number.
    pub number: i64,
    /// Colour number.
    pub color: i64,
    /// Name (80 characters); empty where the file says `NONE` or nothing.
    pub name: String,
    /// Labels of the nodes; 0: move to the next one without drawing.
    pub nodes: Vec<i64>,
}

/// FORMAT(3I10), FORMAT(80A1), then FORMAT(8I10) with as many nodes as the first record says; what fills up the
/// last line is dropped.
pub(super) fn read(mut lines: Lines<'_>) -> Result<TraceLine, FormatError> {
    let (number, count, color) = first_record(&mut lines)?;
    let name = lines.next().map(|line| {
        let text = line.text();
        let [name] = fields(&text, line.number, [80]);
        name.text()
    });
    // A label takes at least one digit and a blank.
    let mut nodes: Vec<i64> = Vec::with_capacity(count.min(lines.rest().len() / 2 + 1));
    for line in lines.by_ref() {
        labels(line, count, &mut nodes)?;
    }
    if nodes.len() < count {
        let found = format!("{} and the end of the dataset", nodes.len());
        return Err(FormatError::line(lines.next_number(), format!("{count} nodes"), found));
    }
    Ok(TraceLine { number, color, name: name.unwrap_or_default(), nodes })
}

fn first_record(lines: &mut Lines<'_>) -> Result<(i64, usize, i64), FormatError> {
    const WHAT: &str = "trace line number, number of nodes, colour";
    let line = lines.next();
    let line = line.ok_or_else(|| FormatError::line(lines.next_number(), WHAT, "the end of the dataset"))?;
    fixed_or_free(&line.text(), line.number, [10, 10, 10], |[number, count, color]| {
        Ok((
            number.required("a trace line number")?,
            count.required("a number of nodes")?,
            color.integer("a colour number")?,
        ))
    })
}

/// Appends the labels on a line until `count` are there: by columns, and where they hold something else, word
/// by word.
fn labels(line: Line<'_>, count: usize, nodes: &mut Vec<i64>) -> Result<(), FormatError> {
    const WIDTH: usize = 10;
    let wanted = count - nodes.len();
    let text = line.text();
    let filled = text.trim_end();
    let fixed =
        (0..filled.len()).step_by(WIDTH).map(|start| filled.get(start..filled.len().min(start + WIDTH)));
    append(fixed.map(|field| field.unwrap_or_default().trim()).take(wanted), nodes)
        .or_else(|| append(filled.split_whitespace().take(wanted), nodes))
        .ok_or_else(|| FormatError::line(line.number, "node labels", format!("{filled:?}")))
}

/// Appends all of these integers, or none where one of them cannot be read.
fn append<'a>(words: impl Iterator<Item = &'a str>, to: &mut Vec<i64>) -> Option<()> {
    let before = to.len();
    for word in words {
        match word.parse() {
            Ok(label) => to.push(label),
            Err(_) => {
                to.truncate(before);
                return None;
            }
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<TraceLine, FormatError> {
        read(Lines::new(text.as_bytes(), 3))
    }

    #[test]
    fn filling_after_the_last_node_is_dropped() {
        let text =
            "         3         4         8\nDalle\n        34        33         0        36         0\n";
        let expected = TraceLine { number: 3, color: 8, name: "Dalle".into(), nodes: vec![34, 33, 0, 36] };
        assert_eq!(read_text(text), Ok(expected));
    }

    #[test]
    fn labels_that_touch_and_labels_off_their_columns() {
        let text = "         1         2         8\nNONE\n12345678901234567890\n";
        assert_eq!(read_text(text).map(|line| line.nodes), Ok(vec![1_234_567_890, 1_234_567_890]));
        assert_eq!(read_text("1 3 8\n\n1 2\n3\n").map(|line| line.nodes), Ok(vec![1, 2, 3]));
    }

    #[test]
    fn fewer_nodes_than_promised_is_an_error() {
        assert!(read_text("         1         3         8\nNONE\n         1\n").is_err());
        assert!(read_text("         1         1         8\nNONE\n         x\n").is_err());
        assert!(read_text("         1 999999999         8\nNONE\n         1\n").is_err());
        assert!(read_text("").is_err());
    }
}
