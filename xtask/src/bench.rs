//! Benchmarks are programs of the crate frfit-bench, and one is a package of its own: this only starts them.

use crate::step::{cargo, target, workspace};

/// The comparison of sparse solvers. It takes an hour and programs that are not Rust's: it is no part of [`all`].
const SOLVERS: &str = "solvers";

/// Every benchmark there is, the others too where one fails.
pub(crate) fn all() -> bool {
    names().iter().filter(|name| !one(name, &[])).count() == 0
}

/// One benchmark with its arguments.
pub(crate) fn one(name: &str, arguments: &[&str]) -> bool {
    if name == SOLVERS {
        return solvers(arguments);
    }
    let names = names();
    if !names.iter().any(|known| known == name) {
        eprintln!("no benchmark is named {name:?}; there are {}, {SOLVERS}", names.join(", "));
        return false;
    }
    let start = ["run", "--quiet", "--release", "--package", "frfit-bench", "--bin", name, "--"];
    cargo(start).args(arguments).status().is_ok_and(|status| status.success())
}

/// The comparison of sparse solvers: not a member of the workspace, but built in its folder.
fn solvers(arguments: &[&str]) -> bool {
    let mut command =
        cargo(["run", "--quiet", "--release", "--manifest-path", "crates/multifrontal/compare/Cargo.toml"]);
    command.arg("--target-dir").arg(target()).arg("--").args(arguments);
    command.status().is_ok_and(|status| status.success())
}

/// The programs in crates/bench/src/bin, in alphabetical order.
fn names() -> Vec<String> {
    let folder = workspace().join("crates/bench/src/bin");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.filter_map(|entry| Some(entry.path().file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    names
}
