//! Matrices of the Harwell–Boeing collection, in both formats.

use crate::outside::shared;
use frfit_formats::{CoordinateMatrix, Entries, FileKind, Symmetry, detect, harwell_boeing, matrix_market};

fn values(matrix: &CoordinateMatrix) -> &[f64] {
    match &matrix.entries {
        Entries::Real(values) => values,
        other => panic!("expected real values, found {other:?}"),
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn all_files_are_read_and_written_and_read_back_equal_needs_data() {
    for folder in ["hb", "plate"].map(shared) {
        let mut read = 0;
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let bytes = std::fs::read(&path).unwrap();
            let kind = if path.extension().unwrap() == "mtx" {
                FileKind::MatrixMarket
            } else {
                FileKind::HarwellBoeing
            };
            assert_eq!(detect(&bytes), Some(kind), "{}", path.display());
            let matrix =
                frfit_formats::read_matrix(&bytes).unwrap_or_else(|e| panic!("{}", e.in_file(&path)));
            assert_eq!(matrix.symmetry, Symmetry::Symmetric);
            assert!(!matrix.rows.is_empty() && !matrix.title.is_empty());
            assert_eq!(matrix_market::read(&matrix_market::write(&matrix).unwrap()).unwrap(), matrix);
            let mut again = harwell_boeing::read(&harwell_boeing::write(&matrix).unwrap()).unwrap();
            again.title.clone_from(&matrix.title); // longer than 72 characters
            assert_eq!(again, matrix);
            read += 1;
        }
        assert!(read >= 3);
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn both_formats_hold_the_same_matrix_needs_data() {
    for (place, name) in [("plate", "bcsstk09"), ("hb", "bcsstk01")] {
        let folder = shared(place);
        let read = |ending: &str| std::fs::read(folder.join(format!("{name}.{ending}"))).unwrap();
        let rsa = harwell_boeing::read(&read("rsa")).unwrap();
        let mtx = matrix_market::read(&read("mtx")).unwrap();
        assert_eq!((rsa.nrows, &rsa.rows, &rsa.cols), (mtx.nrows, &mtx.rows, &mtx.cols));
        for (a, b) in values(&rsa).iter().zip(values(&mtx)) {
            // Both files hold twelve decimal digits of the same number.
            assert!(a.to_bits() == b.to_bits(), "{name}: {a:e} and {b:e}");
        }
    }
}

#[test]
#[ignore = "needs the data of ../shared/data"]
fn header_lines_become_the_title_needs_data() {
    let folder = shared("plate");
    let matrix = harwell_boeing::read(&std::fs::read(folder.join("bcsstk09.rsa")).unwrap()).unwrap();
    assert_eq!(matrix.title, "1SYMMETRIC STIFFNESS MATRIX, SQUARE PLATE CLAMPED\nBCSSTK09");
    assert_eq!((matrix.nrows, matrix.ncols, matrix.rows.len()), (1083, 1083, 9760));
}
