//! Jobs of `frfit-mumps`, which `cargo xtask test` builds where MUMPS and MPI are installed.

use frfit_engine::{Launch, Mumps};
use frfit_linalg::c64;
use frfit_linalg::sparse::{SymmetricMatrix, Triplets};
use std::path::PathBuf;

/// So many ranks on this machine, whether or not it has as many cores.
pub(crate) fn launch(ranks: usize) -> Launch {
    let built = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/mumps/frfit-mumps"));
    let mut launch = Launch::by(&format!("mpirun --oversubscribe --allow-run-as-root -n {ranks}"));
    launch.program = std::env::var_os("FRFIT_MUMPS").map_or_else(built, PathBuf::from);
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
