//! NumPy, SciPy and MATLAB files beside SciPy.

use crate::outside::{python_with, shared};
use crate::{compare, entries, run, samples};
use frfit_formats::{FileKind, NamedMatrix, choose_matrix, detect, read_matrices, read_matrix};
use std::fs;

#[test]
fn what_scipy_writes_is_read() {
    let Some(python) = python_with("scipy") else { return };
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(run(&python, "arrays.py", &[folder.path().to_str().unwrap()]), "written 20 43 2");
    assert_eq!(compare(folder.path(), ".npy"), (20, 20));
    assert_eq!(compare(folder.path(), ".npz"), (43, 49));
    assert_eq!(compare(folder.path(), ".mat"), (2, 30));
}

#[test]
fn samples_of_every_kind_are_read() {
    assert_eq!(compare(&samples(), ".npy"), (3, 3));
    assert_eq!(compare(&samples(), ".npz"), (8, 14));
    assert_eq!(compare(&samples(), ".mat"), (2, 30));
}

#[test]
fn each_kind_is_known_by_its_content() {
    for (file, kind) in [
        ("dense3F.npy", FileKind::Numpy),
        ("savez_compressed.npz", FileKind::Numpy),
        ("matlab.mat", FileKind::Mat),
        ("yeti_dense_big.op4", FileKind::Op4),
        ("yeti_bigmat_text.op4", FileKind::Op4),
    ] {
        let bytes = fs::read(samples().join(file)).unwrap();
        assert_eq!(detect(&bytes), Some(kind), "{file}");
        assert!(kind.holds_matrices());
    }
}

#[test]
fn a_file_of_several_needs_a_name() {
    let bytes = fs::read(samples().join("savez_compressed.npz")).unwrap();
    let error = read_matrix(&bytes).unwrap_err().to_string();
    assert!(error.ends_with("found K (6 x 6), M (6 x 6), W (4 x 6), Z (4 x 6)"), "{error}");
    let all = read_matrices(&bytes).unwrap();
    assert_eq!(entries(choose_matrix(&all, Some("M")).unwrap()).len(), 6);
}

/// A beam of 168 degrees of freedom, as saved by MATLAB: the same numbers as SciPy reads.
#[test]
fn a_real_file_of_matlab_is_read() {
    let Some(path) = shared("sandwich/sandwich_beam_168.mat") else { return };
    let sizes = |one: &NamedMatrix| {
        let matrix = one.matrix.as_ref().unwrap();
        (one.name.clone(), matrix.nrows, matrix.ncols, matrix.rows.len())
    };
    let all: Vec<_> = read_matrices(&fs::read(&path).unwrap()).unwrap().iter().map(sizes).collect();
    let expected = [("M", 1158), ("Ke", 1240), ("Kv", 1199)];
    assert_eq!(all, expected.map(|(name, entries)| (name.to_owned(), 168, 168, entries)));

    let Some(python) = python_with("scipy") else { return };
    let folder = tempfile::tempdir().unwrap();
    let arguments = [folder.path().to_str().unwrap(), path.to_str().unwrap()];
    assert_eq!(run(&python, "arrays.py", &arguments), "written 0 0 1");
    assert_eq!(compare(folder.path(), ".mat"), (1, 3));
}
