//! Formulas in pages, typeset by KaTeX.

use crate::step::{Step, run, target, works, workspace};
use std::path::Path;
use std::process::Command;

/// The version that the pages are known to look right with.
const KATEX: &str = "katex@0.16.22";

/// Typesets the pages of a folder; where KaTeX cannot be had, the formulas stay as they are written, with a word.
pub(crate) fn typeset(pages: &Path) -> Vec<Step> {
    let folder = target().join(KATEX);
    let package = folder.join("node_modules/katex");
    if !package.exists() {
        println!("── npm install {KATEX}");
        let mut install = Command::new("npm");
        install.args(["install", "--ignore-scripts", "--no-audit", "--no-fund", "--prefix"]);
        works(install.arg(&folder).arg(KATEX));
    }
    if !package.exists() || !works(Command::new("node").arg("--version")) {
        println!(
            "── formulas: SKIPPED, {KATEX} cannot be installed, or node is missing; they stay as they are written"
        );
        return Vec::new();
    }
    let mut typeset = Command::new("node");
    typeset.arg(workspace().join("xtask/typeset.cjs")).arg(package).arg(pages);
    vec![run("formulas", typeset.current_dir(workspace()))]
}
