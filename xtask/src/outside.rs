//! What some tests need from outside of the project: the data of ../shared/data, modules of Python, MUMPS.
//!
//! Such a test is ignored by default, and its name ends with what it needs: `_needs_data`, `_needs_data_and_lvm_read`, `_needs_mumps`.

use crate::python;
use crate::step::{works, workspace};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

/// Names the Python of the tests.
pub(crate) const PYTHON: &str = "FRFIT_PYTHON";

/// Set by whoever has the data: tests that need them fail where they are absent.
const REQUIRE_DATA: &str = "FRFIT_REQUIRE_DATA";

/// The same for Python's modules.
const REQUIRE_PYTHON: &str = "FRFIT_REQUIRE_PYTHON";

/// How the names of tests call a module, and its own name.
const MODULES: [(&str, &str); 7] = [
    ("scipy", "scipy"),
    ("pyuff", "pyuff"),
    ("pynastran", "pyNastran"),
    ("pyyeti", "pyyeti"),
    ("lvm_read", "lvm_read"),
    ("pyfrf", "pyFRF"),
    ("sdypy", "sdypy.EMA"),
];

pub(crate) struct Outside {
    /// The interpreter for the tests; `None` where there is only what the path has.
    pub(crate) python: Option<OsString>,
    /// What is not there, as the names of tests call it: tests that need it are left out.
    pub(crate) absent: Vec<&'static str>,
}

/// Debian's packages of what `frfit-mumps` is made of.
const MUMPS: [&str; 4] = ["libmumps-dev", "libopenmpi-dev", "openmpi-bin", "libopenblas-dev"];

/// Installs MUMPS where that is possible: as root, by apt-get.
pub(crate) fn install_mumps() {
    if !works(Command::new("mpicc").arg("--version")) {
        println!("── apt-get install {}", MUMPS.join(" "));
        works(Command::new("apt-get").args(["install", "--yes", "--quiet"]).args(MUMPS));
    }
}

/// Builds `frfit-mumps` where MPI, MUMPS and a way to start ranks are installed.
fn mumps() -> Result<(), String> {
    for program in ["make", "mpicc", "mpirun"] {
        if !works(Command::new(program).arg("--version")) {
            return Err(format!("no {program} (engines/mumps/README.md says how to install it)"));
        }
    }
    let out = workspace().join("target/mumps");
    std::fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let mut make = Command::new("make");
    make.arg("-s").arg("-C").arg(workspace().join("engines/mumps")).arg(format!("OUT={}", out.display()));
    if works(&mut make) { Ok(()) } else { Err("engines/mumps does not build here".into()) }
}

/// Looks for all of it, and says what is absent.
pub(crate) fn look() -> Outside {
    let own = || python::interpreter().filter(|_| python::has_tools()).map(PathBuf::into_os_string);
    let python = std::env::var_os(PYTHON).or_else(own);
    let mut absent = Vec::new();
    let data =
        std::env::var_os("FRFIT_DATA").map_or_else(|| workspace().join("../shared/data"), PathBuf::from);
    if !data.is_dir() && std::env::var_os(REQUIRE_DATA).is_none() {
        println!("── tests that need the data are SKIPPED: no {}", data.display());
        absent.push("data");
    }
    if let Err(why) = mumps() {
        println!("── tests that need MUMPS are SKIPPED: {why}");
        absent.push("mumps");
    }
    let program = python.clone().unwrap_or_else(|| "python3".into());
    for (name, module) in MODULES {
        let there = || works(Command::new(&program).args(["-c", &format!("import {module}")]));
        if std::env::var_os(REQUIRE_PYTHON).is_none() && !there() {
            println!("── tests that need {module} are SKIPPED: {} lacks it", program.display());
            absent.push(name);
        }
    }
    Outside { python, absent }
}
