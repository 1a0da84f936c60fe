//! What is written is read back equal.

use frfit_formats::csv::{Cell, Table, write};
use proptest::prelude::*;

/// Cells with everything that has a meaning in a table.
fn text() -> impl Strategy<Value = String> {
    proptest::string::string_regex("[ab1.,;\t\"# \u{e9}\u{feff}]{0,6}").unwrap()
}

proptest! {
    #[test]
    fn text_comes_back(cells in (1_usize..4).prop_flat_map(|width| {
        proptest::collection::vec(proptest::collection::vec(text(), width), 1..6)
    })) {
        let names: Vec<&str> = cells[0].iter().map(String::as_str).collect();
        let rows = cells[1..].iter().map(|row| row.iter().map(|cell| Cell::Text(cell)).collect::<Vec<_>>());
        let written = write(&names, rows).unwrap();
        let table = Table::read(written.as_bytes()).unwrap();
        prop_assert_eq!(table.names().collect::<Vec<_>>(), names);
        prop_assert_eq!(table.rows(), cells.len() - 1);
        for (row, expected) in cells[1..].iter().enumerate() {
            for (column, expected) in expected.iter().enumerate() {
                prop_assert_eq!(table.text(row, column), expected);
            }
        }
    }

    #[test]
    fn numbers_come_back_to_the_bit(numbers in proptest::collection::vec(any::<f64>(), 1..20)) {
        let rows = numbers.iter().map(|&x| [Cell::Number(x)]);
        let table = Table::read(write(&["x"], rows).unwrap().as_bytes()).unwrap();
        prop_assert_eq!(table.rows(), numbers.len());
        for (row, x) in numbers.iter().enumerate() {
            match x.is_finite() {
                true => prop_assert_eq!(table.number(row, 0).unwrap().to_bits(), x.to_bits()),
                false => prop_assert!(table.is_empty(row, 0)),
            }
        }
    }
}
