//! SciPy reads what we write, and we read what SciPy writes, to the last bit.

use std::path::Path;
use std::process::Command;

use crate::outside::python_with;
use frfit_formats::{CoordinateMatrix, Entries, Symmetry, harwell_boeing, matrix_market};
use num_complex::Complex64 as c64;

/// Reads what we wrote, checks it against the same matrix made here, and writes it back.
const SCRIPT: &str = r#"
import sys, numpy as np, scipy.io as io, scipy.sparse as sp
folder = sys.argv[1]
n = 9
k = np.arange(n)
x = np.ldexp(np.sqrt(k + 2.0), 37 * (k - 4)) * (-1.0) ** k
rows, cols = (k * 4) % n, (k * 7 + 3) % n
general = sp.coo_array((x, (rows, cols)), shape=(n, n)).toarray()
lower = np.tril(general, -1)
matrices = {
    "general": general,
    "symmetric": lower + lower.T + np.diag(np.diag(general)),
    "skew": lower - lower.T,
    "complex": general + 1j * general[::-1],
    "hermitian": (lower + 1j * lower[::-1] * (lower != 0)),
}
h = matrices["hermitian"]
matrices["hermitian"] = h + h.conj().T
for name, a in matrices.items():
    ours = io.mmread(f"{folder}/ours_{name}.mtx").toarray()
    assert ours.dtype == a.dtype and np.array_equal(ours, a), name
    symmetry = {"skew": "skew-symmetric", "complex": "general"}.get(name, name)
    io.mmwrite(f"{folder}/scipy_{name}.mtx", sp.coo_array(a), symmetry=symmetry)
    io.mmwrite(f"{folder}/scipy_array_{name}.mtx", a, symmetry=symmetry)
assert np.array_equal(io.hb_read(f"{folder}/ours.rua", spmatrix=False).toarray(), general)
io.hb_write(f"{folder}/scipy.rua", sp.csc_array(general))
# The digits that SciPy chose for the format of its file, as it reads them back itself.
np.savetxt(f"{folder}/hb.txt", io.hb_read(f"{folder}/scipy.rua", spmatrix=False).toarray(), fmt="%.17g")
print("checked", len(matrices))
"#;

#[test]
#[ignore = "needs Python with SciPy"]
fn scipy_and_we_read_each_other_needs_scipy() {
    let python = python_with("scipy");
    let folder = tempfile::tempdir().unwrap();
    let matrices = matrices();
    for (name, matrix) in &matrices {
        let path = folder.path().join(format!("ours_{name}.mtx"));
        std::fs::write(path, matrix_market::write(matrix).unwrap()).unwrap();
    }
    let general = &matrices[0].1;
    std::fs::write(folder.path().join("ours.rua"), harwell_boeing::write(general).unwrap()).unwrap();

    let output = Command::new(&python).args(["-c", SCRIPT]).arg(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "checked 5");

    for (name, matrix) in &matrices {
        for kind in ["scipy", "scipy_array"] {
            let bytes = std::fs::read(folder.path().join(format!("{kind}_{name}.mtx"))).unwrap();
            let read = matrix_market::read(&bytes).unwrap_or_else(|e| panic!("{kind} {name}: {e}"));
            assert_eq!(CoordinateMatrix { title: String::new(), ..read }, *matrix, "{kind} {name}");
        }
    }
    assert_same_as_text(folder.path());
}

/// Compares SciPy's Harwell–Boeing file with the table of what SciPy itself reads from it.
fn assert_same_as_text(folder: &Path) {
    let matrix = harwell_boeing::read(&std::fs::read(folder.join("scipy.rua")).unwrap()).unwrap();
    let Entries::Real(values) = &matrix.entries else { panic!("{matrix:?}") };
    let mut dense = vec![0.0; matrix.nrows * matrix.ncols];
    for ((row, col), value) in matrix.rows.iter().zip(&matrix.cols).zip(values) {
        dense[row * matrix.ncols + col] = *value;
    }
    let text = std::fs::read_to_string(folder.join("hb.txt")).unwrap();
    let theirs: Vec<f64> = text.split_whitespace().map(|x| x.parse().unwrap()).collect();
    assert_eq!(dense, theirs);
    assert_eq!(values.len(), 9);
}

/// The same matrices as in the script, exact by construction: √n, scaled by powers of two.
fn matrices() -> Vec<(&'static str, CoordinateMatrix)> {
    const N: usize = 9;
    let mut general = [[0.0_f64; N]; N];
    for k in 0..N {
        let size = (k as f64 + 2.0).sqrt() * 2.0_f64.powi(37 * (k as i32 - 4));
        general[(k * 4) % N][(k * 7 + 3) % N] = if k % 2 == 0 { size } else { -size };
    }
    let lower = |row: usize, col: usize| if row > col { general[row][col] } else { 0.0 };
    let real = |symmetry, value: &dyn Fn(usize, usize) -> f64| {
        sparse(symmetry, |row, col| c64::new(value(row, col), 0.0), false)
    };
    let below = |row: usize, col: usize| if row == col { general[row][col] } else { lower(row, col) };
    let hermitian = |row: usize, col: usize| match lower(row, col) {
        0.0 => c64::new(0.0, 0.0),
        re => c64::new(re, lower(N - 1 - row, col)),
    };
    vec![
        ("general", real(Symmetry::General, &|row, col| general[row][col])),
        ("symmetric", real(Symmetry::Symmetric, &below)),
        ("skew", real(Symmetry::SkewSymmetric, &lower)),
        (
            "complex",
            sparse(
                Symmetry::General,
                |row, col| c64::new(general[row][col], general[N - 1 - row][col]),
                true,
            ),
        ),
        ("hermitian", sparse(Symmetry::Hermitian, hermitian, true)),
    ]
}

/// The entries of a 9 by 9 matrix that are not zero.
fn sparse(symmetry: Symmetry, value: impl Fn(usize, usize) -> c64, is_complex: bool) -> CoordinateMatrix {
    let places: Vec<_> = (0..9)
        .flat_map(|col| (0..9).map(move |row| (row, col)))
        .map(|(row, col)| (row, col, value(row, col)))
        .filter(|place| place.2 != c64::new(0.0, 0.0))
        .collect();
    CoordinateMatrix {
        nrows: 9,
        ncols: 9,
        symmetry,
        rows: places.iter().map(|place| place.0).collect(),
        cols: places.iter().map(|place| place.1).collect(),
        entries: match is_complex {
            true => Entries::Complex(places.iter().map(|place| place.2).collect()),
            false => Entries::Real(places.iter().map(|place| place.2.re).collect()),
        },
        title: String::new(),
    }
}
