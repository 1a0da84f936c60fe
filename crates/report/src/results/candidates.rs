//! `candidates.csv`: every solution, and why one was not taken.

use super::columns::Columns;
use super::unknown::Unknown;
use frfit_formats::FormatError;

/// What became of a solution, as far as a page shows it.
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
#[derive(Debug)]
pub(crate) struct Candidates {
    pub(crate) frequency_hz: Vec<f64>,
    pub(crate) verdict: Vec<Verdict>,
    /// Storage modulus and loss factor of each unknown; `None` where it is infinite.
    pub(crate) values: Vec<[Vec<Option<f64>>; 2]>,
}

impl Candidates {
    pub(crate) fn read(table: &Columns, unknowns: &[Unknown]) -> Result<Self, FormatError> {
        let column = table.column("verdict")?;
        let values = |one: &Unknown| {
            Ok([table.numbers(&one.column("storage"))?, table.numbers(&one.column("loss_factor"))?])
        };
        let verdict = (0..table.rows()).map(|row| table.word(row, column, &WORDS));
        Ok(Self {
            verdict: verdict.collect::<Result<_, _>>()?,
            frequency_hz: table.all_numbers("frequency_hz")?,
            values: unknowns.iter().map(values).collect::<Result<_, _>>()?,
        })
    }
}
