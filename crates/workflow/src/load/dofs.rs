//! Names of rows.

use super::files::Files;
use crate::case::{Located, Spot};
use crate::error::{InputError, Place};
use crate::units::UnitSystem;
use frfit::dof::{Axis, DofName};
use frfit::model::Sensor;
use frfit_formats::csv::{self, Direction};
use frfit_formats::{DofLabel, FormatError};
use std::collections::BTreeMap;

/// Rows of the model by node and axis.
#[derive(Debug)]
pub(super) struct Dofs {
    dim: usize,
    /// The axes of each node with their rows (from 0); `None` where nothing names rows.
    nodes: Option<BTreeMap<u64, Vec<(Axis, usize)>>>,
    /// What names them.
    named_by: &'static str,
    /// Whether a named row is a rotation.
    turns: BTreeMap<usize, bool>,
    /// What the value of a rotation's row is multiplied by to be in rad: see [`crate::units`].
    rotation: f64,
}

impl Dofs {
    /// Reads the names of a model's rows, if the case gives any; else takes those of the matrices' files.
    pub(super) fn read(
        file: Option<&Located<String>>,
        dim: usize,
        labels: &[DofLabel],
        units: UnitSystem,
        files: &mut Files,
    ) -> Result<Self, InputError> {
        let rotation = units.rotation();
        let Some(name) = file else { return Ok(Self::of_labels(dim, labels, rotation)) };
        let file = files.read(name)?;
        let names = csv::read_dof_names(&file.bytes).map_err(|error| file.refuse(error))?;
        let mut nodes = BTreeMap::<u64, Vec<_>>::new();
        for (k, name) in names.into_iter().enumerate() {
            if name.row > dim {
                return Err(file.refuse(beyond(&file.bytes, k, dim, name.row)));
            }
            nodes.entry(name.node.unsigned_abs()).or_default().push((axis(name.direction), name.row - 1));
        }
        let turns = turns(&nodes);
        Ok(Self { dim, nodes: Some(nodes), named_by: "[dofs] names", turns, rotation })
    }

    /// Names from what the rows stand for; what has no direction, or a node of the solver's own, has none.
    fn of_labels(dim: usize, labels: &[DofLabel], rotation: f64) -> Self {
        let mut nodes = BTreeMap::<u64, Vec<_>>::new();
        for (row, label) in labels.iter().enumerate() {
            if let (Ok(node @ 1..), Some(direction)) = (u64::try_from(label.node), label.direction()) {
                nodes.entry(node).or_default().push((axis(direction), row));
            }
        }
        let turns = turns(&nodes);
        let nodes = (!labels.is_empty()).then_some(nodes);
        Self { dim, nodes, named_by: "the files of the matrices name", turns, rotation }
    }

    /// Whether a row (from 0) is a rotation; `None` where nothing names it.
    pub(super) fn is_rotation(&self, row: usize) -> Option<bool> {
        self.turns.get(&row).copied()
    }

    /// What a row's value is multiplied by to be a displacement in m or an angle in rad, and what a force in N or a moment in N·m is multiplied by to load
    /// it. A row without a name counts as a translation.
    pub(super) fn in_si(&self, row: usize) -> f64 {
        // In metres there is nothing to look up.
        if self.rotation != 1.0 && self.is_rotation(row) == Some(true) { self.rotation } else { 1.0 }
    }

    /// The names of rows (from 0), each counted positive along its axis.
    pub(super) fn names(&self) -> BTreeMap<usize, String> {
        let nodes = self.nodes.iter().flatten();
        let named = nodes.flat_map(|(&node, axes)| axes.iter().map(move |&(axis, row)| (node, axis, row)));
        named.map(|(node, axis, row)| (row, DofName { node, axis, reversed: false }.to_string())).collect()
    }

    /// Row, sign (in units other than metres times [`Dofs::in_si`]) and label of a degree of freedom.
    pub(super) fn find(&self, spot: &Spot) -> Result<(Sensor, String), InputError> {
        match spot {
            Spot::Row(row) => match usize::try_from(row.value) {
                Ok(n) if (1..=self.dim).contains(&n) => {
                    Ok((Sensor { row: n - 1, sign: self.in_si(n - 1) }, format!("row {n}")))
                }
                _ => Err(InputError::at(&row.place, format!("1 to {}", self.dim), row.value.to_string())),
            },
            Spot::Dof(name) => Ok((self.named(name.value, &name.place)?, name.value.to_string())),
        }
    }

    /// The axes of a name's node with their rows (from 0); the name itself has to be there too.
    pub(super) fn axes(&self, name: &Located<DofName>) -> Result<&[(Axis, usize)], InputError> {
        self.named(name.value, &name.place)?;
        let axes = self.nodes.as_ref().and_then(|nodes| nodes.get(&name.value.node));
        Ok(axes.map_or(&[], Vec::as_slice))
    }

    /// Row and sign of a name; `place` is who asks for it.
    fn named(&self, name: DofName, place: &Place) -> Result<Sensor, InputError> {
        let Some(nodes) = &self.nodes else {
            let expected = "a table [dofs] that names the rows, or a row number instead of a name";
            return Err(InputError::at(place, expected, format!("the name {name} without [dofs]")));
        };
        let expected = format!("a degree of freedom that {}", self.named_by);
        let refuse = |found| Err(InputError::at(place, expected, found));
        match nodes.get(&name.node) {
            Some(axes) => match axes.iter().find(|(axis, _)| *axis == name.axis) {
                Some(&(_, row)) => Ok(Sensor { row, sign: name.sign() * self.in_si(row) }),
                None => refuse(format!("{name} (node {} has {})", name.node, listed(axes))),
            },
            None => {
                let below = nodes.range(..name.node).next_back();
                let above = nodes.range(name.node..).next();
                let nearest = below.into_iter().chain(above).min_by_key(|(node, _)| node.abs_diff(name.node));
                let hint =
                    nearest.map(|(node, axes)| format!("; the nearest is {node} with {}", listed(axes)));
                refuse(format!("{name} (no node {}{})", name.node, hint.unwrap_or_default()))
            }
        }
    }
}

/// Which rows are rotations.
fn turns(nodes: &BTreeMap<u64, Vec<(Axis, usize)>>) -> BTreeMap<usize, bool> {
    let turns = |axis: Axis| matches!(axis, Axis::Rx | Axis::Ry | Axis::Rz);
    nodes.values().flatten().map(|&(axis, row)| (row, turns(axis))).collect()
}

fn listed(axes: &[(Axis, usize)]) -> String {
    axes.iter().map(|(axis, _)| axis.name()).collect::<Vec<_>>().join(", ")
}

fn axis(direction: Direction) -> Axis {
    match direction {
        Direction::X => Axis::X,
        Direction::Y => Axis::Y,
        Direction::Z => Axis::Z,
        Direction::Rx => Axis::Rx,
        Direction::Ry => Axis::Ry,
        Direction::Rz => Axis::Rz,
    }
}

/// The k-th row number of a table is beyond the model: with its line and column.
pub(super) fn beyond(bytes: &[u8], k: usize, dim: usize, row: usize) -> FormatError {
    let expected = format!("a row from 1 to {dim}");
    let table = csv::Table::read(bytes).ok();
    let at = table.and_then(|table| Some((table.column("row").ok()?, table)));
    match at {
        Some((column, table)) => table.error(k, column, expected, row.to_string()),
        None => FormatError::whole(expected, row.to_string()),
    }
}
