//! What the tests of all elements ask of a structure.

use frfit_fem::{Assembled, Direction};
use frfit_linalg::sparse::SymmetricMatrix;

/// A x.
pub(crate) fn product(matrix: &SymmetricMatrix, x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for ((row, col), value) in matrix.pattern().positions().zip(matrix.real_values().unwrap()) {
        out[row] += value * x[col];
        if row != col {
            out[col] += value * x[row];
        }
    }
    out
}

/// xᵀ A y.
pub(crate) fn form(x: &[f64], matrix: &SymmetricMatrix, y: &[f64]) -> f64 {
    dot(x, &product(matrix, y))
}

pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// ‖A x‖ / (‖A‖ ‖x‖) in largest entries: zero up to roundoff for x in the null space.
pub(crate) fn relative_product(matrix: &SymmetricMatrix, x: &[f64]) -> f64 {
    largest(&product(matrix, x)) / (largest(matrix.real_values().unwrap()) * largest(x))
}

/// Values of a field at all rows.
pub(crate) fn field(of: &Assembled, value: impl Fn([f64; 3], Direction) -> f64) -> Vec<f64> {
    of.dofs.iter().map(|dof| value(of.nodes[dof.node - 1], dof.direction)).collect()
}

/// The unit translation along one direction.
pub(crate) fn translation(of: &Assembled, along: Direction) -> Vec<f64> {
    field(of, |_, direction| if direction == along { 1.0 } else { 0.0 })
}

/// The exponent p of error ~ hᵖ from the errors at h and h/2.
pub(crate) fn rate(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).abs().log2()
}

/// |vᵀ A u − exact| in units of Σ |v||A||u|, the size of what is added.
pub(crate) fn misfit<const N: usize>(matrix: &[[f64; N]; N], u: &[f64; N], v: &[f64; N], exact: f64) -> f64 {
    let (mut sum, mut size) = (-exact, 0.0);
    for (row, v) in matrix.iter().zip(v) {
        for (entry, u) in row.iter().zip(u) {
            sum += v * entry * u;
            size += (v * entry * u).abs();
        }
    }
    sum.abs() / size
}
