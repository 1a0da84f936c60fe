//! `identified.csv`: one row a frequency.

use frfit::identify::Line;
use frfit_formats::csv::{Cell, write};

const COLUMNS: [&str; 19] = [
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
    "candidate_count",
    "status",
    "convergence_radius",
    "required_order",
    "reduction_error",
    "storage_std",
    "loss_factor_std",
    "storage_loss_correlation",
    "chi2",
];

/// The table; what does not exist is an empty cell.
pub fn identified_csv(outcomes: &[Line]) -> String {
    let rows = outcomes.iter().map(|outcome| {
        let (factor, bars) = (outcome.factor(), outcome.uncertainty());
        [
            Cell::Number(outcome.frequency_hz),
            outcome.storage().into(),
            outcome.loss_factor().into(),
            factor.map(|f| f.re).into(),
            factor.map(|f| f.im).into(),
            outcome.correction().map(|c| c.re).into(),
            outcome.correction().map(|c| c.im).into(),
            outcome.error.into(),
            outcome.spectral_radius.into(),
            Cell::Count(outcome.order),
            Cell::Count(outcome.candidate_count()),
            Cell::Text(outcome.status.name()),
            outcome.convergence_radius().into(),
            outcome.required_order.map_or(Cell::Empty, Cell::Count),
            outcome.reduction_error.into(),
            bars.map(|bars| bars.storage_std).into(),
            bars.and_then(|bars| bars.loss_factor_std).into(),
            bars.and_then(|bars| bars.correlation).into(),
            outcome.chi_squared.into(),
        ]
    });
    write(&COLUMNS, rows).expect("every row has the columns, and no text a line break")
}
