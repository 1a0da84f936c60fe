//! Cells coloured by value or by class, at their true places.

use crate::scale::{drawable, to_linear, to_scale};
use crate::{Color, Scale};

/// A field of values over the grid `x` × `y`, with a colour bar beside the panel.
///
/// Each cell reaches half way to its neighbours, so an uneven grid shows as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatMap {
    /// Column positions; any order, any spacing.
    pub x: Vec<f64>,
    /// Row positions; any order, any spacing.
    pub y: Vec<f64>,
    /// Values row by row: `values[row * x.len() + column]`; NaN or absent is a grey cell.
    pub values: Vec<f64>,
    /// Label of the colour bar, with the unit.
    pub label: String,
    /// Values at the two ends of the colour bar; `None` for the extent of the data. Values outside
    /// take the colour of the nearer end.
    pub range: Option<(f64, f64)>,
    /// Names of the rows, written at `y` in place of numbers; empty for numbers.
    pub names: Vec<String>,
}

/// One class of a [`Strip`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Class {
    /// Name in the legend.
    pub label: String,
    /// Fill of its cells.
    pub color: Color,
}

/// A row of cells below a panel, each coloured by its class (for instance a status per frequency).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strip {
    /// Positions; any order, any spacing.
    pub x: Vec<f64>,
    /// Index into `classes` for each position; an index without a class is a grey cell.
    pub class: Vec<usize>,
    /// The classes; those that occur are named in the legend.
    pub classes: Vec<Class>,
}

/// A cell's extent along one axis and the index of its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    pub(crate) index: usize,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Cells around `centres` in ascending order, meeting half way (on the axis) between neighbours; the
/// outermost are symmetric about their centres. Centres that cannot be drawn have no cell.
pub(crate) fn cells(centres: &[f64], scale: Scale) -> Vec<Cell> {
    let mut order: Vec<usize> = (0..centres.len()).filter(|&i| drawable(centres[i], scale)).collect();
    order.sort_by(|&a, &b| centres[a].total_cmp(&centres[b]));
    let at = |k: usize| to_scale(centres[order[k]], scale);
    let last = order.len().saturating_sub(1);
    let edge_above = |k: usize| 0.5 * (at(k) + at(k + 1));
    let cell = |k: usize| {
        let (from, to) = match (k > 0, k < last) {
            (true, true) => (edge_above(k - 1), edge_above(k)),
            (true, false) => (edge_above(k - 1), 2.0 * at(k) - edge_above(k - 1)),
            (false, true) => (2.0 * at(k) - edge_above(k), edge_above(k)),
            (false, false) => (at(k) - 0.5, at(k) + 0.5),
        };
        Cell { index: order[k], from: to_linear(from, scale), to: to_linear(to, scale) }
    };
    (0..order.len()).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uneven_cells_meet_half_way_and_keep_their_index() {
        let got = cells(&[4.0, 1.0, f64::NAN, 2.0], Scale::Linear);
        let want = [(1, 0.5, 1.5), (3, 1.5, 3.0), (0, 3.0, 5.0)];
        assert_eq!(got, want.map(|(index, from, to)| Cell { index, from, to }));
    }

    #[test]
    fn logarithmic_cells_meet_at_the_geometric_mean() {
        let got = cells(&[1.0, 100.0], Scale::Log);
        // 10^x and log10 each round once: a few units in the last place
        for (value, want) in [(got[0].from, 0.1), (got[0].to, 10.0), (got[1].to, 1000.0)] {
            assert!((value / want - 1.0).abs() < 1e-14, "{value} is not {want}");
        }
    }
}
