//! `identified.csv`: one row a frequency.

use super::columns::{named, table};
use crate::load::IdentifyCase;
use frfit::identify::{Line, LineValue};
use frfit_formats::csv::Cell;

/// Of each unknown: its value.
const VALUE: [&str; 6] =
    ["storage", "loss_factor", "factor_re", "factor_im", "correction_re", "correction_im"];

/// Of the frequency.
const LINE: [&str; 8] = [
    "error",
    "spectral_radius",
    "order",
    "candidate_count",
    "status",
    "convergence_radius",
    "required_order",
    "reduction_error",
];

/// Of each unknown: its error bars.
const BARS: [&str; 6] = [
    "storage_std",
    "loss_factor_std",
    "storage_loss_correlation",
    "storage_std_noise",
    "storage_std_model",
    "storage_std_known_factors",
];

/// The table; what does not exist is an empty cell. Columns of an unknown begin with [`IdentifyCase::prefix`].
pub fn identified_csv(identify: &IdentifyCase, lines: &[Line]) -> String {
    let mut columns = vec!["frequency_hz".to_owned()];
    columns.extend(named(identify, &VALUE));
    columns.extend(LINE.map(str::to_owned));
    columns.extend(named(identify, &BARS));
    columns.push("chi2".to_owned());
    let rows = lines.iter().map(|line| {
        let mut row = vec![Cell::Number(line.frequency_hz)];
        row.extend(line.values.iter().flat_map(value));
        row.extend(of_line(line));
        row.extend(line.values.iter().flat_map(bars));
        row.push(line.chi_squared.into());
        row
    });
    table(&columns, rows)
}

fn value<'a>(of: &LineValue) -> [Cell<'a>; 6] {
    [
        of.storage().into(),
        of.loss_factor().into(),
        of.value.map(|factor| factor.re).into(),
        of.value.map(|factor| factor.im).into(),
        of.correction.map(|correction| correction.re).into(),
        of.correction.map(|correction| correction.im).into(),
    ]
}

fn of_line<'a>(line: &Line) -> [Cell<'a>; 8] {
    [
        line.error.into(),
        line.spectral_radius.into(),
        Cell::Count(line.order),
        Cell::Count(line.candidate_count()),
        Cell::Text(line.status.name()),
        line.convergence_radius().into(),
        line.required_order.map_or(Cell::Empty, Cell::Count),
        line.reduction_error.into(),
    ]
}

fn bars<'a>(of: &LineValue) -> [Cell<'a>; 6] {
    let bars = of.uncertainty;
    let contributions = bars.map(|bars| bars.contributions);
    [
        bars.map(|bars| bars.storage_std).into(),
        bars.and_then(|bars| bars.loss_factor_std).into(),
        bars.and_then(|bars| bars.correlation).into(),
        contributions.map(|parts| parts.noise).into(),
        contributions.map(|parts| parts.model).into(),
        contributions.map(|parts| parts.known_factors).into(),
    ]
}
