//! Datasets 15 and 2411.

use crate::FormatError;
use crate::uff::nodes::Node;

use super::DELIMITER;
use super::fixed::{integer, real};

/// Nodes as dataset 15: coordinates with 6 significant digits.
///
/// # Errors
///
/// A label, a coordinate system or a colour has more than ten characters, or a coordinate is not finite.
pub fn nodes_15(nodes: &[Node]) -> Result<Vec<u8>, FormatError> {
    let line = |node: &Node| Ok(labels(node)? + &coordinates(node, 13, 5)? + "\n");
    dataset(15, nodes, line)
}

/// Nodes as dataset 2411: coordinates with 17 significant digits, which is all they have.
///
/// # Errors
///
/// As [`nodes_15`].
pub fn nodes_2411(nodes: &[Node]) -> Result<Vec<u8>, FormatError> {
    let lines = |node: &Node| Ok(labels(node)? + "\n" + &coordinates(node, 25, 16)?.replace('E', "D") + "\n");
    dataset(2411, nodes, lines)
}

fn dataset(
    number: u32,
    nodes: &[Node],
    lines: impl Fn(&Node) -> Result<String, FormatError>,
) -> Result<Vec<u8>, FormatError> {
    let body: String = nodes.iter().map(lines).collect::<Result<_, _>>()?;
    Ok(format!("{DELIMITER}{number:6}\n{body}{DELIMITER}").into_bytes())
}

/// FORMAT(4I10).
fn labels(node: &Node) -> Result<String, FormatError> {
    let numbers = [node.label, node.definition_system, node.displacement_system, node.color];
    numbers.iter().map(|&number| integer(number, 10, "a number of a node")).collect()
}

fn coordinates(node: &Node, width: usize, decimals: usize) -> Result<String, FormatError> {
    match node.position.iter().find(|coordinate| !coordinate.is_finite()) {
        Some(coordinate) => Err(FormatError::whole("finite coordinates", coordinate.to_string())),
        None => Ok(node.position.map(|coordinate| real(coordinate, width, decimals)).concat()),
    }
}
