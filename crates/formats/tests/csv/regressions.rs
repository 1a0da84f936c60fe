//! Inputs that once broke a reader: it may refuse them, but has to come back.

use std::path::Path;

use frfit_formats::csv::{Cell, Table, read_dof_names, read_frf, read_modulus, read_vector, write};

#[test]
fn csv_inputs() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions/csv");
    for file in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(file.unwrap().path()).unwrap();
        let _ = (read_dof_names(&bytes), read_frf(&bytes), read_modulus(&bytes), read_vector(&bytes));
        let Ok(table) = Table::read(&bytes) else { continue };
        let names: Vec<&str> = table.names().collect();
        let cells = |table: &Table| -> Vec<Vec<String>> {
            let row = |row| (0..names.len()).map(|column| table.text(row, column).to_owned()).collect();
            (0..table.rows()).map(row).collect()
        };
        let all = cells(&table);
        let rows = all.iter().map(|row| row.iter().map(|cell| Cell::Text(cell)).collect::<Vec<_>>());
        let again = Table::read(write(&names, rows).unwrap().as_bytes()).unwrap();
        assert_eq!((again.names().collect::<Vec<_>>(), cells(&again)), (names.clone(), all));
    }
}
