//! Nodes and cells of a line, a rectangle or a box, counted along x first, then y, then z.

use crate::Error;
use std::ops::Range;

/// Steps from the first node of a cell to its corners: the bottom face counterclockwise seen from above, then
/// the top face. The first two are those of a line, the first four those of a rectangle.
pub(crate) const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// A grid of equally connected cells; a direction that is not there has no cells, and one plane of nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    cells: [usize; 3],
}

impl Grid {
    /// The grid with these numbers of cells along x, y and z, or the first of them.
    ///
    /// # Errors
    /// Where one is 0, or there are more nodes than [`Error::MAX_NODES`].
    pub(crate) fn new<const AXES: usize>(along: [usize; AXES]) -> Result<Self, Error> {
        let (mut cells, mut nodes) = ([0; 3], 1_usize);
        for (cells, along) in cells.iter_mut().zip(along) {
            if along == 0 {
                let expected = "at least 1";
                return Err(Error::OutOfRange { name: "number of elements", expected, found: 0.0 });
            }
            nodes = nodes.saturating_mul(along.saturating_add(1));
            *cells = along;
        }
        if nodes > Error::MAX_NODES { Err(Error::TooManyNodes) } else { Ok(Self { cells }) }
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.cells.iter().map(|cells| cells + 1).product()
    }

    /// Place of a node along x, y and z.
    pub(crate) fn place(&self, node: usize) -> [usize; 3] {
        let [line, row] = [self.cells[0] + 1, self.cells[1] + 1];
        [node % line, node / line % row, node / (line * row)]
    }

    /// Whether a node is at the lower end along x, at the upper, and so for y and z.
    pub(crate) fn ends(&self, node: usize) -> [bool; 6] {
        let place = self.place(node);
        std::array::from_fn(|end| place[end / 2] == end % 2 * self.cells[end / 2])
    }

    /// The N corners of all cells whose place along z is in a range; 0..1 of a line or a rectangle.
    pub(crate) fn corners<const N: usize>(&self, layers: Range<usize>) -> Vec<[usize; N]> {
        let [line, row] = [self.cells[0] + 1, self.cells[1] + 1];
        let steps: [_; N] = std::array::from_fn(|corner| CORNERS[corner]);
        let mut corners = Vec::with_capacity(self.cells[0] * self.cells[1].max(1) * layers.len());
        for k in layers {
            for j in 0..self.cells[1].max(1) {
                for i in 0..self.cells[0] {
                    corners.push(steps.map(|[di, dj, dk]| (i + di) + line * ((j + dj) + row * (k + dk))));
                }
            }
        }
        corners
    }
}
