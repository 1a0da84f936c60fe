//! MXTYPE: what the three letters of line 3 say.

use crate::text::{Line, quoted};
use crate::{FormatError, Symmetry};

/// The first letter of the matrix type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ValueType {
    Real,
    Complex,
    Pattern,
}

/// MXTYPE, the three letters at the beginning of line 3.
pub(super) fn matrix_type(line: Line<'_>) -> Result<(ValueType, Symmetry), FormatError> {
    let letters = line.bytes[..line.bytes.len().min(3)].to_ascii_uppercase();
    let error = |at: usize, expected: &str| Err(line.error(at, expected, quoted(&letters)));
    let &[value, symmetry, assembled] = letters.as_slice() else {
        return error(0, "a matrix type of three letters, such as RSA");
    };
    let value = match value {
        b'R' | b'I' => ValueType::Real,
        b'C' => ValueType::Complex,
        b'P' => ValueType::Pattern,
        _ => return error(0, "a matrix type that begins with R, C, P or I, such as RSA"),
    };
    let symmetry = match symmetry {
        b'U' | b'R' => Symmetry::General,
        b'S' => Symmetry::Symmetric,
        b'H' => Symmetry::Hermitian,
        b'Z' => Symmetry::SkewSymmetric,
        _ => return error(1, "a matrix type with S, U, H, Z or R in the middle, such as RSA"),
    };
    match assembled {
        b'A' => Ok((value, symmetry)),
        b'E' => error(2, "an assembled matrix, such as RSA (elemental ones are not read: assemble it first)"),
        _ => error(2, "a matrix type that ends with A, such as RSA"),
    }
}
