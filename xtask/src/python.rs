//! The Python package: its wheel, installed into an environment of its own, with its tests, doctests and types.

use crate::step::{Step, cargo, run, target, works, workspace};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the tests need beside the wheel; where one of the optional ones is missing, its tests say that they were left out.
const PACKAGES: [&str; 8] =
    ["maturin>=1.9,<2", "numpy", "scipy", "pytest", "mypy", "pandas", "matplotlib", "pyuff"];

/// Python from 3.10 on, with `venv`.
const SUITED: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// The steps; none, with a word, where there is no such Python, or no package index to install from.
pub(crate) fn steps() -> Vec<Step> {
    let names = ["python3", "python"];
    let Some(python) = names.into_iter().find(|name| works(Command::new(name).args(["-c", SUITED]))) else {
        println!(
            "── Python: SKIPPED, no Python 3.10 or later with venv was found; crates/python is not tested"
        );
        return Vec::new();
    };
    let folder = target().join("python-venv");
    let binary = |name: &str| {
        let place = if cfg!(windows) { "Scripts" } else { "bin" };
        folder.join(place).join(name)
    };
    let mut steps = Vec::new();
    if !binary("maturin").exists() {
        let mut install = Command::new(binary("python"));
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(PACKAGES);
        let venv = run("Python venv", Command::new(python).args(["-m", "venv"]).arg(&folder));
        steps.extend([venv, run("Python tools", &mut install)]);
        if steps.iter().any(|step| !step.passed) {
            println!(
                "── Python: SKIPPED, {} cannot be installed; crates/python is not tested",
                PACKAGES.join(", ")
            );
            return Vec::new();
        }
    }
    // Of the whole workspace, as the tests were built: of one package alone dependencies have other features, and are built again.
    steps.push(run("frfit-cli", &mut cargo(["build", "--quiet", "--workspace", "--bin", "frfit"])));
    let crate_folder = workspace().join("crates/python");
    let wheels = target().join("wheels");
    // Of an older wheel nothing shall be tested; where there is none, that is what is wanted.
    let _ = std::fs::remove_dir_all(&wheels);
    let mut build = Command::new(binary("maturin"));
    build.args(["build", "--quiet", "--interpreter"]).arg(binary("python")).arg("--out").arg(&wheels);
    steps.push(run("Python wheel", build.env("CARGO_TARGET_DIR", target()).current_dir(&crate_folder)));
    let Some(wheel) = only_file(&wheels) else { return steps };
    let mut install = Command::new(binary("python"));
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    steps.push(run("Python install", install.args(["--force-reinstall", "--no-deps"]).arg(wheel)));
    // From a folder in which there is no package of this name: what is tested is the wheel.
    let mut tests = Command::new(binary("python"));
    tests.args(["-m", "pytest", "-q", "-c"]).arg(crate_folder.join("pyproject.toml"));
    tests.arg("--rootdir").arg(&crate_folder).arg(crate_folder.join("tests"));
    tests.args(["--doctest-modules", "--pyargs", "frfit"]);
    steps
        .push(run("Python tests", tests.env("FRFIT_CLI", target().join("debug/frfit")).current_dir(&wheels)));
    let types = |name: &'static str, arguments: &[&str]| {
        let mut command = Command::new(binary("python"));
        run(name, command.arg("-m").args(arguments).current_dir(&crate_folder))
    };
    steps.push(types("mypy", &["mypy", "python/frfit"]));
    steps.push(types(
        "mypy stubtest",
        &["mypy.stubtest", "frfit._frfit", "--mypy-config-file", "pyproject.toml"],
    ));
    steps
}

fn only_file(folder: &Path) -> Option<PathBuf> {
    std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).next()
}
