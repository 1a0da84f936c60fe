//! Datasets 15 and 2411: nodes.

use crate::FormatError;

use super::columns::{Field, fixed_or_free};
use super::lines::{Line, Lines};

/// A node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Node {
    /// Node label.
    pub label: i64,
    /// Coordinate system in which the position is given (15: definition, 2411: export); 0: the global one.
    pub definition_system: i64,
    /// Coordinate system of its displacements.
    pub displacement_system: i64,
    /// Colour number.
    pub color: i64,
    /// Coordinates x, y, z in the length unit of the file.
    pub position: [f64; 3],
}

/// Dataset 15: FORMAT(4I10,1P3E13.5), a line a node.
pub(super) fn read_15(lines: Lines<'_>) -> Result<Vec<Node>, FormatError> {
    const WIDTHS: [usize; 7] = [10, 10, 10, 10, 13, 13, 13];
    let node = |line: Line<'_>| {
        fixed_or_free(
            &line.text(),
            line.number,
            WIDTHS,
            |[label, definition, displacement, color, x, y, z]| {
                node([label, definition, displacement, color], position([x, y, z])?)
            },
        )
    };
    lines.filter(|line| !line.is_blank()).map(node).collect()
}

/// Dataset 2411: FORMAT(4I10), then FORMAT(1P3D25.16), two lines a node.
pub(super) fn read_2411(lines: Lines<'_>) -> Result<Vec<Node>, FormatError> {
    let mut nodes = Vec::new();
    let mut lines = lines.filter(|line| !line.is_blank());
    while let Some(line) = lines.next() {
        let coordinates = lines.next().ok_or_else(|| {
            FormatError::line(line.number, "a line of coordinates after it", "the end of the dataset")
        })?;
        let position = fixed_or_free(&coordinates.text(), coordinates.number, [25, 25, 25], position)?;
        nodes.push(fixed_or_free(&line.text(), line.number, [10, 10, 10, 10], |labels| {
            node(labels, position)
        })?);
    }
    Ok(nodes)
}

fn node(
    [label, definition, displacement, color]: [Field<'_>; 4],
    position: [f64; 3],
) -> Result<Node, FormatError> {
    Ok(Node {
        label: label.required("a node label")?,
        definition_system: definition.required("a coordinate system")?,
        displacement_system: displacement.required("a coordinate system")?,
        color: color.required("a colour number")?,
        position,
    })
}

fn position([x, y, z]: [Field<'_>; 3]) -> Result<[f64; 3], FormatError> {
    const WHAT: &str = "a finite coordinate";
    Ok([x.filled(WHAT)?.real(WHAT)?, y.filled(WHAT)?.real(WHAT)?, z.filled(WHAT)?.real(WHAT)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Lines<'_> {
        Lines::new(text.as_bytes(), 3)
    }

    #[test]
    fn single_precision_with_touching_fields() {
        let text = "1234567890         1         2         8 -1.00000E+00-2.00000E-101  3.00000E+00\n\n";
        let node = Node {
            label: 1_234_567_890,
            definition_system: 1,
            displacement_system: 2,
            color: 8,
            position: [-1.0, -2e-101, 3.0],
        };
        assert_eq!(read_15(lines(text)), Ok(vec![node]));
    }

    #[test]
    fn double_precision_in_any_columns() {
        let text = "         7         0         1        11\r\n 1.5D+00 2.5d-01 3\r\n";
        let node = Node {
            label: 7,
            definition_system: 0,
            displacement_system: 1,
            color: 11,
            position: [1.5, 0.25, 3.0],
        };
        assert_eq!(read_2411(lines(text)), Ok(vec![node]));
    }

    #[test]
    fn a_node_without_coordinates_is_an_error() {
        assert!(read_2411(lines("         7         0         1        11\n")).is_err());
        assert!(read_15(lines("         x         0         1        11\n")).is_err());
    }
}
