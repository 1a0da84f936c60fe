//! What a row of a matrix stands for: node and component.

use std::fmt;

use crate::FormatError;
use crate::csv::Direction;

/// A degree of freedom as a solver names it.
///
/// Sorted by node, then component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DofLabel {
    /// Node or grid number, in size below 2³¹. Negative for a node that the solver has made for itself.
    pub node: i64,
    /// 1 to 3 for the translations X, Y, Z and 4 to 6 for the rotations about them; 0 for a scalar point,
    /// above 6 whatever else the solver counts (warping, pressure, temperature).
    pub component: u8,
}

/// The largest node number.
pub(crate) const MAX_NODE: u64 = i32::MAX as u64;

impl DofLabel {
    /// The direction in which it moves; `None` for a component that has none.
    #[must_use]
    pub fn direction(self) -> Option<Direction> {
        Direction::from_number(i32::from(self.component))
    }

    /// In eight bytes, in the same order.
    pub(crate) fn code(self) -> i64 {
        self.node * 256 + i64::from(self.component)
    }

    /// From what [`DofLabel::code`] gives.
    pub(crate) fn of_code(code: i64) -> Self {
        Self { node: code.div_euclid(256), component: code.rem_euclid(256) as u8 }
    }
}

impl fmt::Display for DofLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.direction() {
            Some(direction) if self.node > 0 => write!(f, "{}+{direction}", self.node),
            _ => write!(f, "node {} component {}", self.node, self.component),
        }
    }
}

/// What the rows and columns of a matrix stand for.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Labels {
    /// Of each row; empty where the file does not say.
    pub rows: Vec<DofLabel>,
    /// Of each column; empty where it is that of the row of the same number, or where the file does not say.
    pub columns: Vec<DofLabel>,
    /// Degrees of freedom that the solver holds fixed: they have no row.
    pub fixed: Vec<DofLabel>,
}

impl Labels {
    /// Labels of a square matrix.
    #[must_use]
    pub fn of_rows(rows: Vec<DofLabel>) -> Self {
        Self { rows, ..Self::default() }
    }
}

/// Up to three labels and how many more there are, as an error lists them.
#[must_use]
pub fn listed_labels(labels: &[DofLabel]) -> String {
    const MAX_SHOWN: usize = 3;
    let shown: Vec<_> = labels.iter().take(MAX_SHOWN).map(DofLabel::to_string).collect();
    match labels.len().saturating_sub(MAX_SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// The labels of rows, each there once; `lines` says where each is.
pub(crate) fn distinct(labels: Vec<DofLabel>, lines: &[u32]) -> Result<Vec<DofLabel>, FormatError> {
    let mut order: Vec<u32> = (0..labels.len() as u32).collect();
    order.sort_by_key(|&k| labels[k as usize]);
    let twice = order.windows(2).filter(|pair| labels[pair[0] as usize] == labels[pair[1] as usize]);
    match twice.map(|pair| (pair[0] as usize, pair[1] as usize)).min_by_key(|pair| pair.1) {
        Some((first, second)) => {
            let found = format!("{} again, first in line {}", labels[second], lines[first]);
            Err(FormatError::line(lines[second] as usize, "each name once", found))
        }
        None => Ok(labels),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_keep_the_label_and_the_order() {
        let labels = [(-3, 2), (-3, 255), (-1, 1), (1, 0), (1, 6), (2, 1), (2_147_483_647, 255)]
            .map(|(node, component)| DofLabel { node, component });
        assert!(labels.is_sorted());
        let codes = labels.map(DofLabel::code);
        assert!(codes.is_sorted());
        assert_eq!(codes.map(DofLabel::of_code), labels);
    }

    #[test]
    fn labels_show_as_names_where_they_have_a_direction() {
        let shown = |node, component| DofLabel { node, component }.to_string();
        assert_eq!(shown(712, 1), "712+X");
        assert_eq!(shown(3, 6), "3+RZ");
        assert_eq!(shown(-3, 1), "node -3 component 1");
        assert_eq!(shown(7, 0), "node 7 component 0");
    }
}
