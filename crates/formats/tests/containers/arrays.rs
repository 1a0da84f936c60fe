//! NumPy, SciPy and MATLAB files beside SciPy.

use super::{compare, entries, run, samples};
use crate::outside::{python_with, shared};
use frfit_formats::{
    CoordinateMatrix, Entries, FileKind, NamedMatrix, Symmetry, choose_matrix, detect, mat, matrix_market,
    numpy, read_matrices, read_matrix,
};
use num_complex::Complex64 as c64;
use std::collections::BTreeMap;
use std::fs;

#[test]
#[ignore = "needs Python with SciPy"]
fn what_scipy_writes_is_read_needs_scipy() {
    let python = python_with("scipy");
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(run(&python, "arrays.py", &[folder.path().to_str().unwrap()]), "written 20 43 2");
    assert_eq!(compare(folder.path(), ".npy"), (20, 20));
    assert_eq!(compare(folder.path(), ".npz"), (43, 49));
    assert_eq!(compare(folder.path(), ".mat"), (2, 30));
}

#[test]
#[ignore = "needs Python with SciPy"]
fn scipy_reads_ours_needs_scipy() {
    let python = python_with("scipy");
    let folder = tempfile::tempdir().unwrap();
    let of = |symmetry, entries| CoordinateMatrix {
        nrows: 4,
        ncols: 4,
        symmetry,
        rows: vec![0, 1, 3, 2],
        cols: vec![0, 0, 0, 2],
        entries,
        title: String::new(),
    };
    let values = vec![2.0, -1.0 / 3.0, 1e-300, -7e12];
    let complex = values.iter().map(|&x| c64::new(x, -0.01 * x)).collect();
    let k = of(Symmetry::Symmetric, Entries::Real(values.clone()));
    let g = of(Symmetry::General, Entries::Real(values));
    let z = of(Symmetry::Symmetric, Entries::Complex(complex));
    let none = CoordinateMatrix { rows: vec![], cols: vec![], entries: Entries::Real(vec![]), ..g.clone() };
    let all = [("K", &k), ("G_2", &g), ("Z", &z), ("nothing", &none)];
    for (name, matrix) in all {
        let write =
            |ending: &str, bytes| fs::write(folder.path().join(format!("ours.{name}.{ending}")), bytes);
        write("mtx", matrix_market::write(matrix).unwrap()).unwrap();
        write("npz", numpy::write_sparse(matrix).unwrap()).unwrap();
    }
    fs::write(folder.path().join("ours.mat"), mat::write(&all).unwrap()).unwrap();
    assert_eq!(run(&python, "arrays.py", &[folder.path().to_str().unwrap(), "ours"]), "read 8");
}

/// A name that MATLAB does not take, and a matrix without values, are refused.
#[test]
fn what_cannot_be_written_is_refused() {
    let k = read_matrix(b"%%MatrixMarket matrix coordinate pattern general\n1 1 1\n1 1\n").unwrap();
    assert!(mat::write(&[("K", &k)]).unwrap_err().to_string().contains("a pattern"));
    assert!(numpy::write_sparse(&k).unwrap_err().to_string().contains("a pattern"));
    assert!(mat::write(&[("2K", &k)]).unwrap_err().to_string().contains("a name of a letter"));
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
    assert_eq!(entries(choose_matrix(&all, Some("M")).unwrap().matrix.as_ref().unwrap()).len(), 6);
}

/// SciPy writes no file of the other byte order: one by hand, with a name in a tag and values of 16 bits.
#[test]
fn a_matlab_file_with_the_highest_byte_first_is_read() {
    let words = |numbers: &[u32]| numbers.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
    let short = |text: &[u8]| {
        [words(&[(text.len() as u32) << 16 | 1]), text.to_vec(), vec![0; 4 - text.len()]].concat()
    };
    let values = |numbers: [i16; 4]| [words(&[3, 8]), numbers.map(i16::to_be_bytes).concat()].concat();
    let matrix = |body: Vec<u8>| [words(&[14, body.len() as u32]), body].concat();
    let head = |flags: u32, name: &[u8]| [words(&[6, 8, flags, 0, 5, 8, 2, 2]), short(name)].concat();
    let full = [head(6 | 0x800, b"Z"), values([1, 0, -2, 300]), values([0, 0, 5, -1])].concat();
    let pointers = words(&[5, 12, 0, 1, 2, 0]);
    let sparse = [head(5, b"KAA"), words(&[5, 8, 1, 0]), pointers, values([7, -8, 0, 0])].concat();
    let mut header = vec![b' '; 124];
    header.extend(b"\x01\x00MI");
    let all = read_matrices(&[header, matrix(full), matrix(sparse)].concat()).unwrap();
    let found: Vec<_> =
        all.iter().map(|one| (one.name.as_str(), entries(one.matrix.as_ref().unwrap()))).collect();
    let z = [((0, 0), c64::new(1.0, 0.0)), ((0, 1), c64::new(-2.0, 5.0)), ((1, 1), c64::new(300.0, -1.0))];
    let k = [((1, 0), c64::new(7.0, 0.0)), ((0, 1), c64::new(-8.0, 0.0))];
    assert_eq!(found, [("Z", BTreeMap::from(z)), ("KAA", BTreeMap::from(k))]);
}

/// A beam of 168 degrees of freedom, as saved by MATLAB.
#[test]
#[ignore = "needs the data of ../shared/data"]
fn a_real_file_of_matlab_is_read_needs_data() {
    let path = shared("sandwich/sandwich_beam_168.mat");
    let sizes = |one: &NamedMatrix| {
        let matrix = one.matrix.as_ref().unwrap();
        (one.name.clone(), matrix.nrows, matrix.ncols, matrix.rows.len())
    };
    let all: Vec<_> = read_matrices(&fs::read(&path).unwrap()).unwrap().iter().map(sizes).collect();
    let expected = [("M", 1158), ("Ke", 1240), ("Kv", 1199)];
    assert_eq!(all, expected.map(|(name, entries)| (name.to_owned(), 168, 168, entries)));
}

#[test]
#[ignore = "needs the data of ../shared/data and Python with SciPy"]
fn scipy_reads_the_same_from_a_real_file_of_matlab_needs_data_and_scipy() {
    let (path, python) = (shared("sandwich/sandwich_beam_168.mat"), python_with("scipy"));
    let folder = tempfile::tempdir().unwrap();
    let arguments = [folder.path().to_str().unwrap(), path.to_str().unwrap()];
    assert_eq!(run(&python, "arrays.py", &arguments), "written 0 0 1");
    assert_eq!(compare(folder.path(), ".mat"), (1, 3));
}
