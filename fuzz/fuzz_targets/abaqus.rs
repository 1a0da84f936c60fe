//! What the reader of Abaqus' labelled matrices accepts is valid, and is read back equal.

#![no_main]

use frfit_formats::{Entries, abaqus};
use libfuzzer_sys::fuzz_target;
use std::fmt::Write;

fuzz_target!(|bytes: &[u8]| {
    let Ok((mut matrix, mut labels)) = abaqus::read(bytes) else { return };
    matrix.validate().unwrap();
    assert_eq!(labels.rows.len(), matrix.nrows);
    let Entries::Real(values) = &matrix.entries else { panic!("real values") };
    let mut text = String::new();
    for ((&row, &col), value) in matrix.rows.iter().zip(&matrix.cols).zip(values) {
        let (row, col) = (labels.rows[row], labels.rows[col]);
        let _ = writeln!(text, "{},{}, {},{}, {value:e}", row.node, row.component, col.node, col.component);
    }
    if values.is_empty() {
        return; // of fixed degrees of freedom alone
    }
    matrix.title.clear();
    labels.fixed.clear();
    assert_eq!(abaqus::read(text.as_bytes()), Ok((matrix, labels)));
});
