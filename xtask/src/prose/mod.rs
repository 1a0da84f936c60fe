//! Plain English in Markdown: words of a list are refused with a suggestion, and so are long lines, long sentences and
//! lines with more than one sentence.

mod code;
mod markdown;
mod words;

use crate::step::{Step, workspace};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// One place to change.
#[derive(Debug, PartialEq)]
struct Fault {
    /// From 1.
    line: usize,
    /// The word, or the rule.
    what: String,
    suggestion: String,
}

/// Documents outside of `docs` and `crates`.
const SINGLE: [&str; 6] =
    ["README.md", "CHANGELOG.md", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "SECURITY.md", "paper/paper.md"];

/// Checks all Markdown of the repository.
pub(crate) fn check() -> Step {
    println!("── prose");
    let start = Instant::now();
    let passed = check_files(workspace()).unwrap_or_else(|error| {
        eprintln!("{error}");
        false
    });
    Step { name: "prose", seconds: start.elapsed().as_secs_f64(), passed, closing: Vec::new() }
}

fn check_files(root: &Path) -> io::Result<bool> {
    let mut passed = true;
    for path in documents(root)? {
        let name = name(root, &path);
        let mut text = std::fs::read_to_string(&path)?;
        if name == "CHANGELOG.md" {
            text.truncate(unreleased(&text));
        }
        let faults = markdown::faults(&text);
        faults.iter().for_each(|fault| print(&name, fault));
        passed &= faults.is_empty();
    }
    Ok(passed)
}

/// Prints words of the list in doc comments and string literals, and their number for each crate. It never fails.
pub(crate) fn report_code() -> bool {
    let root = workspace();
    match code_faults(root) {
        Ok(files) => {
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            for (name, faults) in &files {
                faults.iter().for_each(|fault| print(name, fault));
                let krate = name.split('/').nth(1).unwrap_or_default();
                *counts.entry(krate).or_default() += faults.len();
            }
            println!("── words of the list in code");
            counts.iter().for_each(|(krate, count)| println!("{krate:<14} {count:>5}"));
            println!("{:<14} {:>5}", "all", counts.values().sum::<usize>());
        }
        Err(error) => eprintln!("{error}"),
    }
    true
}

/// Each source file with its faults.
fn code_faults(root: &Path) -> io::Result<Vec<(String, Vec<Fault>)>> {
    let mut paths = Vec::new();
    for krate in std::fs::read_dir(root.join("crates"))? {
        let krate = krate?.path();
        for (folder, ending) in [("src", "rs"), ("python", "py")] {
            if krate.join(folder).is_dir() {
                below(
                    &krate.join(folder),
                    &|path| path.extension().is_some_and(|own| own == ending),
                    &mut paths,
                )?;
            }
        }
    }
    paths.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path)?;
        let is_rust = path.extension().is_some_and(|ending| ending == "rs");
        let prose = if is_rust { code::of_rust(&text) } else { code::of_python(&text) };
        Ok((name(root, &path), words::faults(&prose)))
    };
    paths.into_iter().map(read).collect()
}

fn print(name: &str, Fault { line, what, suggestion }: &Fault) {
    println!("{name}:{line}: {what}: {suggestion}");
}

/// The path of a file in the repository, with `/`.
fn name(root: &Path, path: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// All Markdown that readers of the repository see, in the order of its paths.
fn documents(root: &Path) -> io::Result<Vec<PathBuf>> {
    let is_markdown = |path: &Path| path.extension().is_some_and(|ending| ending == "md");
    let is_readme = |path: &Path| path.file_name().is_some_and(|name| name == "README.md");
    let mut paths: Vec<PathBuf> = SINGLE.iter().map(|name| root.join(name)).collect();
    below(&root.join("docs"), &is_markdown, &mut paths)?;
    below(&root.join("crates"), &is_readme, &mut paths)?;
    paths.sort();
    Ok(paths)
}

/// All files below a folder that suit. What was built or installed there is left out.
fn below(folder: &Path, suits: &dyn Fn(&Path) -> bool, paths: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let path = entry.path();
        let is_made = ["target", "node_modules"].iter().any(|name| entry.file_name() == *name);
        if entry.file_type()?.is_dir() {
            if !is_made {
                below(&path, suits, paths)?;
            }
        } else if suits(&path) {
            paths.push(path);
        }
    }
    Ok(())
}

/// Where the released versions begin in a changelog: their entries are history.
fn unreleased(text: &str) -> usize {
    text.match_indices("\n## [").nth(1).map_or(text.len(), |(at, _)| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Files in a folder of this name, and whether they pass.
    fn passes(folder: &str, files: &[(&str, &str)]) -> bool {
        let root = std::env::temp_dir().join(format!("frfit-prose-{}-{folder}", std::process::id()));
        for name in SINGLE.into_iter().chain(["docs/page.md", "crates/one/README.md"]) {
            let text = files.iter().find(|(own, _)| *own == name).map_or("# Title\n", |(_, text)| text);
            std::fs::create_dir_all(root.join(name).parent().unwrap()).unwrap();
            std::fs::write(root.join(name), text).unwrap();
        }
        let passed = check_files(&root).unwrap();
        std::fs::remove_dir_all(&root).unwrap();
        passed
    }

    #[test]
    fn every_document_is_read() {
        assert!(passes("good", &[]));
        for (k, name) in
            ["README.md", "paper/paper.md", "docs/page.md", "crates/one/README.md"].into_iter().enumerate()
        {
            assert!(!passes(&format!("bad{k}"), &[(name, "The data tell it.\n")]), "{name}");
        }
    }

    #[test]
    fn released_entries_of_the_changelog_are_left_out() {
        let text = "# Changelog\n\n## [Unreleased]\n\nnew\n\n## [0.1.0]\n\nold\n";
        assert_eq!(&text[..unreleased(text)], "# Changelog\n\n## [Unreleased]\n\nnew\n\n");
        assert_eq!(unreleased("# Changelog\n\n## [Unreleased]\n"), 29);
    }

    #[test]
    fn documents_of_the_repository_are_found() {
        let root = workspace();
        let found: Vec<String> = documents(root).unwrap().iter().map(|path| name(root, path)).collect();
        for name in ["README.md", "docs/site/src/index.md", "crates/examples/cases/sandwich/README.md"] {
            assert!(found.iter().any(|own| own == name), "{name} is not in {found:?}");
        }
    }
}
