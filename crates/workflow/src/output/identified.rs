//! `identified.csv`: one row a frequency.

use frfit::identify::Identified;
use frfit_formats::csv::{Cell, write};

const COLUMNS: [&str; 15] = [
    "frequency_hz",
    "storage",
    "loss_factor",
    "factor_re",
    "factor_im",
    "correction_re",
    "correction_im",
    "error",
    "spectral_radius",
    "order",
    "candidates",
    "status",
    "pole_distance",
    "series_order",
    "certificate",
];

/// The table; what does not exist is an empty cell.
pub fn identified_csv(outcomes: &[Identified]) -> String {
    let rows = outcomes.iter().map(|outcome| {
        let factor = outcome.factor();
        [
            Cell::Number(outcome.frequency_hz),
            outcome.storage().into(),
            outcome.loss_factor().into(),
            factor.map(|f| f.re).into(),
            factor.map(|f| f.im).into(),
            outcome.correction.map(|c| c.re).into(),
            outcome.correction.map(|c| c.im).into(),
            outcome.error.into(),
            outcome.spectral_radius.into(),
            Cell::Count(outcome.order),
            Cell::Count(outcome.admissible()),
            Cell::Text(outcome.status.name()),
            outcome.pole_distance().into(),
            outcome.series_order.map_or(Cell::Empty, Cell::Count),
            outcome.certificate.into(),
        ]
    });
    write(&COLUMNS, rows).expect("every row has the columns, and no text a line break")
}
