//! Matrices as Matrix Market or Harwell–Boeing.

use crate::Error;
use frfit::model::{Role, Term};
use frfit_formats::{CoordinateMatrix, Entries, Symmetry, harwell_boeing, matrix_market};

/// One term's matrix in the format of the path's ending: `.rsa` is Harwell–Boeing, anything else Matrix Market.
///
/// # Errors
/// Where the format cannot hold it.
pub fn matrix(term: &Term, path: &str) -> Result<Vec<u8>, Error> {
    let write = if path.ends_with(".rsa") { harwell_boeing::write } else { matrix_market::write };
    Ok(write(&coordinates(term))?)
}

/// The entries that are not zero: a model holds all its terms on one pattern, which is larger than each of theirs.
fn coordinates(term: &Term) -> CoordinateMatrix {
    let dim = term.matrix.dim();
    // The elements are real, their factors are not: nothing is lost here.
    let values = term.matrix.real_values().unwrap_or_default();
    let entries = term.matrix.pattern().positions().zip(values).filter(|(_, value)| **value != 0.0);
    let (positions, values): (Vec<_>, Vec<f64>) = entries.unzip();
    let (rows, cols) = positions.into_iter().unzip();
    let (symmetry, entries) = (Symmetry::Symmetric, Entries::Real(values));
    CoordinateMatrix { nrows: dim, ncols: dim, symmetry, rows, cols, entries, title: title(term) }
}

fn title(term: &Term) -> String {
    let of = match term.role {
        Role::Stiffness => "stiffness",
        Role::Viscous => "viscous damping",
        Role::Mass => "mass",
    };
    format!("{}: {of} for a factor of 1 in SI units", term.name)
}
