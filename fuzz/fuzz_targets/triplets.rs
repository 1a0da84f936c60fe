//! What the reader of bare lists accepts is valid, and is read back equal.

#![no_main]

use frfit_formats::{Entries, triplets};
use libfuzzer_sys::fuzz_target;
use std::fmt::Write;

fuzz_target!(|bytes: &[u8]| {
    let _ = triplets::read_dofs(bytes);
    let Ok(mut matrix) = triplets::read(bytes) else { return };
    matrix.validate().unwrap();
    let Entries::Real(values) = &matrix.entries else { panic!("real values") };
    let mut text = String::new();
    for ((row, col), value) in matrix.rows.iter().zip(&matrix.cols).zip(values) {
        let _ = writeln!(text, "{} {} {value:e}", row + 1, col + 1);
    }
    matrix.title.clear();
    assert_eq!(triplets::read(text.as_bytes()), Ok(matrix));
});
