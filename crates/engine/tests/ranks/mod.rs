//! How tests start ranks of `frfit-mumps`.

use std::path::PathBuf;

/// A launcher for so many ranks on this machine, whether or not it has as many cores.
pub(crate) fn launcher(ranks: usize) -> String {
    format!("mpirun --oversubscribe --allow-run-as-root -n {ranks}")
}

/// The program of the ranks, where `cargo xtask test` builds it, unless the environment names another.
pub(crate) fn program() -> PathBuf {
    let built = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/mumps/frfit-mumps"));
    std::env::var_os("FRFIT_MUMPS").map_or_else(built, PathBuf::from)
}
