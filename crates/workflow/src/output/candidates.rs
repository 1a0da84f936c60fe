//! `candidates.csv`: every solution that was found, and why one was not taken.

use frfit::identify::Line;
use frfit::material::loss_factor;
use frfit::roots::{Candidate, Refusal};
use frfit_formats::csv::{Cell, write};

const COLUMNS: [&str; 6] =
    ["frequency_hz", "storage", "loss_factor", "correction_re", "correction_im", "verdict"];

/// One row a frequency and candidate, in the order in which they were found.
///
/// The verdict is `chosen`, `alternative` (the data cannot exclude it), `admissible` (the other frequencies or sensors exclude it), or the
/// reason of a refusal: `storage` or `loss_factor` (that bound is broken), `not_real`, `far` (from the nominal), `moves`, `not_a_root`.
pub fn candidates_csv(outcomes: &[Line]) -> String {
    let rows = outcomes.iter().flat_map(|outcome| {
        outcome.roots.iter().map(|root| {
            let factor = outcome.nominal() + root.correction;
            [
                Cell::Number(outcome.frequency_hz),
                Cell::Number(factor.re),
                Cell::Number(loss_factor(factor)),
                Cell::Number(root.correction.re),
                Cell::Number(root.correction.im),
                Cell::Text(verdict(outcome, root)),
            ]
        })
    });
    write(&COLUMNS, rows).expect("every row has the columns, and no text a line break")
}

fn verdict(outcome: &Line, root: &Candidate) -> &'static str {
    match root.refusal {
        _ if outcome.correction() == Some(root.correction) => "chosen",
        None if outcome.is_rival(root) => "alternative",
        None => "admissible",
        Some(Refusal::OutOfBounds(bound)) => bound,
        Some(Refusal::NotReal) => "not_real",
        Some(Refusal::Far) => "far",
        Some(Refusal::Moves) => "moves",
        Some(Refusal::NotARoot) => "not_a_root",
        Some(_) => "refused",
    }
}
