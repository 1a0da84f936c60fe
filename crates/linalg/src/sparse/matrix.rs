//! Values on a pattern, and their products with vectors.

use super::triplets::assemble_complex;
use super::{Pattern, side_by_side};
use crate::{Scalar, c64};
use std::sync::Arc;

/// The numbers of a matrix, one for each position of its pattern.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real, as most stiffness, mass and viscous matrices are.
    Real(Vec<f64>),
    /// Complex, as a stiffness with its own hysteretic damping is.
    Complex(Vec<c64>),
}

/// One of the two real matrices of a complex one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Real part.
    Re,
    /// Imaginary part; zero for a real matrix.
    Im,
}

/// A symmetric matrix Aᵀ = A: a pattern, shared with others, and its values, shared with its clones.
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricMatrix {
    pattern: Arc<Pattern>,
    values: Arc<Values>,
}

impl SymmetricMatrix {
    /// Values on a pattern.
    ///
    /// # Panics
    /// Where the counts differ.
    pub fn new(pattern: Arc<Pattern>, values: Values) -> Self {
        let count = match &values {
            Values::Real(values) => values.len(),
            Values::Complex(values) => values.len(),
        };
        assert_eq!(count, pattern.stored(), "one value for each position");
        Self { pattern, values: Arc::new(values) }
    }

    /// From distinct or repeated complex triplets of the lower triangle; repeated ones add up.
    ///
    /// # Panics
    /// Where a position is outside n × n.
    pub fn from_complex_triplets(dim: usize, rows: &[usize], cols: &[usize], entries: &[c64]) -> Self {
        assemble_complex(dim, rows, cols, entries)
    }

    /// Number of rows and columns n.
    pub fn dim(&self) -> usize {
        self.pattern.dim()
    }

    /// Where the entries are.
    pub fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// The entries, in the order of the pattern.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The entries as real numbers; `None` if they are complex.
    pub fn real_values(&self) -> Option<&[f64]> {
        match &*self.values {
            Values::Real(values) => Some(values),
            Values::Complex(_) => None,
        }
    }

    /// The entry at (row, col), zero outside the pattern.
    pub fn get(&self, row: usize, col: usize) -> c64 {
        self.pattern.find(row, col).map_or(c64::default(), |k| match &*self.values {
            Values::Real(values) => c64::new(values[k], 0.0),
            Values::Complex(values) => values[k],
        })
    }

    /// The same matrix on a pattern that contains its own (zeros where it has nothing).
    ///
    /// # Panics
    /// Where a position of this matrix is missing in `pattern`.
    #[must_use]
    pub fn on_pattern(&self, pattern: &Arc<Pattern>) -> Self {
        if Arc::ptr_eq(&self.pattern, pattern) || &self.pattern == pattern {
            return Self { pattern: Arc::clone(pattern), values: Arc::clone(&self.values) };
        }
        let values = match &*self.values {
            Values::Real(values) => Values::Real(spread(&self.pattern, values, pattern)),
            Values::Complex(values) => Values::Complex(spread(&self.pattern, values, pattern)),
        };
        Self { pattern: Arc::clone(pattern), values: Arc::new(values) }
    }

    /// out += factor · A x.
    ///
    /// # Panics
    /// Where a length is not n.
    pub fn multiply_add(&self, factor: c64, x: &[c64], out: &mut [c64]) {
        match &*self.values {
            Values::Real(values) => accumulate(&self.pattern, values, x, out, |a, b| factor * b * a),
            Values::Complex(values) => accumulate(&self.pattern, values, x, out, |a, b| factor * a * b),
        }
    }

    /// Whether there is an imaginary part in the values' type.
    pub fn is_complex(&self) -> bool {
        matches!(*self.values, Values::Complex(_))
    }

    /// out += Re A X or Im A X, for real vectors, n × k column after column.
    ///
    /// # Panics
    /// Where lengths differ, or are not whole vectors.
    pub fn multiply_add_real(&self, part: Part, x: &[f64], out: &mut [f64]) {
        let pattern = &self.pattern;
        match (&*self.values, part) {
            (Values::Real(values), Part::Re) => side_by_side::multiply_add(pattern, values, |a| a, x, out),
            (Values::Real(_), Part::Im) => {}
            (Values::Complex(values), Part::Re) => {
                side_by_side::multiply_add(pattern, values, |a| a.re, x, out);
            }
            (Values::Complex(values), Part::Im) => {
                side_by_side::multiply_add(pattern, values, |a| a.im, x, out);
            }
        }
    }

    /// into += factor · Re (entries of A), in the order of the pattern.
    ///
    /// # Panics
    /// Where `into` has another length than the pattern.
    pub fn accumulate_real_into(&self, factor: f64, into: &mut [f64]) {
        assert_eq!(into.len(), self.pattern.stored());
        match &*self.values {
            Values::Real(values) => into.iter_mut().zip(values).for_each(|(sum, a)| *sum += factor * a),
            Values::Complex(values) => into.iter_mut().zip(values).for_each(|(sum, a)| *sum += factor * a.re),
        }
    }

    /// into += factor · (entries of A), in the order of the pattern.
    ///
    /// # Panics
    /// Where `into` has another length than the pattern.
    pub fn accumulate_into(&self, factor: c64, into: &mut [c64]) {
        assert_eq!(into.len(), self.pattern.stored());
        match &*self.values {
            Values::Real(values) => into.iter_mut().zip(values).for_each(|(sum, a)| *sum += factor * a),
            Values::Complex(values) => into.iter_mut().zip(values).for_each(|(sum, a)| *sum += factor * a),
        }
    }
}

fn spread<T: Scalar>(from: &Pattern, values: &[T], onto: &Pattern) -> Vec<T> {
    let mut spread = vec![T::default(); onto.stored()];
    for ((row, col), &value) in from.positions().zip(values) {
        let k = onto.find(row, col).expect("the pattern to spread onto contains this one");
        spread[k] = value;
    }
    spread
}

/// out += A x, the product of an entry and a number as given.
pub(crate) fn accumulate<A: Copy, X: Scalar>(
    pattern: &Pattern,
    values: &[A],
    x: &[X],
    out: &mut [X],
    product: impl Fn(A, X) -> X,
) {
    assert!(x.len() == pattern.dim() && out.len() == pattern.dim());
    let (col_ptr, row_idx) = (pattern.col_ptr(), pattern.row_idx());
    for col in 0..pattern.dim() {
        let mut here = X::default();
        let range = col_ptr[col]..col_ptr[col + 1];
        for (&row, &a) in row_idx[range.clone()].iter().zip(&values[range]) {
            if row == col {
                here += product(a, x[col]);
            } else {
                out[row] += product(a, x[col]);
                here += product(a, x[row]);
            }
        }
        out[col] += here;
    }
}
