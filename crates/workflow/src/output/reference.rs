//! `reference.csv`: what the identified values are compared with.

use super::columns::{named, table};
use crate::load::IdentifyCase;
use frfit::identify::{Line, LineValue};
use frfit::material::Law;
use frfit_formats::csv::Cell;

const OF_UNKNOWN: [&str; 4] = ["nominal_re", "nominal_im", "true_re", "true_im"];

/// One row a frequency: the nominal value of each unknown, and the true one where the case gives it.
pub fn reference_csv(identify: &IdentifyCase, lines: &[Line]) -> String {
    let mut columns = vec!["frequency_hz".to_owned()];
    columns.extend(named(identify, &OF_UNKNOWN));
    let rows = lines.iter().map(|line| {
        let of_one = |(value, reference): (&LineValue, &Option<Law>)| {
            let reference = reference.as_ref().and_then(|law| law.at(line.frequency_hz).ok());
            [
                Cell::Number(value.nominal.re),
                Cell::Number(value.nominal.im),
                reference.map(|factor| factor.re).into(),
                reference.map(|factor| factor.im).into(),
            ]
        };
        let values = line.values.iter().zip(&identify.reference).flat_map(of_one);
        std::iter::once(Cell::Number(line.frequency_hz)).chain(values).collect()
    });
    table(&columns, rows)
}
