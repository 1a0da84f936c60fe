//! OUTPUT4 beside pyYeti and pyNastran.

use super::{compare, run, samples};
use crate::outside::python_with;
use frfit_formats::{CoordinateMatrix, Entries, FileKind, Symmetry, detect, matrix_market, op4};
use num_complex::Complex64 as c64;
use proptest::prelude::*;
use std::fs;

const MODULES: &str = "scipy, pyyeti.nastran.op4, pyNastran.op4.op4";

#[test]
#[ignore = "needs Python with SciPy, pyYeti, pyNastran"]
fn what_pyyeti_and_pynastran_write_is_read_needs_scipy_and_pyyeti_and_pynastran() {
    let python = python_with(MODULES);
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(run(&python, "op4.py", &[folder.path().to_str().unwrap()]), "written 22");
    assert_eq!(compare(folder.path(), ".op4"), (22, 100));
}

#[test]
fn samples_of_every_flavour_are_read() {
    assert_eq!(compare(&samples(), ".op4"), (10, 46));
}

fn real(symmetry: Symmetry, places: &[(usize, usize, f64)]) -> CoordinateMatrix {
    CoordinateMatrix {
        nrows: 4,
        ncols: 4,
        symmetry,
        rows: places.iter().map(|place| place.0).collect(),
        cols: places.iter().map(|place| place.1).collect(),
        entries: Entries::Real(places.iter().map(|place| place.2).collect()),
        title: String::new(),
    }
}

#[test]
#[ignore = "needs Python with SciPy, pyYeti, pyNastran"]
fn pyyeti_and_pynastran_read_ours_needs_scipy_and_pyyeti_and_pynastran() {
    let python = python_with(MODULES);
    let k = real(Symmetry::Symmetric, &[(0, 0, 2.0), (1, 0, -1.0 / 3.0), (3, 0, 1e-300), (2, 2, -7e12)]);
    let g = real(Symmetry::General, &[(0, 1, 0.1), (1, 1, 2.0), (3, 1, -3e200), (0, 3, 0.2)]);
    let Entries::Real(values) = &k.entries else { panic!("real above") };
    let values = values.iter().map(|x| c64::new(*x, -0.01 * x)).collect();
    let z = CoordinateMatrix { entries: Entries::Complex(values), ..k.clone() };
    let folder = tempfile::tempdir().unwrap();
    for (file, matrices) in
        [("ours_all", &[("K", &k), ("G", &g), ("Z", &z)][..]), ("ours_one", &[("kaa12345", &k)])]
    {
        fs::write(folder.path().join(format!("{file}.op4")), op4::write(matrices).unwrap()).unwrap();
        for (name, matrix) in matrices {
            let path = folder.path().join(format!("{file}.{}.mtx", name.to_uppercase()));
            fs::write(path, matrix_market::write(matrix).unwrap()).unwrap();
        }
    }
    assert_eq!(run(&python, "op4.py", &[folder.path().to_str().unwrap(), "ours"]), "read 4");
}

#[test]
fn what_cannot_be_written_is_refused() {
    let matrix = real(Symmetry::General, &[(0, 0, 1.0)]);
    let found = |name: &str, matrix: &CoordinateMatrix| op4::write(&[(name, matrix)]).unwrap_err().found;
    assert_eq!(found("K AA", &matrix), "\"K AA\"");
    assert_eq!(found("STIFFNESS", &matrix), "\"STIFFNESS\"");
    assert_eq!(found("K", &CoordinateMatrix { entries: Entries::Pattern, ..matrix.clone() }), "a pattern");
    assert_eq!(found("K", &CoordinateMatrix { nrows: 10_000_000, ..matrix }), "10000000 and 4");
}

/// Matrices of one symmetry, without zeros: the format does not store them.
fn matrix() -> impl Strategy<Value = CoordinateMatrix> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL};
    let number = || NORMAL | SUBNORMAL | POSITIVE | NEGATIVE;
    let places = proptest::collection::btree_map((0_usize..9, 0_usize..9), (number(), number()), 0..30);
    (any::<bool>(), any::<bool>(), places).prop_map(|(is_symmetric, is_complex, places)| {
        let places: Vec<_> =
            places.into_iter().filter(|((col, row), _)| !is_symmetric || row >= col).collect();
        CoordinateMatrix {
            nrows: 9,
            ncols: 9,
            symmetry: if is_symmetric { Symmetry::Symmetric } else { Symmetry::General },
            rows: places.iter().map(|((_, row), _)| *row).collect(),
            cols: places.iter().map(|((col, _), _)| *col).collect(),
            entries: match is_complex {
                true => Entries::Complex(places.iter().map(|(_, (re, im))| c64::new(*re, *im)).collect()),
                false => Entries::Real(places.iter().map(|(_, (re, _))| *re).collect()),
            },
            title: "KAA".into(),
        }
    })
}

proptest! {
    #[test]
    fn what_is_written_is_read_back_equal(first in matrix(), second in matrix()) {
        let written = op4::write(&[("KAA", &first), ("KAA", &second)]).unwrap();
        prop_assert_eq!(detect(&written), Some(FileKind::Op4));
        let read: Vec<_> = op4::read(&written).unwrap().into_iter().map(|one| one.matrix.unwrap()).collect();
        prop_assert_eq!(read, [first, second]);
    }
}
