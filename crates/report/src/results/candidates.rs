//! `candidates.csv`: every solution, and why one was not taken.

use super::columns::Columns;
use frfit_formats::FormatError;

/// What became of a solution, as far as a page tells it apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    Chosen,
    /// The data cannot exclude it.
    Alternative,
    /// Other frequencies or sensors exclude it.
    Admissible,
    /// It breaks a bound, or is not a solution of the converged system.
    Refused,
}

const WORDS: [(&str, Verdict); 9] = [
    ("chosen", Verdict::Chosen),
    ("alternative", Verdict::Alternative),
    ("admissible", Verdict::Admissible),
    ("storage", Verdict::Refused),
    ("loss_factor", Verdict::Refused),
    ("not_real", Verdict::Refused),
    ("far", Verdict::Refused),
    ("moves", Verdict::Refused),
    ("not_a_root", Verdict::Refused),
];

/// One row a solution, by frequency.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    pub(crate) frequency_hz: Vec<f64>,
    /// `None` where it is infinite.
    pub(crate) storage: Vec<Option<f64>>,
    pub(crate) loss_factor: Vec<Option<f64>>,
    pub(crate) verdict: Vec<Verdict>,
}

impl Candidates {
    pub(crate) fn read(table: &Columns) -> Result<Self, FormatError> {
        let column = table.column("verdict")?;
        let verdict = (0..table.rows()).map(|row| table.word(row, column, &WORDS));
        Ok(Self {
            verdict: verdict.collect::<Result<_, _>>()?,
            frequency_hz: table.all_numbers("frequency_hz")?,
            storage: table.numbers("storage")?,
            loss_factor: table.numbers("loss_factor")?,
        })
    }
}
