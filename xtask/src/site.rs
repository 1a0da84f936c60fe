//! The documentation site: docs/site, built by mdBook into target/site, its formulas typeset, its links followed.

use crate::links;
use crate::step::{Step, cargo, run, target, workspace};
use crate::typeset::typeset;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The version whose pages are known to look right. Without its server and its watcher it is built in a minute or two.
const MDBOOK: &str = "0.5.4";

/// The steps; none, with a word, where mdBook is neither there nor can be installed.
pub(crate) fn steps() -> Vec<Step> {
    let mut steps = Vec::new();
    let folder = target().join("site");
    // Of an older site nothing shall be looked at.
    let _ = std::fs::remove_dir_all(&folder);
    let mdbook = match mdbook() {
        Some(there) => there,
        None => {
            steps.push(run("mdBook", &mut install()));
            let own = own();
            if !is_suited(&own) {
                println!(
                    "── site: SKIPPED, mdBook {MDBOOK} is missing and cannot be installed; docs/site is not built (its code is tested all the same)"
                );
                return Vec::new();
            }
            own
        }
    };
    let mut build = Command::new(mdbook);
    build.arg("build").arg(workspace().join("docs/site")).arg("--dest-dir").arg(&folder);
    let built = run("site", &mut build);
    let passed = built.passed;
    steps.push(built);
    if passed {
        steps.extend(typeset(&folder));
        steps.push(links::check(&folder));
    }
    println!("{}", folder.join("index.html").display());
    steps
}

/// An mdBook of the version that is wanted, where there is one.
fn mdbook() -> Option<PathBuf> {
    [PathBuf::from("mdbook"), own()].into_iter().find(|path| is_suited(path))
}

/// Where this program installs it.
fn own() -> PathBuf {
    target().join("mdbook/bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX))
}

fn is_suited(path: &Path) -> bool {
    let version = Command::new(path).arg("--version").output();
    version.is_ok_and(|said| String::from_utf8_lossy(&said.stdout).trim() == format!("mdbook v{MDBOOK}"))
}

/// Optimised it would take several times as long to build, and a book of this size is rendered in a second anyway.
fn install() -> Command {
    let mut command = cargo(["install", "--quiet", "--locked", "--debug", "mdbook", "--version", MDBOOK]);
    command.args(["--no-default-features", "--features", "search", "--root"]).arg(target().join("mdbook"));
    // A folder of its own: what this workspace has built has other features.
    command.env("CARGO_TARGET_DIR", target().join("mdbook-build"));
    command
}
