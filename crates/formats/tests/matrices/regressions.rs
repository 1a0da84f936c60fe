//! Inputs that once broke a reader: it may refuse them, but has to come back.

use std::path::Path;

use frfit_formats::{harwell_boeing, matrix_market};

fn each(target: &str, check: impl Fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions").join(target);
    for file in std::fs::read_dir(folder).unwrap() {
        check(&std::fs::read(file.unwrap().path()).unwrap());
    }
}

#[test]
fn matrix_market_inputs() {
    each("matrix_market", |bytes| {
        if let Ok(matrix) = matrix_market::read(bytes) {
            assert_eq!(matrix_market::read(&matrix_market::write(&matrix).unwrap()), Ok(matrix));
        }
    });
}

#[test]
fn harwell_boeing_inputs() {
    each("harwell_boeing", |bytes| {
        let _ = harwell_boeing::read_with_rhs(bytes);
        if let Ok(matrix) = harwell_boeing::read(bytes) {
            assert_eq!(harwell_boeing::read(&harwell_boeing::write(&matrix).unwrap()), Ok(matrix));
        }
    });
}
