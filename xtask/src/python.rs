//! The Python package: its wheel, installed into an environment of its own, with its tests, doctests and types.

use crate::step::{Step, cargo, run, run_beside, target, works, workspace};
use crate::tier::{LONG, Tier};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::Instant;

/// What the tests need beside the wheel, those in Rust too; the version of pyuff is the one whose reading is known.
const PACKAGES: [&str; 9] =
    ["maturin>=1.9,<2", "numpy", "scipy", "pytest", "mypy", "pandas", "matplotlib", "xarray", "pyuff==2.4.2"];

/// What the Rust tests of the long tier read and write files with.
const OUTSIDE: [&str; 10] = [
    "pyNastran",
    "pyyeti",
    "lvm_read",
    "pyFRF",
    "sdypy-EMA",
    "distributed",
    "scikit-fem",
    "nbclient",
    "nbformat",
    "ipykernel",
];

/// Python from 3.10 on, with `venv`.
const SUITED: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// The package alone.
pub(crate) fn steps() -> Vec<Step> {
    let environment = environment();
    let mut steps: Vec<Step> = environment.into_iter().chain(tools()).collect();
    if has_tools() {
        steps.extend(wheel());
        steps.extend(tests(Tier::Daily));
    }
    steps
}

fn wheels() -> PathBuf {
    target().join("wheels")
}

fn crate_folder() -> PathBuf {
    workspace().join("crates/python")
}

fn binary(name: &str) -> PathBuf {
    let place = if cfg!(windows) { "Scripts" } else { "bin" };
    target().join("python-venv").join(place).join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

/// The interpreter of the environment; `None` where the environment was not made.
pub(crate) fn interpreter() -> Option<PathBuf> {
    Some(binary("python")).filter(|python| python.exists())
}

/// Whether the environment has all that builds and tests the package.
pub(crate) fn has_tools() -> bool {
    binary("maturin").exists()
}

/// Lets PyO3 see the interpreter that maturin shows to it: with another one it would be built anew.
pub(crate) fn seen_by(cargo: &mut Command) -> &mut Command {
    match interpreter() {
        Some(python) => cargo.env("PYO3_PYTHON", python),
        None => cargo,
    }
}

/// Creates the environment, also one that was left half made. Without a suitable Python it prints that the package is skipped.
pub(crate) fn environment() -> Option<Step> {
    if has_tools() {
        return None;
    }
    let names = ["python3", "python"];
    let Some(python) = names.into_iter().find(|name| works(Command::new(name).args(["-c", SUITED]))) else {
        skipped("no Python 3.10 or later with venv was found");
        return None;
    };
    let folder = target().join("python-venv");
    let venv = run("Python venv", Command::new(python).args(["-m", "venv"]).arg(folder));
    if !venv.passed {
        skipped("no environment can be made");
        return None;
    }
    Some(venv)
}

/// Installs the missing tools into the environment. Without a package index it prints that the package is skipped.
pub(crate) fn tools() -> Option<Step> {
    if interpreter().is_none() || has_tools() {
        return None;
    }
    let tools = run_beside("Python tools", pip_install().args(PACKAGES));
    if !tools.passed {
        skipped(&format!("{} cannot be installed", PACKAGES.join(", ")));
        return None;
    }
    Some(tools)
}

fn skipped(why: &str) {
    println!("── Python: SKIPPED, {why}; crates/python is not tested");
}

/// Installs what only the long tier needs; where that cannot be had, `outside::look` says which tests are left out.
pub(crate) fn install_outside() {
    println!("── pip install {}", OUTSIDE.join(" "));
    works(pip_install().args(OUTSIDE));
}

fn pip_install() -> Command {
    let mut command = Command::new(binary("python"));
    command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    command
}

/// The dependencies of a selection of packages, each with its features.
fn dependencies(selection: &[&str], edges: &str) -> BTreeSet<String> {
    let tree =
        cargo(["tree", "--prefix", "none", "--format", "{p} {f}", "--edges", edges]).args(selection).output();
    let text = tree.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().map(|line| line.trim_end_matches("(*)").trim_end().to_owned()).collect()
}

/// That the wheel, built alone, asks for no crate with other features than the tests of the workspace: it would be compiled twice.
fn features() -> Step {
    println!("── features");
    let start = Instant::now();
    let wheel = dependencies(&["--package", "frfit-python"], "normal,build");
    let tests = dependencies(&["--workspace"], "normal,build,dev");
    let twice: Vec<&String> = wheel.difference(&tests).collect();
    for line in &twice {
        eprintln!(
            "{line}: the tests use it with other features; crates/python/Cargo.toml shall ask for the same"
        );
    }
    let passed = twice.is_empty() && !wheel.is_empty();
    Step { name: "features", seconds: start.elapsed().as_secs_f64(), passed, closing: Vec::new() }
}

/// Builds the wheel and installs it.
pub(crate) fn wheel() -> Vec<Step> {
    // Of the whole workspace, as the tests were built.
    let mut program = cargo(["build", "--quiet", "--workspace", "--bin", "frfit"]);
    let mut steps = vec![features(), run("frfit-cli", seen_by(&mut program))];
    let wheels = wheels();
    // No older wheel may be tested. An error that there was none is fine.
    let _ = std::fs::remove_dir_all(&wheels);
    let mut build = Command::new(binary("maturin"));
    build.args(["build", "--quiet", "--interpreter"]).arg(binary("python")).arg("--out").arg(&wheels);
    build.env("CARGO_TARGET_DIR", target()).current_dir(crate_folder());
    steps.push(run("Python wheel", seen_by(&mut build)));
    let Some(wheel) = only_file(&wheels) else { return steps };
    let mut install = pip_install();
    steps.push(run("Python install", install.args(["--force-reinstall", "--no-deps"]).arg(wheel)));
    steps
}

/// Tests and types of the installed wheel, beside one another: most of the tests' time is on one core.
pub(crate) fn tests(tier: Tier) -> Vec<Step> {
    let (crate_folder, wheels) = (crate_folder(), wheels());
    if only_file(&wheels).is_none() {
        return Vec::new();
    }
    // From a folder in which there is no package of this name: what is tested is the wheel.
    let mut tests = Command::new(binary("python"));
    tests.args(["-m", "pytest", "-q", "-c"]).arg(crate_folder.join("pyproject.toml"));
    tests.arg("--rootdir").arg(&crate_folder).arg(crate_folder.join("tests"));
    tests.args(["--durations", "5", "--doctest-modules", "--pyargs", "frfit"]);
    tests
        .env("FRFIT_CLI", target().join(format!("debug/frfit{}", std::env::consts::EXE_SUFFIX)))
        .current_dir(&wheels);
    if tier == Tier::Long {
        tests.env(LONG, "1");
    }
    let types = |name: &'static str, arguments: &[&str]| {
        let mut command = Command::new(binary("python"));
        run_beside(name, command.arg("-m").args(arguments).current_dir(&crate_folder))
    };
    let stubs = ["mypy.stubtest", "frfit._frfit", "--mypy-config-file", "pyproject.toml"];
    let mut steps = Vec::new();
    let types = thread::scope(|scope| {
        scope.spawn(|| steps.push(run_beside("Python tests", &mut tests)));
        [types("mypy", &["mypy", "python/frfit"]), types("mypy stubtest", &stubs)]
    });
    steps.extend(types);
    steps
}

fn only_file(folder: &Path) -> Option<PathBuf> {
    std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).next()
}
