//! Everything that must hold before a change is kept.

use crate::browser::browser;
use crate::python;
use crate::site;
use crate::step::{Step, cargo, run, sum_up, works};

/// Formatting, lints, tests, doc tests, documentation, the site, the Python package, the report in a browser; every step runs, whatever the others say.
pub(crate) fn all() -> bool {
    for (command, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if !works(&mut cargo([command, "--version"])) {
            eprintln!("cargo {command} is missing: rustup component add {component}");
            return false;
        }
    }
    let mut steps = vec![
        run("format", &mut cargo(["fmt", "--all", "--check"])),
        run("clippy", &mut cargo(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"])),
    ];
    steps.extend(tests());
    steps.push(documentation());
    steps.extend(site::steps());
    steps.extend(python::steps());
    steps.extend(browser());
    sum_up(&steps)
}

/// Tests and doc tests only.
pub(crate) fn quick() -> bool {
    sum_up(&tests())
}

/// The documentation, in which a broken link or a missing comment is an error.
///
/// Only rustdoc sees the flag: nothing that other steps have built is built again.
pub(crate) fn documentation() -> Step {
    run("documentation", cargo(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))
}

/// Where property tests begin, unless `PROPTEST_RNG_SEED` says otherwise: the same cases for the same code, so that
/// a test that fails was broken by the change. Other cases are tried by naming another seed and more `PROPTEST_CASES`.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "1");

/// All tests with cargo-nextest where it is installed, then the doc tests, which it does not run.
fn tests() -> [Step; 2] {
    let seed = std::env::var(SEED.0).unwrap_or_else(|_| SEED.1.into());
    let mut runner = if works(&mut cargo(["nextest", "--version"])) {
        cargo(["nextest", "run", "--workspace", "--no-fail-fast"])
    } else {
        cargo(["test", "--workspace", "--lib", "--bins", "--tests", "--examples", "--no-fail-fast"])
    };
    let mut doc_tests = cargo(["test", "--workspace", "--doc", "--no-fail-fast"]);
    [run("tests", runner.env(SEED.0, seed)), run("doc tests", &mut doc_tests)]
}
