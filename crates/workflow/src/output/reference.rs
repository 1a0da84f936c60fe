//! `reference.csv`: what the identified factor is compared with.

use crate::load::IdentifyCase;
use frfit::identify::Line;
use frfit_formats::csv::{Cell, write};

const COLUMNS: [&str; 5] = ["frequency_hz", "nominal_re", "nominal_im", "true_re", "true_im"];

/// One row a frequency: the nominal factor, and the true one where the case tells it.
pub fn reference_csv(identify: &IdentifyCase, outcomes: &[Line]) -> String {
    let rows = outcomes.iter().map(|outcome| {
        let reference = identify.reference[0].as_ref().and_then(|law| law.at(outcome.frequency_hz).ok());
        [
            Cell::Number(outcome.frequency_hz),
            Cell::Number(outcome.nominal().re),
            Cell::Number(outcome.nominal().im),
            reference.map(|factor| factor.re).into(),
            reference.map(|factor| factor.im).into(),
        ]
    });
    write(&COLUMNS, rows).expect("every row has the columns")
}
