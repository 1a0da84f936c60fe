//! What is said of dense arrays: a matrix is one however it is stored.

use frfit_workflow::inspect::inspect;
use std::path::Path;

fn said(name: &str) -> String {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../formats/tests/containers/samples");
    inspect(&samples.join(name)).unwrap().text()
}

/// A dense array of version 1.0 with numbers of eight bytes, row by row.
fn npy(shape: &str, numbers: &[f64]) -> Vec<u8> {
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version, length and header are a multiple of 64 bytes.
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

#[test]
fn dense_arrays_are_matrices() {
    // 16 entries that are not zero of 36 places, complex and symmetric.
    let numpy = said("dense3F.npy");
    for line in ["  size      6 x 6\n", "  entries   16 stored, 16 not zero in all\n", "a term of a model"] {
        assert!(numpy.contains(line), "{numpy}");
    }
    let wide = said("dense5F.npy");
    assert!(wide.contains("  size      2 x 3\n") && wide.contains("not a term of a model"), "{wide}");
    // The same matrix sparse (K) and dense (full).
    let matlab = said("matlab.mat");
    let facts = |name: &str| {
        let lines = matlab.lines().skip_while(|line| line.trim() != name).skip(1);
        lines.take_while(|line| line.starts_with("    ")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(facts("K").len() > 4, "{matlab}");
    assert_eq!(facts("K"), facts("full"), "{matlab}");
}

#[test]
fn a_dense_array_that_is_no_matrix_is_refused_with_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let inspected = |shape: &str, numbers: &[f64]| {
        let path = folder.path().join("a.npy");
        std::fs::write(&path, npy(shape, numbers)).unwrap();
        inspect(&path).map_or_else(|error| error.to_string(), |found| found.text())
    };
    let full = inspected("(2, 2)", &[2.0, -1.0, -1.0, 2.0]);
    assert!(
        full.contains("  entries   4 stored, 4 not zero in all\n") && full.contains("a term of a model"),
        "{full}"
    );
    let zero = inspected("(2, 2)", &[0.0; 4]);
    assert!(zero.contains(" 2 x 2\n"), "{zero}");
    let unlike = inspected("(2, 2)", &[2.0, -1.0, -1.5, 2.0]);
    assert!(
        unlike.contains("not a term of a model") && unlike.contains("found -1 at (1, 2) but -1.5 at (2, 1)"),
        "{unlike}"
    );
    for (shape, numbers) in [("(4,)", 4), ("(2, 2, 1)", 4), ("()", 1), ("(3, 3)", 4)] {
        let said = inspected(shape, &vec![1.0; numbers]);
        assert!(said.contains("expected ") && said.contains("found "), "{shape}: {said}");
    }
    // Not a number.
    let said = inspected("(1, 1)", &[f64::NAN]);
    assert!(said.contains("NaN") || said.contains("finite"), "{said}");
}
