//! Chores of the project: `cargo xtask test`, `cargo xtask prose`, `cargo xtask docs`, `cargo xtask bench`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // its outcome is what it prints

mod bench;
mod browser;
mod docs;
mod links;
mod outside;
mod prose;
mod python;
mod site;
mod slowest;
mod step;
mod test;
mod tier;
mod typeset;

use std::process::ExitCode;
use tier::Tier;

const USAGE: &str = "\
cargo xtask test                 the daily tier: formatting, lints, tests, doc tests, documentation, the Python package
cargo xtask test --long          everything: statistical tests with all their seeds and cases, the site, the report in a browser
cargo xtask test --quick         tests and doc tests of the daily tier only; --quick --long: of the long one
cargo xtask test browser         the report in headless Chromium alone; pictures to target/browser/pictures
cargo xtask test python          the Python package alone: its wheel, tests and types
cargo xtask test site            the documentation site alone: built, formulas typeset, links followed
cargo xtask prose                plain English in Markdown: words, lines and sentences
cargo xtask prose --code         the same words in doc comments and string literals, as a report
cargo xtask docs                 documentation in target/doc and the site in target/site, formulas typeset where there is npm
cargo xtask bench [NAME [ARG…]]  one benchmark, or all; tables to the terminal, figures to target/bench
cargo xtask bench solvers [ARG…] multifrontal beside other sparse solvers; crates/multifrontal/compare says what it needs";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let passed = match words.as_slice() {
        ["test"] => test::all(Tier::Daily),
        ["test", "--long"] => test::all(Tier::Long),
        ["test", "--quick"] => test::quick(Tier::Daily),
        ["test", "--quick", "--long"] => test::quick(Tier::Long),
        ["test", "browser"] => step::sum_up(&browser::browser()),
        ["test", "python"] => step::sum_up(&python::steps()),
        ["test", "site"] => step::sum_up(&site::steps()),
        ["prose"] => prose::check().passed,
        ["prose", "--code"] => prose::report_code(),
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
