//! How much of an identification is right.

use frfit::c64;
use frfit::identify::{Line, Status};
use frfit::material::OutsideTable;
use std::fmt;

/// Counts of frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Score {
    /// With the right factor, whatever the status.
    pub right: usize,
    /// Without the right factor, and called ok.
    pub wrong_ok: usize,
    /// With the right factor, and called ok.
    pub right_ok: usize,
    /// All.
    pub count: usize,
}

impl Score {
    /// Counts the factors that are the truth within a relative tolerance.
    ///
    /// # Errors
    /// [`OutsideTable`] where the truth is not known.
    pub fn of(
        lines: &[Line],
        truth: impl Fn(f64) -> Result<c64, OutsideTable>,
        tolerance: f64,
    ) -> Result<Self, OutsideTable> {
        let mut score = Self { count: lines.len(), ..Self::default() };
        for line in lines {
            let truth = truth(line.frequency_hz)?;
            let right = line.factor().is_some_and(|p| (p - truth).norm() <= tolerance * truth.norm());
            let ok = line.status == Status::Ok;
            score.right += usize::from(right);
            score.right_ok += usize::from(right && ok);
            score.wrong_ok += usize::from(!right && ok);
        }
        Ok(score)
    }
}

/// The fraction that is right, and in brackets how many are wrong and called ok.
impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3} ({})", self.right as f64 / self.count as f64, self.wrong_ok)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_counts_as_right_whatever_its_status_and_none_never() {
        let nominal = c64::new(2.0, 0.1);
        let missing = Line::out_of_band(1.0, &[nominal]);
        let answer = |correction: c64, status| {
            let mut line = Line { status, ..missing.clone() };
            line.values[0].value = Some(nominal + correction);
            line
        };
        let lines = [
            answer(c64::new(1e-7, 0.0), Status::Ok),
            answer(c64::default(), Status::Ambiguous),
            answer(c64::new(1e-3, 0.0), Status::Ok),
            missing.clone(),
        ];
        let score = Score::of(&lines, |_| Ok(nominal), 1e-6).unwrap();
        assert_eq!(score, Score { right: 2, wrong_ok: 1, right_ok: 1, count: 4 });
        assert_eq!(score.to_string(), "0.500 (1)");
    }
}
