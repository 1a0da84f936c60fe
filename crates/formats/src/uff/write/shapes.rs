//! Dataset 55: complex mode shapes at nodes.

use super::DELIMITER;
use super::fixed::{integer, real, text};
use crate::FormatError;
use num_complex::Complex;

/// A complex mode: eigenvalue and displacements at nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModeShape {
    /// Five lines of text, each of at most 80 characters.
    pub id: [String; 5],
    /// Number of the mode, from 1.
    pub number: i64,
    /// Its pole s, 1/s.
    pub eigenvalue: Complex<f64>,
    /// Modal A, which makes residues of products of the displacements: R = ψψ/a.
    pub modal_a: Complex<f64>,
    /// Label of each node, and its displacements x, y, z and rotations about them.
    pub nodes: Vec<(i64, [Complex<f64>; 6])>,
}

/// A mode as dataset 55: complex eigenvector of first order, displacements in six directions.
///
/// # Errors
/// A line of text that is too long, or a label of more than ten characters.
pub fn mode_shape(mode: &ModeShape) -> Result<Vec<u8>, FormatError> {
    let mut body = String::new();
    for line in &mode.id {
        body += text(line, 80, "a line of text")?.trim_end();
        body.push('\n');
    }
    let numbers = |values: &[i64]| -> Result<String, FormatError> {
        values.iter().map(|&value| integer(value, 10, "a number of a mode")).collect()
    };
    let reals = |values: &[f64]| values.iter().map(|&value| real(value, 13, 5)).collect::<String>() + "\n";
    let parts = |values: &[Complex<f64>]| values.iter().flat_map(|z| [z.re, z.im]).collect::<Vec<_>>();
    // Structure, complex modes of first order, six directions, displacement, complex, six values a node.
    body += &(numbers(&[1, 3, 3, 8, 5, 6])? + "\n");
    body += &(numbers(&[2, 6, 0, mode.number])? + "\n");
    body += &reals(&parts(&[mode.eigenvalue, mode.modal_a, mode.modal_a * -mode.eigenvalue]));
    for (label, displacements) in &mode.nodes {
        body += &(numbers(&[*label])? + "\n");
        body += &parts(displacements).chunks(6).map(reals).collect::<String>();
    }
    Ok(format!("{DELIMITER}{:6}\n{body}{DELIMITER}", 55).into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_of_the_format() {
        let mut displacements = [Complex::default(); 6];
        displacements[2] = Complex::new(1.5, -0.25);
        let mode = ModeShape {
            id: ["plate".into(), String::new(), String::new(), String::new(), String::new()],
            number: 3,
            eigenvalue: Complex::new(-1.0, 200.0),
            modal_a: Complex::new(0.0, 400.0),
            nodes: vec![(17, displacements)],
        };
        let text = String::from_utf8(mode_shape(&mode).unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..4], ["    -1", "    55", "plate", "NONE"]);
        assert_eq!(lines[7], "         1         3         3         8         5         6");
        assert_eq!(lines[8], "         2         6         0         3");
        assert_eq!(
            lines[9],
            " -1.00000E+00  2.00000E+02  0.00000E+00  4.00000E+02  8.00000E+04  4.00000E+02"
        );
        assert_eq!(lines[10], "        17");
        assert_eq!(
            lines[11],
            "  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  1.50000E+00 -2.50000E-01"
        );
        assert_eq!((lines.len(), lines[13]), (14, "    -1"));
        let long = ModeShape { nodes: vec![(100_000_000_000, displacements)], ..mode };
        assert!(mode_shape(&long).is_err());
    }
}
