//! What the DMIG reader accepts is valid, and has a label for each row.

#![no_main]

use frfit_formats::dmig;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for entry in dmig::read(bytes).unwrap_or_default() {
        let Ok(matrix) = entry.matrix else { continue };
        matrix.validate().unwrap();
        assert_eq!(entry.labels.rows.len(), matrix.nrows);
        assert!(entry.labels.rows.is_sorted());
        let columns = entry.labels.columns.len();
        assert!(columns == 0 || columns == matrix.ncols);
    }
});
