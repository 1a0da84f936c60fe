//! `error_map.csv`: ε over frequency and order of the series.

use super::columns::Columns;
use frfit_formats::FormatError;

/// ε where some frequencies and orders meet.
#[derive(Debug)]
pub(crate) struct ErrorMap {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) order: Vec<f64>,
    /// `error[order][frequency]`; `None` where that order has no root.
    pub(crate) error: Vec<Vec<Option<f64>>>,
}

/// What a map may have of either: a file that names more orders and frequencies than rows could fill makes no larger map.
const MAX_SIDE: usize = 400;

impl ErrorMap {
    pub(crate) fn read(table: &Columns) -> Result<Self, FormatError> {
        let (f, n) = (table.all_numbers("frequency_hz")?, table.all_numbers("order")?);
        let error = table.numbers("error")?;
        let distinct = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        let (frequency_hz, order) = (distinct(&f), distinct(&n));
        if frequency_hz.len().max(order.len()) > MAX_SIDE {
            let found = format!("{} frequencies and {} orders", frequency_hz.len(), order.len());
            return Err(FormatError::whole(format!("up to {MAX_SIDE} frequencies and orders"), found));
        }
        let mut map = vec![vec![None; frequency_hz.len()]; order.len()];
        for (row, error) in error.into_iter().enumerate() {
            let place =
                |values: &[f64], value: f64| values.partition_point(|other| other.total_cmp(&value).is_lt());
            map[place(&order, n[row])][place(&frequency_hz, f[row])] = error;
        }
        Ok(Self { frequency_hz, order, error: map })
    }
}
