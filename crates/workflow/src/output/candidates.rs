//! `candidates.csv`: every solution that was found, and why one was not taken.

use super::columns::{named, table};
use crate::load::IdentifyCase;
use frfit::c64;
use frfit::identify::{Line, LineSolution, Standing};
use frfit::material::loss_factor;
use frfit::roots::{Candidate, Refusal};
use frfit_formats::csv::Cell;

const OF_UNKNOWN: [&str; 4] = ["storage", "loss_factor", "correction_re", "correction_im"];

/// A solution at a frequency.
pub(crate) struct Solution {
    /// Change of each unknown.
    pub(crate) corrections: Vec<c64>,
    /// See [`candidates_csv`].
    pub(crate) verdict: &'static str,
}

impl Solution {
    /// Value of the j-th unknown.
    pub(crate) fn value(&self, line: &Line, j: usize) -> c64 {
        line.values[j].nominal + self.corrections[j]
    }
}

/// One row a frequency and candidate, in the order in which they were found; of several unknowns the one of least misfit first. Columns of an unknown begin with [`IdentifyCase::prefix`].
///
/// The verdict is `chosen`, `alternative` (the data cannot exclude it), `admissible` (the other frequencies or sensors exclude it), or the
/// reason of a refusal: `storage` or `loss_factor` (that bound is broken), `not_real`, `far` (from the nominal), `moves`, `not_a_root`.
pub fn candidates_csv(identify: &IdentifyCase, lines: &[Line]) -> String {
    let mut columns = vec!["frequency_hz".to_owned()];
    columns.extend(named(identify, &OF_UNKNOWN));
    columns.push("verdict".to_owned());
    let rows = lines.iter().flat_map(|line| {
        solutions(line).into_iter().map(|solution| {
            let of_one = |(j, correction): (usize, &c64)| {
                let factor = solution.value(line, j);
                [factor.re, loss_factor(factor), correction.re, correction.im].map(Cell::Number)
            };
            let mut row = vec![Cell::Number(line.frequency_hz)];
            row.extend(solution.corrections.iter().enumerate().flat_map(of_one));
            row.push(Cell::Text(solution.verdict));
            row
        })
    });
    table(&columns, rows)
}

/// The roots of a single unknown; all solutions of several.
pub(crate) fn solutions(line: &Line) -> Vec<Solution> {
    if let [_] = line.values[..] {
        let of_root =
            |root: &Candidate| Solution { corrections: vec![root.correction], verdict: verdict(line, root) };
        return line.roots.iter().map(of_root).collect();
    }
    let of_solution = |solution: &LineSolution| Solution {
        corrections: solution.values.iter().zip(&line.values).map(|(own, of)| own - of.nominal).collect(),
        verdict: match solution.standing {
            Standing::Chosen => "chosen",
            Standing::Rival => "alternative",
            Standing::Excluded => "admissible",
        },
    };
    line.solutions.iter().map(of_solution).collect()
}

fn verdict(line: &Line, root: &Candidate) -> &'static str {
    match root.refusal {
        _ if line.correction() == Some(root.correction) => "chosen",
        None if line.is_rival(root) => "alternative",
        None => "admissible",
        Some(Refusal::OutOfBounds(bound)) => bound,
        Some(Refusal::NotReal) => "not_real",
        Some(Refusal::Far) => "far",
        Some(Refusal::Moves) => "moves",
        Some(Refusal::NotARoot) => "not_a_root",
        Some(_) => "refused",
    }
}
