//! `error_map.csv`: ε over frequency and order of the series.

use crate::run::ErrorMap;
use frfit_formats::csv::{Cell, write};

/// One row a frequency and order; the error is empty where that order has no root.
pub fn error_map_csv(map: &ErrorMap) -> String {
    let rows = map.frequency_hz.iter().zip(&map.error).flat_map(|(&frequency_hz, by_order)| {
        let row = move |(order, error): (usize, &Option<f64>)| {
            [Cell::Number(frequency_hz), Cell::Count(order), (*error).into()]
        };
        (1..).zip(by_order).map(row)
    });
    write(&["frequency_hz", "order", "error"], rows).expect("every row has the columns")
}
