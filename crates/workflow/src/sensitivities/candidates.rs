//! Where another sensor may go.

use crate::error::{InputError, Place};
use crate::load::Case;
use frfit::dof::{Axis, DofName};
use std::fmt;
use std::str::FromStr;

/// The degrees of freedom among which the next sensor is searched.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Candidates {
    /// All translations that have a name; without names all rows.
    #[default]
    All,
    /// It is not searched.
    None,
    /// These.
    These(Vec<DofEntry>),
}

/// A degree of freedom as the command line names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DofEntry {
    /// `12+Z`.
    Dof(DofName),
    /// A row, from 1.
    Row(usize),
}

/// A text that names no candidates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownCandidates(String);

impl fmt::Display for UnknownCandidates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "expected all, none, or degrees of freedom such as 12+Z,55+Z or 41 (a row), found {:?}",
            self.0
        )
    }
}

impl std::error::Error for UnknownCandidates {}

impl FromStr for Candidates {
    type Err = UnknownCandidates;

    fn from_str(text: &str) -> Result<Self, UnknownCandidates> {
        let entry = |word: &str| {
            let word = word.trim();
            let dof = word.parse::<DofName>().map(DofEntry::Dof).ok();
            dof.or_else(|| word.parse().map(DofEntry::Row).ok())
                .ok_or_else(|| UnknownCandidates(word.to_owned()))
        };
        match text {
            "all" => Ok(Self::All),
            "none" => Ok(Self::None),
            _ => Ok(Self::These(text.split(',').map(entry).collect::<Result<_, _>>()?)),
        }
    }
}

impl Candidates {
    /// Their rows (from 0), each once, without those that have a sensor.
    ///
    /// # Errors
    /// [`InputError`] for a degree of freedom that the model has not.
    pub(super) fn rows(&self, case: &Case) -> Result<Vec<usize>, InputError> {
        let mut rows = match self {
            Self::None => Vec::new(),
            Self::All if case.row_names.is_empty() => (0..case.model.dim()).collect(),
            Self::All => {
                case.row_names.iter().filter(|(_, name)| translates(name)).map(|(&row, _)| row).collect()
            }
            Self::These(entries) => {
                entries.iter().map(|entry| entry.row(case)).collect::<Result<Vec<_>, _>>()?
            }
        };
        rows.sort_unstable();
        rows.dedup();
        rows.retain(|row| case.experiment.sensors.iter().all(|sensor| sensor.row != *row));
        Ok(rows)
    }
}

impl DofEntry {
    fn row(self, case: &Case) -> Result<usize, InputError> {
        let place = Place::option("--candidates");
        match self {
            Self::Row(row) if (1..=case.model.dim()).contains(&row) => Ok(row - 1),
            Self::Row(row) => {
                Err(InputError::at(&place, format!("a row from 1 to {}", case.model.dim()), row.to_string()))
            }
            Self::Dof(name) => {
                let wanted = DofName { reversed: false, ..name }.to_string();
                let found = case.row_names.iter().find(|(_, name)| **name == wanted).map(|(&row, _)| row);
                let expected = match case.row_names.is_empty() {
                    true => "a table [dofs] that names the rows, or row numbers instead of names",
                    false => "a degree of freedom that the case names",
                };
                found.ok_or_else(|| InputError::at(&place, expected, name.to_string()))
            }
        }
    }
}

fn translates(name: &str) -> bool {
    name.parse::<DofName>().is_ok_and(|name| matches!(name.axis, Axis::X | Axis::Y | Axis::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_name_candidates() {
        assert_eq!("all".parse(), Ok(Candidates::All));
        assert_eq!("none".parse(), Ok(Candidates::None));
        let dof = |text: &str| DofEntry::Dof(text.parse().unwrap());
        assert_eq!(
            "12+Z, 7-X,41".parse(),
            Ok(Candidates::These(vec![dof("12+Z"), dof("7-X"), DofEntry::Row(41)]))
        );
        let error = "12+Z,up".parse::<Candidates>().unwrap_err().to_string();
        assert!(error.contains("\"up\""), "{error}");
    }
}
