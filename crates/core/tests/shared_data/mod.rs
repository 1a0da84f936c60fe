//! Real matrices, where there are any.

use crate::outside;

pub(crate) use outside::shared;

use frfit_formats::Entries;
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Values};
use std::path::Path;
use std::sync::Arc;

/// A real symmetric matrix, whatever the format of its file.
pub(crate) fn read_matrix(path: &Path) -> SymmetricMatrix {
    let matrix = frfit_formats::read_matrix(&std::fs::read(path).unwrap()).unwrap();
    let Entries::Real(entries) = matrix.entries else { panic!("{} is real", path.display()) };
    let pattern = Pattern::new(matrix.nrows, matrix.rows.iter().copied().zip(matrix.cols.iter().copied()));
    let mut values = vec![0.0; pattern.stored()];
    for ((&row, &col), entry) in matrix.rows.iter().zip(&matrix.cols).zip(entries) {
        values[pattern.find(row, col).unwrap()] = entry;
    }
    SymmetricMatrix::new(Arc::new(pattern), Values::Real(values))
}
