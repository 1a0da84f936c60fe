//! Files of several matrices: those that other programs write are read to the same numbers, and the other way round.

mod arrays;
mod broken;
mod op4;

use frfit_formats::{CoordinateMatrix, Entries, NamedMatrix, Symmetry, matrix_market, read_matrices};
use num_complex::Complex64 as c64;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Small files that the scripts beside this one have written.
fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/containers/samples")
}

/// Runs a script of this folder and returns the last line that it prints.
fn run(python: &str, script: &str, arguments: &[&str]) -> String {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/containers").join(script);
    let output = Command::new(python).arg(script).args(arguments).output().expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_owned()
}

/// Every entry that is not zero, of both triangles.
fn entries(matrix: &CoordinateMatrix) -> BTreeMap<(usize, usize), c64> {
    let value = |k: usize| match &matrix.entries {
        Entries::Pattern => c64::new(1.0, 0.0),
        Entries::Real(values) => c64::new(values[k], 0.0),
        Entries::Complex(values) => values[k],
    };
    let mut all = BTreeMap::new();
    for (k, (&row, &col)) in matrix.rows.iter().zip(&matrix.cols).enumerate() {
        all.insert((row, col), value(k));
        if matrix.symmetry == Symmetry::Symmetric {
            all.insert((col, row), value(k));
        }
    }
    all.retain(|_, value| *value != c64::default());
    all
}

/// Reads every file of a folder with an ending and compares it with the Matrix Market files `FILE.MATRIX.mtx` beside
/// it: the same names, sizes and numbers. Returns how many files and how many matrices that were.
fn compare(folder: &Path, ending: &str) -> (usize, usize) {
    let names =
        || fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut counts = (0, 0);
    for name in names().filter(|name| name.ends_with(ending)) {
        let stem = name.strip_suffix(ending).unwrap();
        let prefix = format!("{stem}.");
        let expected: BTreeSet<_> = names()
            .filter_map(|other| other.strip_prefix(&prefix)?.strip_suffix(".mtx").map(str::to_owned))
            .collect();
        let read =
            read_matrices(&fs::read(folder.join(&name)).unwrap()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let found: BTreeSet<_> = read.iter().map(|one| one.name.clone()).collect();
        assert_eq!(found, expected, "{name}");
        for NamedMatrix { name: matrix_name, matrix, .. } in &read {
            let matrix = matrix.as_ref().unwrap_or_else(|e| panic!("{name} {matrix_name}: {e}"));
            matrix.validate().unwrap();
            let path = folder.join(format!("{stem}.{matrix_name}.mtx"));
            let theirs = matrix_market::read(&fs::read(path).unwrap()).unwrap();
            assert_eq!((matrix.nrows, matrix.ncols), (theirs.nrows, theirs.ncols), "{name} {matrix_name}");
            assert_eq!(entries(matrix), entries(&theirs), "{name} {matrix_name}");
            counts.1 += 1;
        }
        counts.0 += 1;
    }
    counts
}
