//! Chores of the project: `cargo xtask test`, `cargo xtask docs`, `cargo xtask bench`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // its outcome is what it prints

mod bench;
mod docs;
mod python;
mod step;
mod test;

use std::process::ExitCode;

const USAGE: &str = "\
cargo xtask test [--quick | --python]
                                 formatting, lints, all tests and doc tests, documentation, the Python package;
                                 --quick: tests and doc tests only; --python: the Python package only
cargo xtask docs                 documentation in target/doc, formulas typeset where there is npm
cargo xtask bench [NAME [ARG…]]  one benchmark, or all; tables to the terminal, figures to target/bench
cargo xtask bench solvers [ARG…] multifrontal beside other sparse solvers; crates/multifrontal/compare says what it needs";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let passed = match words.as_slice() {
        ["test"] => test::all(),
        ["test", "--quick"] => test::quick(),
        ["test", "--python"] => test::python(),
        ["docs"] => docs::build(),
        ["bench"] => bench::all(),
        ["bench", name, rest @ ..] => bench::one(name, rest),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
