//! What the table reader accepts can be written and read back equal; the typed readings come back.

#![no_main]

use frfit_formats::csv::{
    Cell, Table, read_dof_names, read_frf, read_modulus, read_modulus_rows, read_time_records, read_vector, write,
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = (read_dof_names(bytes), read_modulus(bytes), read_vector(bytes), read_time_records(bytes));
    if let Ok(frf) = read_frf(bytes) {
        assert!(frf.frequency_hz.is_sorted_by(|a, b| a < b));
        assert_eq!(frf.frequency_hz.len(), frf.response.len());
    }
    if let Ok(rows) = read_modulus_rows(bytes) {
        // Units may round two frequencies to one.
        assert!(rows.answered.is_sorted_by(|a, b| a.frequency_hz <= b.frequency_hz));
        assert!(rows.answered.iter().all(|row| row.loss_factor.is_finite()));
    }
    let Ok(table) = Table::read(bytes) else { return };
    let names: Vec<&str> = table.names().collect();
    let cells: Vec<Vec<&str>> = (0..table.rows())
        .map(|row| (0..names.len()).map(|column| table.text(row, column)).collect())
        .collect();
    let rows = cells.iter().map(|row| row.iter().map(|cell| Cell::Text(cell)).collect::<Vec<_>>());
    let written = write(&names, rows).unwrap();
    let again = Table::read(written.as_bytes()).unwrap();
    assert_eq!(again.names().collect::<Vec<_>>(), names);
    assert_eq!(again.rows(), cells.len());
    for (row, expected) in cells.iter().enumerate() {
        for (column, expected) in expected.iter().enumerate() {
            assert_eq!(again.text(row, column), *expected);
        }
    }
});
