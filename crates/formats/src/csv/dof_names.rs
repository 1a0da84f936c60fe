//! Names of degrees of freedom: row, node, direction.

use std::fmt;

use super::Table;
use super::vector::{distinct_rows, once};
use crate::FormatError;

/// The direction of a degree of freedom: a translation along an axis or a rotation about one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z.
    Z,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl Direction {
    const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::Rx, Self::Ry, Self::Rz];

    /// X, Y, Z, RX, RY or RZ; lower case as well. `None` for anything else.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|direction| direction.name().eq_ignore_ascii_case(name))
    }

    /// X, Y, Z, RX, RY or RZ.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
            Self::Rx => "RX",
            Self::Ry => "RY",
            Self::Rz => "RZ",
        }
    }

    /// From 1, 2, 3 for X, Y, Z and 4, 5, 6 for RX, RY, RZ; `None` for any other number.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|direction| direction.number() == number)
    }

    /// 1, 2, 3 for X, Y, Z and 4, 5, 6 for RX, RY, RZ: the number in [`uff::Dof`](crate::uff::Dof).
    #[must_use]
    pub fn number(self) -> i32 {
        self as i32 + 1
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What a row of the matrices stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DofName {
    /// Row of the matrices, from 1.
    pub row: usize,
    /// Node number.
    pub node: i64,
    /// Direction at the node.
    pub direction: Direction,
}

/// Reads names of degrees of freedom: columns row (from 1), node, direction; in the order of the file.
///
/// # Errors
/// What [`Table::read`] refuses; a column that is missing or unknown; no line of data; row 0; a row, or a node
/// and direction, given twice; a direction other than X, Y, Z, RX, RY, RZ.
pub fn read_dof_names(bytes: &[u8]) -> Result<Vec<DofName>, FormatError> {
    let table = Table::read(bytes)?;
    table.only(&["row", "node", "direction"])?;
    let (row, node, direction) = (table.column("row")?, table.column("node")?, table.column("direction")?);
    table.at_least_one_row()?;
    let rows = distinct_rows(&table, row)?;
    let places = (0..table.rows())
        .map(|k| {
            let unknown = || table.error(k, direction, "X, Y, Z, RX, RY or RZ", table.shown(k, direction));
            let name = Direction::parse(table.text(k, direction)).ok_or_else(unknown)?;
            let beyond = |_| table.error(k, node, "a node number below 2^63", table.shown(k, node));
            Ok((i64::try_from(table.whole(k, node, 0)?).map_err(beyond)?, name))
        })
        .collect::<Result<Vec<_>, FormatError>>()?;
    once(&table, node, &places, "each node and direction once")?;
    Ok(rows
        .into_iter()
        .zip(places)
        .map(|(row, (node, direction))| DofName { row, node, direction })
        .collect())
}
