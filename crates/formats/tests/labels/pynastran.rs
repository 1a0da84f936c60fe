//! pyNastran writes DMIG cards, and what it reads from them itself is what we read, to the last bit.

use crate::outside::python_with;
use frfit_formats::{CoordinateMatrix, DofLabel, Entries, Symmetry, dmig};
use std::collections::BTreeMap;
use std::process::Command;

/// Writes cards of small and large fields, real and complex, symmetric, square and rectangular; reads them back and lists
/// each matrix: name, then the label of the column, that of the row, real and imaginary part.
const SCRIPT: &str = r#"
import sys, numpy as np
from pyNastran.bdf.bdf import BDF
folder = sys.argv[1]
rng = np.random.default_rng(3)
labels = [(1, 1), (1, 2), (2, 1), (7, 6), (12, 0), (40000000, 3)]
def entries(places):
    value = lambda: float(rng.normal() * 10.0 ** rng.integers(-7, 8))
    cols, rows = [labels[j] for i, j in places], [labels[i] for i, j in places]
    return cols, rows, [value() for _ in places], [value() for _ in places]
n = len(labels)
lower = [(i, j) for j in range(n) for i in range(j, n) if (i * j) % 3 != 1]
full = [(i, j) for j in range(n) for i in range(n) if (i + 2 * j) % 3]
tall = [(i, j) for j in (1, 4) for i in range(n) if (i + j) % 2]
model = BDF(debug=False)
for name, form, tin, places in [
    ("KSMALL", 6, 1, lower), ("KLARGE", 6, 2, lower), ("MSQ", 1, 2, full),
    ("CSMALL", 6, 3, lower), ("CLARGE", 1, 4, full), ("RECT", 2, 2, tall),
]:
    cols, rows, re, im = entries(places)
    model.add_dmig(name, form, tin, 0, 0, n, cols, rows, re, im if tin > 2 else None)
model.write_bdf(folder + "/model.bdf", write_header=False)
again = BDF(debug=False)
again.read_bdf(folder + "/model.bdf", punch=True, xref=False)
for name, matrix in again.dmig.items():
    for k in range(len(matrix.GCi)):
        im = matrix.Complex[k] if matrix.tin > 2 else 0.0
        print(name, *matrix.GCj[k], *matrix.GCi[k], float(matrix.Real[k]).hex(), float(im).hex())
"#;

type Cells = BTreeMap<(DofLabel, DofLabel), [f64; 2]>;

#[test]
#[ignore = "needs Python with pyNastran"]
fn pynastran_and_we_read_the_same_needs_pynastran() {
    let python = python_with("pyNastran");
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(&python).args(["-c", SCRIPT]).arg(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut theirs = BTreeMap::<String, Cells>::new();
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let words: Vec<_> = line.split_whitespace().collect();
        let label =
            |k: usize| DofLabel { node: words[k].parse().unwrap(), component: words[k + 1].parse().unwrap() };
        let value = [hex(words[5]), hex(words[6])];
        theirs.entry(words[0].into()).or_default().insert((label(3), label(1)), value);
    }

    let all = dmig::read(&std::fs::read(folder.path().join("model.bdf")).unwrap()).unwrap();
    assert_eq!((all.len(), theirs.len()), (6, 6));
    for entry in &all {
        let matrix = entry.matrix.as_ref().unwrap();
        let columns = match entry.labels.columns.is_empty() {
            true => &entry.labels.rows,
            false => &entry.labels.columns,
        };
        let ours = cells(matrix, &entry.labels.rows, columns);
        // We keep the lower triangle of sorted rows: theirs is written so.
        assert_eq!(ours, theirs[&entry.name], "{}", entry.name);
        assert_eq!(
            matrix.symmetry == Symmetry::Symmetric,
            !["MSQ", "CLARGE", "RECT"].contains(&&*entry.name)
        );
    }
}

fn cells(matrix: &CoordinateMatrix, rows: &[DofLabel], columns: &[DofLabel]) -> Cells {
    let value = |k: usize| match &matrix.entries {
        Entries::Real(values) => [values[k], 0.0],
        Entries::Complex(values) => [values[k].re, values[k].im],
        Entries::Pattern => panic!("no values"),
    };
    (matrix.rows.iter().zip(&matrix.cols))
        .enumerate()
        .map(|(k, (&row, &col))| ((rows[row], columns[col]), value(k)))
        .collect()
}

/// A double in C's hexadecimal notation, as Python prints it: -0x1.8p+3.
fn hex(text: &str) -> f64 {
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (mantissa, exponent) = digits.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let bits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let shift = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    sign * bits as f64 * 2.0_f64.powi(shift)
}
