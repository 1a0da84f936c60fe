//! Everything that must hold before a change is kept, in two tiers: daily, and long.

use crate::browser::browser;
use crate::docs::documentation;
use crate::outside::{self, Outside};
use crate::prose;
use crate::python;
use crate::site;
use crate::slowest;
use crate::step::{Step, cargo, run, sum_up, works};
use crate::tier::{LONG, Tier};
use std::thread;

/// Prose, formatting, lints, tests, doc tests, documentation, the Python package; of the long tier the site and the report in
/// a browser too. Every step runs, even after one that failed.
pub(crate) fn all(tier: Tier) -> bool {
    for (command, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if !works(&mut cargo([command, "--version"])) {
            eprintln!("cargo {command} is missing: rustup component add {component}");
            return false;
        }
    }
    // The interpreter comes first: lints, tests and wheel have to see the same one, or PyO3 is built anew for each.
    let mut steps: Vec<Step> = python::environment().into_iter().collect();
    steps.push(prose::check());
    let tools = thread::scope(|scope| {
        // The package index is waited for, which leaves the cores to the lints.
        let tools = scope.spawn(python::tools);
        steps.push(run("format", &mut cargo(["fmt", "--all", "--check"])));
        let mut clippy = cargo(["clippy", "--workspace", "--all-targets", "--features", ADAPTERS]);
        clippy.args(["--", "-D", "warnings"]);
        steps.push(run("clippy", python::seen_by(&mut clippy)));
        tools.join().ok().flatten()
    });
    steps.extend(tools);
    let has_python = python::has_tools();
    if has_python && tier == Tier::Long {
        python::install_outside();
    }
    if tier == Tier::Long {
        outside::install_mumps();
    }
    steps.push(tests(tier));
    if has_python {
        steps.extend(python::wheel());
    }
    // Either leaves a core free.
    let mut package = Vec::new();
    thread::scope(|scope| {
        if has_python {
            scope.spawn(|| package = python::tests(tier));
        }
        steps.extend([doc_tests(), documentation()]);
    });
    steps.extend(package);
    if tier == Tier::Long {
        steps.push(adapters());
        steps.extend(site::steps());
        steps.extend(browser());
    }
    slowest::print();
    sum_up(&steps)
}

/// Tests and doc tests only, with the Python that is there.
pub(crate) fn quick(tier: Tier) -> bool {
    let steps = [tests(tier), doc_tests()];
    slowest::print();
    sum_up(&steps)
}

/// Features that no other crate of the workspace asks for. The lints see their code, which costs nothing where nothing has changed;
/// tests with them would build all crates a second time.
const ADAPTERS: &str = "multifrontal/faer,multifrontal/sprs";

/// The tests of multifrontal with the matrices of other crates.
fn adapters() -> Step {
    let mut command =
        cargo(["test", "--package", "multifrontal", "--all-features", "--test", "it", "matrix"]);
    run("adapters", python::seen_by(&mut command))
}

/// Where property tests begin, unless `PROPTEST_RNG_SEED` says otherwise: the same cases for the same code, so that
/// a test that fails was broken by the change. Other cases are tried by naming another seed and more `PROPTEST_CASES`.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "1");

/// The doc tests, which cargo-nextest does not run.
fn doc_tests() -> Step {
    run("doc tests", python::seen_by(&mut cargo(["test", "--workspace", "--doc", "--no-fail-fast"])))
}

/// All other tests, with cargo-nextest where it is installed.
fn tests(tier: Tier) -> Step {
    let seed = std::env::var(SEED.0).unwrap_or_else(|_| SEED.1.into());
    let Outside { python, absent } = outside::look();
    let mut runner = if works(&mut cargo(["nextest", "--version"])) {
        slowest::forget();
        let mut runner = cargo(["nextest", "run", "--workspace", "--tests"]);
        runner.args(["--no-fail-fast", "--run-ignored", "all"]);
        if !absent.is_empty() {
            runner.args(["--filterset", &format!("not test(/_(needs|and)_({})/)", absent.join("|"))]);
        }
        runner
    } else {
        let mut runner = cargo(["test", "--workspace", "--tests", "--no-fail-fast"]);
        runner.args(["--", "--include-ignored"]);
        for name in absent {
            runner.args(["--skip", &format!("_needs_{name}"), "--skip", &format!("_and_{name}")]);
        }
        runner
    };
    runner.env(SEED.0, seed);
    if let Some(python) = python {
        runner.env(outside::PYTHON, python);
    }
    if tier == Tier::Long {
        runner.env(LONG, "1");
    }
    run("tests", python::seen_by(&mut runner))
}
