//! The documentation with its formulas typeset: the library's pages and the site.
//!
//! Formulas are written `$…$` and `$$…$$`, in doc comments and in docs/site. Node typesets them with KaTeX in the pages
//! themselves, so that a page needs no script: only KaTeX's style sheet and fonts, which are copied beside it.

use crate::python;
use crate::site;
use crate::step::{Step, cargo, run, sum_up, target};
use crate::typeset::typeset;

/// Builds target/doc and target/site.
pub(crate) fn build() -> bool {
    let mut steps = vec![documentation()];
    steps.extend(typeset(&target().join("doc")));
    println!("{}", target().join("doc/frfit/index.html").display());
    steps.extend(site::steps());
    sum_up(&steps)
}

/// The documentation, in which a broken link or a missing comment is an error.
///
/// Only rustdoc sees the flag: nothing that other steps have built is built again.
pub(crate) fn documentation() -> Step {
    let mut command = cargo(["doc", "--workspace", "--no-deps"]);
    run("documentation", python::seen_by(&mut command).env("RUSTDOCFLAGS", "-D warnings"))
}

#[cfg(test)]
mod tests {
    use crate::step::workspace;
    use std::path::Path;

    /// All files below a folder.
    fn files(folder: &Path, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            match path.is_dir() {
                true => files(&path, found),
                false => found.push(path.to_string_lossy().replace('\\', "/")),
            }
        }
    }

    #[test]
    fn source_files_that_the_architecture_names_are_there() {
        let mut found = Vec::new();
        ["crates", "xtask"].into_iter().for_each(|folder| files(&workspace().join(folder), &mut found));
        let named = |page: &Path| {
            let text = std::fs::read_to_string(page).unwrap();
            let code = text.split('`').skip(1).step_by(2);
            let is_file = |name: &&str| name.ends_with(".rs") && !name.contains([' ', '{', '*']);
            let names: Vec<&str> = code.filter(is_file).collect();
            assert!(
                names.iter().all(|name| found.iter().any(|file| file.ends_with(&format!("/{name}")))),
                "{}: {names:?}",
                page.display()
            );
            names.len()
        };
        let docs = workspace().join("docs");
        assert!(["architecture.md", "equations.md"].iter().all(|page| named(&docs.join(page)) > 0));
        let decisions = std::fs::read_dir(docs.join("decisions")).unwrap().flatten();
        assert!(decisions.map(|decision| named(&decision.path())).sum::<usize>() > 0);
    }

    #[test]
    fn every_decision_stands_in_the_list() {
        let folder = workspace().join("docs/decisions");
        let list = std::fs::read_to_string(folder.join("README.md")).unwrap();
        let mut records = 0;
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let name = entry.file_name().into_string().unwrap();
            if name == "README.md" {
                continue;
            }
            records += 1;
            assert!(list.contains(&format!("[{}]({name})", &name[..3])), "{name}");
            let text = std::fs::read_to_string(entry.path()).unwrap();
            assert!(text.starts_with(&format!("# {}: ", &name[..3])), "{name}");
            assert!(
                ["Context", "Choice", "Consequence"]
                    .iter()
                    .all(|part| text.contains(&format!("## {part}\n")))
            );
        }
        assert_eq!(records, list.matches("\n- [").count());
    }
}
