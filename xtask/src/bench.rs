//! Benchmarks are programs of the crate frfit-bench: this only starts them.

use crate::step::{cargo, workspace};

/// Every benchmark there is, the others too where one fails.
pub(crate) fn all() -> bool {
    names().iter().filter(|name| !one(name, &[])).count() == 0
}

/// One benchmark with its arguments.
pub(crate) fn one(name: &str, arguments: &[&str]) -> bool {
    let names = names();
    if !names.iter().any(|known| known == name) {
        eprintln!("no benchmark is named {name:?}; there are {}", names.join(", "));
        return false;
    }
    let start = ["run", "--quiet", "--release", "--package", "frfit-bench", "--bin", name, "--"];
    cargo(start).args(arguments).status().is_ok_and(|status| status.success())
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
