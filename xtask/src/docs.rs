//! The documentation with its formulas typeset.
//!
//! Formulas in doc comments are written `$…$` and `$$…$$`. After rustdoc, Node typesets them with KaTeX in the pages
//! themselves, so that a page needs no script: only KaTeX's style sheet and fonts, which are copied beside it.

use crate::step::{run, sum_up, target, works, workspace};
use crate::test::documentation;
use std::process::Command;

/// The version that the pages are known to look right with.
const KATEX: &str = "katex@0.16.22";

/// Builds target/doc; without npm and Node the formulas stay as they are written.
pub(crate) fn build() -> bool {
    let mut steps = vec![documentation()];
    if works(Command::new("npm").arg("--version")) && works(Command::new("node").arg("--version")) {
        let folder = target().join("katex");
        let package = folder.join("node_modules/katex");
        let mut install = Command::new("npm");
        install.args(["install", "--ignore-scripts", "--no-audit", "--no-fund", "--prefix"]);
        steps.push(run("KaTeX", install.arg(&folder).arg(KATEX)));
        let mut typeset = Command::new("node");
        typeset.arg(workspace().join("xtask/typeset.cjs")).arg(package).arg(target().join("doc"));
        steps.push(run("formulas", typeset.current_dir(workspace())));
    } else {
        println!("npm or node is missing: formulas stay as they are written");
    }
    println!("{}", target().join("doc/frfit/index.html").display());
    sum_up(&steps)
}
