//! Jobs of `frfit-mumps`, which `cargo xtask test` builds where MUMPS and MPI are installed.

use crate::ranks;
use frfit_engine::{Launch, Mumps};
use frfit_linalg::c64;
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};

/// So many ranks on this machine.
pub(crate) fn launch(ranks: usize) -> Launch {
    let mut launch = Launch::by(&ranks::launcher(ranks));
    launch.program = ranks::program();
    launch
}

pub(crate) fn mumps(ranks: usize) -> Mumps {
    Mumps::start(&launch(ranks)).unwrap()
}

/// The Laplacian of a square of m × m points, indefinite where `shift` is within its spectrum.
pub(crate) fn square(m: usize, shift: f64) -> SymmetricMatrix {
    let mut triplets = Triplets::new(m * m);
    for i in 0..m {
        for j in 0..m {
            let row = i * m + j;
            triplets.add(row, row, 4.0 - shift);
            if i > 0 {
                triplets.add(row, row - m, -1.0);
            }
            if j > 0 {
                triplets.add(row, row - 1, -1.0);
            }
        }
    }
    triplets.assemble()
}

/// Its values with a loss factor that differs from row to row.
pub(crate) fn lossy(matrix: &SymmetricMatrix) -> Vec<c64> {
    let values = matrix.real_values().unwrap();
    (0..).zip(values).map(|(k, &value)| c64::new(value, 0.1 * value * f64::from(k % 7))).collect()
}
