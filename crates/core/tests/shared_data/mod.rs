//! Real matrices, where there are any.

use frfit_formats::Entries;
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Values};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder of the data for tests; `None` and a word where there is none.
#[expect(clippy::print_stderr, reason = "a skipped test says so")]
pub(crate) fn shared(name: &str) -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");
    let folder = std::env::var_os("FRFIT_DATA").map_or_else(|| beside.into(), PathBuf::from).join(name);
    if !folder.is_dir() {
        eprintln!("skipped: {name} is not at FRFIT_DATA or ../shared/data");
        return None;
    }
    Some(folder)
}

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
